#!/usr/bin/env python3
"""Loads of a front that advances from node to node, by the share of the toughness from which nodes soften.
Usage: onset_share.py

Two layers under opposite normal forces are tied at nodes of equal distance, without inertia. A node beside a softening
one begins to soften when virtual crack closure gives the share of the toughness, and then loses its traction linearly
with the toughness of its length. The energy release rate does not depend on the length of the delamination, so that a
continuous front would advance at one load. Between nodes equilibrium requires more and less: the largest load is what
growth is delayed by, the least what it then jumps to. In units of the distance of nodes, of the stiffness between them,
and of the load of the closed form, the toughness is one half."""

import math

SHARES = (.02, .05, .1, .15, .2, 2/9, .25, .3, .35, .4, .45, .5, .6, .7, .8, .9, 1.0)


def loads_of(share, advances=60):
    """Return the least and largest load and the mean number of softening nodes on the path of equilibrium, after the
    first advances."""
    onset = math.sqrt(share)
    # Displacements of the softening nodes from the first to the last; ahead of them nodes are tied. The traction of a
    # node is onset - share*displacement, and zero from 1/onset on.
    number, last, found = 1, 0.0, []
    for advance in range(advances):
        line = [walk(onset, share, number, at) for at in (0.0, 1.0)]
        slope = line[1][1] - line[0][1]
        failing = (1/onset - line[0][1])/slope if slope > 0 else math.inf
        # The next node begins to soften when the last one has moved by the onset: both give its energy release rate.
        fails = last - 1e-9 <= failing < onset
        reached = failing if fails else onset
        if advance >= advances//3:
            found.append((walk(onset, share, number, reached)[0], number))
        number, last = (number - 1, reached) if fails else (number + 1, 0.0)
    forces, numbers = zip(*found, strict=True)
    return min(forces), max(forces), sum(numbers)/len(numbers)


def walk(onset, share, number, last):
    """Return the load, and the displacement of the first of a number of softening nodes, from that of the last one."""
    moved, force = last, last
    for k in range(number):
        force += onset - share*moved
        if k < number - 1:
            moved += force
    return force, moved


def main():
    """Print the table."""
    print("| share | softening nodes | least load | largest load |\n|---|---|---|---|")
    for share in SHARES:
        least, largest, number = loads_of(share)
        print(f"| {share:.3f} | {number:.1f} | {least:.3f} | {largest:.3f} |")


if __name__ == "__main__":
    main()
