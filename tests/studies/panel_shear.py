#!/usr/bin/env python3
"""Part of the force that transverse shear carries in the 25 J panel (doc/studies/measured_panels.md).
Usage: panel_shear.py FOLDER

Reads the results that measured_panels.py wrote there for 25J with output%fields='stress','ply_damage' and
output%fields_every=2e-4. Prints a row for each time: the force, then for rings about the struck point

- the force carried by transverse shear, in kN: the stresses of all plies summed over a circle. In slow motion the
  contact force is the sum of this and of the membrane forces along the slope;
- the radial membrane force, in N/mm;
- root mean square and largest magnitude of s23 over all plies, in MPa.

Stresses are those at the centre of each cell. Rings begin 5.5 mm from the struck point: nearer, within the contact
radius of 3 to 3.6 mm and half the thickness of the panel, the load spreads through the thickness, which plate theory
does not describe. Needs h5py."""

import re
import sys
from pathlib import Path

import h5py
import numpy as np
from measured_panels import DECKS, rows_of, value_at

RINGS = ((5.5e-3, 8e-3), (8e-3, 11e-3), (11e-3, 16e-3), (16e-3, 24e-3))
DECK = (DECKS / "t700_m21_25J.nml").read_text(encoding="utf-8")
ANGLES = [float(angle) for angle in re.search(r"angles=([-\d.,]+)", DECK)[1].split(",")]
THICKNESS = float(re.search(r"thicknesses=([-+\d.e]+)", DECK)[1])


def ply_forces(stresses, angle, away):
    """Shear force and membrane force of a ply in given in-plane directions, per length."""
    along = away[:, 0] * np.cos(np.radians(angle)) + away[:, 1] * np.sin(np.radians(angle))
    across = away[:, 1] * np.cos(np.radians(angle)) - away[:, 0] * np.sin(np.radians(angle))
    shear = along * stresses["tau13"] + across * stresses["tau23"]
    membrane = along**2 * stresses["sigma11"] + across**2 * stresses["sigma22"] + 2 * along * across * stresses["tau12"]
    return THICKNESS * shear, THICKNESS * membrane


def ring_figures(mesh, cells, ring):
    """Force carried by shear, radial membrane force, root mean square and largest s23."""
    places = mesh["coordinates"][()][mesh["connectivity"][()].reshape(len(mesh["cells/first_ply"]), -1)]
    middles = places.mean(axis=1)[:, :2]
    distances = np.hypot(*middles.T)
    areas = np.ptp(places[:, :, 0], axis=1) * np.ptp(places[:, :, 1], axis=1)
    in_ring = (distances >= ring[0]) & (distances < ring[1])
    supported, radial, squares, largest = 0.0, 0.0, [], 0.0
    for ply, angle in enumerate(ANGLES, 1):
        of_ply = in_ring & (mesh["cells/first_ply"][()] <= ply) & (mesh["cells/last_ply"][()] >= ply)
        stresses = {name: cells[f"ply_{ply}_{name}"][()][of_ply]
                    for name in ("sigma11", "sigma22", "tau12", "tau13", "tau23")}
        shear, membrane = ply_forces(stresses, angle, middles[of_ply] / distances[of_ply, None])
        supported += 2 * np.pi * np.average(shear * distances[of_ply], weights=areas[of_ply])
        radial += np.average(membrane, weights=areas[of_ply])
        squares.append(np.average(stresses["tau23"]**2, weights=areas[of_ply]))
        largest = max(largest, np.abs(stresses["tau23"]).max())
    return abs(supported) / 1e3, radial / 1e3, np.mean(squares)**0.5 / 1e6, largest / 1e6


def main(folder):
    """Print the table."""
    rows = rows_of(next(folder.glob("*_history.csv")))
    history = [row["time"] for row in rows], [row["force"] for row in rows]
    print("time, ms | force, kN |" + " |".join(f" {1e3*ring[0]:g}-{1e3*ring[1]:g} mm" for ring in RINGS))
    with h5py.File(next(folder.glob("*_25J.h5"))) as file:
        for now in (file["times"][name] for name in sorted(file["times"])):
            mesh = file["meshes"][max(file["meshes"])]
            figures = [ring_figures(mesh, now["cells"], ring) for ring in RINGS]
            print(f"{1e3*now['time'][()]:.2f} | {value_at(now['time'][()], *history)/1e3:.2f} |",
                  " | ".join("{:.2f} {:.0f} {:.0f} {:.0f}".format(*values) for values in figures))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
