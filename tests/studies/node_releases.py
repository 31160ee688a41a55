#!/usr/bin/env python3
"""Parts of the energy of a cell that nodes at the ends and in the middle of nine-node elements release.
Usage: node_releases.py

An arm with a front far from its ends is tied at all nodes ahead, in opening its deflection, with free rotations, in
shear its displacement along the front's path. A tie is released, first that of a node at the border of two cells, then
that of the middle node after it. The energy that each releases at a constant load is proportional to what it adds to
the compliance; both together release that of a cell. Arms in opening are Timoshenko beams with shear strains that are
sampled as those of the elements, and an end moment; in shear they are bars, without any length to compare with."""

import numpy as np

# Cells over thickness of an arm, and G13/E1 of steel-like isotropic and of carbon/epoxy arms.
CELLS = (0.5, 1, 2, 4, 8, 16, 32)
SHEARS = (0.4, 0.03)
NODES_BEHIND, ELEMENTS_AHEAD = 12, 20
POINTS = np.array([-1, 1])/np.sqrt(3)


def beam(cell, elements, shear):
    """Return the stiffness of an arm of unit thickness and modulus: deflection and rotation of each node."""
    stiffness = np.zeros((4*elements + 2, 4*elements + 2))
    for at in POINTS:
        shapes = np.array([at*(at - 1)/2, 1 - at**2, at*(at + 1)/2])
        slopes = np.array([at - .5, -2*at, at + .5])*2/cell
        bending, sliding = np.zeros(6), np.zeros(6)
        bending[1::2], sliding[::2], sliding[1::2] = slopes, slopes, -shapes
        part = (np.outer(bending, bending)/12 + 5/6*shear*np.outer(sliding, sliding))*cell/2
        for first in range(0, 4*elements, 4):
            stiffness[first:first + 6, first:first + 6] += part
    return stiffness


def bar(elements):
    """Return the stiffness of an arm along its axis, with cells of unit length and unit stiffness."""
    stiffness = np.zeros((2*elements + 1, 2*elements + 1))
    for first in range(0, 2*elements, 2):
        stiffness[first:first + 3, first:first + 3] += np.array([[7, -8, 1], [-8, 16, -8], [1, -8, 7]])/3
    return stiffness


def released(stiffness, unknowns):
    """Return the parts of the node at the border of cells and of the middle node, for an arm loaded at the last
    unknown of its first node, with a number of unknowns a node of which the first is tied."""
    compliances = []
    for behind in range(NODES_BEHIND, NODES_BEHIND + 3):
        kept = np.setdiff1d(np.arange(len(stiffness)), np.arange(unknowns*behind, len(stiffness), unknowns))
        load = np.zeros(len(kept))
        load[unknowns - 1] = 1
        compliances.append(np.linalg.solve(stiffness[np.ix_(kept, kept)], load)[unknowns - 1])
    gains = np.diff(compliances)
    return gains/gains.sum()


def main():
    """Print the table."""
    elements = NODES_BEHIND//2 + ELEMENTS_AHEAD
    print("| mode | cell over thickness | G13/E1 | node between cells | middle node |\n|---|---|---|---|---|")
    print("| shear | any | any | {:.3f} | {:.3f} |".format(*released(bar(elements), 1)))
    for cell in CELLS:
        for shear in SHEARS:
            print(f"| opening | {cell} | {shear} | "
                  "{:.3f} | {:.3f} |".format(*released(beam(cell, elements, shear), 2)))


if __name__ == "__main__":
    main()
