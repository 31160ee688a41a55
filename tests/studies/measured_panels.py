#!/usr/bin/env python3
"""Impacts on measured panels of T700/M21, compared with the measurement (doc/studies/measured_panels.md).
Usage: measured_panels.py IMPLAM 6.5J|25J FOLDER [GROUP%KEY=VALUE ...] [-GROUP ...] [+'GROUP' ...]
       measured_panels.py FOLDER 6.5J|25J

Runs the deck of input/experiments in FOLDER with the given keys, without the groups given by a dash and their
beginning (those of one line, such as -ply_damage or '-support clamps') and with the groups given after a plus, such as
+'&delamination below_ply=14 ... /'. Prints peak force, largest displacement of the impactor, end of contact, projected
area, absorbed energy, the forces at some displacements up to the largest, for 25 J the relative L2 error of the force
history and the forces at some times, each beside the measured ones, the energies of plies and delaminations, steps and
cost. Beside the projected area by the dissipated toughness it reports the area in which an interface has lost half its
stiffness, which includes the process zones. Without IMPLAM it reads the results in FOLDER."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np

DECKS = Path(__file__).resolve().parents[2] / "input" / "experiments"
TIMES = (0.4, 0.6, 0.8, 1.0, 1.1, 1.2, 1.6, 2.0, 2.5, 3.0)
DISPLACEMENTS = (1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
INTACT = 0.9e-3  # s; fibres of the 25 J panel fail later
FIBRES_FAIL = 1.0  # J in fibre tension; fibres fail within .1 ms


def rows_of(path):
    """Rows of a table of numbers under names, without comments."""
    with path.open(encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    return [{name.strip(): float(value) for name, value in row.items()} for row in csv.DictReader(lines)]


def value_at(time, times, values):
    """Value of a curve, linear between its points and zero outside."""
    for i in range(1, len(times)):
        if times[i - 1] <= time <= times[i]:
            part = (time - times[i - 1]) / (times[i] - times[i - 1])
            return values[i - 1] + part * (values[i] - values[i - 1])
    return 0.0


def measured_force():
    """Times and forces of the 25 J drop."""
    measured = [list(row.values()) for row in rows_of(DECKS / "t700gc_m21_25J_force_time.csv")]
    return [row[0] for row in measured], [row[1] for row in measured]


def forces_at(rows):
    """Computed and measured force, kN, at some times in ms."""
    computed = [row["time"] for row in rows], [row["force"] for row in rows]
    return {time: [value_at(1e-3*time, *curve)/1e3 for curve in (computed, measured_force())] for time in TIMES}


def forces_over(rows, name):
    """Computed and measured force, kN, at some increasing displacements of the impactor in mm."""
    turned = max(range(len(rows)), key=lambda i: rows[i]["impactor_displacement"])
    computed = [[row[key] for row in rows[:turned + 1]] for key in ("impactor_displacement", "force")]
    measured = [list(row.values()) for row in rows_of(DECKS / f"t700_m21_{name}_force_displacement.csv")]
    curve = [row[0] for row in measured], [row[1] for row in measured]
    return {at: [value_at(1e-3*at, *computed)/1e3, value_at(1e-3*at, *curve)/1e3] for at in DISPLACEMENTS
            if 1e-3*at <= computed[0][-1]}


def mean_force(rows):
    """Mean force, N, until fibres of the 25 J panel fail."""
    curve = [row["time"] for row in rows], [row["force"] for row in rows]
    return sum(value_at(INTACT * (i + 0.5) / 1000, *curve) for i in range(1000)) / 1000


def failure_displacement(rows):
    """Displacement, m, at which fibres fail in tension; NaN without failure."""
    return next((row["impactor_displacement"] for row in rows if row["energy_fibre_tension"] > FIBRES_FAIL), np.nan)


def history_error(rows):
    """Relative L2 error of the force of 25 J over the measured time."""
    times, forces = measured_force()
    computed = [[row["time"] for row in rows], [row["force"] for row in rows]]
    every = [times[0] + (times[-1] - times[0]) * i / 1000 for i in range(1001)]
    wanted = [value_at(time, times, forces) for time in every]
    off = [value_at(time, *computed) - force for time, force in zip(every, wanted, strict=True)]
    return (sum(x**2 for x in off) / sum(x**2 for x in wanted))**0.5


def softened_area(folder, plate_size):
    """Projected area, m2, in which an interface has lost half its stiffness at the end, including process zones."""
    with h5py.File(next(path for path in folder.glob("*.h5") if not path.stem.endswith("_restart"))) as file:
        last = file["times"][max(file["times"])]
        mesh = file["meshes"][f"{last['mesh'][()]:08d}"]
        points, corners = mesh["coordinates"][:, :2], mesh["connectivity"][:]
        damage = last["points/damage_above"][:]
    # Layers are above each other: each position counts once, with the largest damage of its interfaces.
    _, place = np.unique(np.round(1e7 * points).astype(int), axis=0, return_inverse=True)
    place = place.ravel()
    worst = np.zeros(place.max() + 1)
    np.maximum.at(worst, place, damage)
    _, cells = np.unique(place[corners[:, 8]], return_index=True)
    sides = np.ptp(points[corners[cells, :4]], axis=1)
    shares = np.outer(sides[:, 0] * sides[:, 1], np.array([1, 1, 1, 1, 4, 4, 4, 4, 16]) / 36)
    area = np.zeros_like(worst)
    np.add.at(area, place[corners[cells]], shares)
    return area[worst >= 0.5].sum() * plate_size[0] * plate_size[1] / area.sum()


def run(implam, name, folder, settings):
    """Run a deck; its processor seconds."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "regress"))
    from solver_runs import change_deck  # pylint: disable=import-outside-toplevel,import-error
    folder.mkdir(parents=True, exist_ok=True)
    dropped = tuple(f"&{setting[1:]}" for setting in settings if setting.startswith("-"))
    lines = (DECKS / f"t700_m21_{name}.nml").read_text(encoding="utf-8").splitlines(keepends=True)
    text = change_deck("".join(line for line in lines if not " ".join(line.split()).startswith(dropped)),
                       [setting for setting in settings if not setting.startswith(("-", "+"))])
    text += "".join(f"\n{setting[1:]}\n" for setting in settings if setting.startswith("+"))
    (folder / "deck.nml").write_text(text, encoding="utf-8")
    before = os.times()
    subprocess.run([implam, folder / "deck.nml", "--output", folder], check=True, stdout=subprocess.DEVNULL)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def show(name, folder):
    """Print the figures of a run."""
    rows = rows_of(next(folder.glob("*_history.csv")))
    summary = json.loads(next(folder.glob("*_summary.json")).read_text(encoding="utf-8"))
    last = rows[-1]
    begun = rows[0]["energy_impactor"] + rows[0]["energy_indentation"] + rows[0]["energy_kinetic"] \
        + rows[0]["energy_strain"] + rows[0]["energy_algorithmic"]
    figures = {"up to, ms": 1e3 * last["time"], "peak force, kN": max(row["force"] for row in rows) / 1e3,
               "at, ms": 1e3 * max(rows, key=lambda row: row["force"])["time"],
               "largest displacement, mm": 1e3 * max(row["impactor_displacement"] for row in rows),
               "end of contact, ms": 1e3 * summary["contact_until"], "in contact": float(summary["in_contact"]),
               "projected area, mm2": 1e6 * last["projected_area"],
               "half the stiffness lost, mm2": 1e6 * softened_area(folder, summary["plate_size"]),
               "absorbed, J": begun - last["energy_impactor"]}
    for at, pair in forces_over(rows, name).items():
        figures[f"force at {at} mm, kN"], figures[f"measured at {at} mm, kN"] = pair
    if name == "25J":
        figures[f"mean force to {1e3 * INTACT:g} ms, kN"] = mean_force(rows) / 1e3
        figures["fibres fail at, mm"] = 1e3 * failure_displacement(rows)
        figures["force history, relative L2, %"] = 100 * history_error(rows)
        for time, (force, measured) in forces_at(rows).items():
            figures[f"force at {time} ms, kN"], figures[f"measured at {time} ms, kN"] = force, measured
    for key, value in last.items():
        if key.startswith(("energy_", "area_below", "fibre_fail", "matrix_c", "total_it", "refact", "rejected",
                           "step")):
            figures[key] = 1e6 * value if key.startswith("area") else value
    for key, value in figures.items():
        print(f"{key:34} {value:12.5g}")


def main(*arguments):
    """Run a deck, or read its results."""
    if Path(arguments[0]).is_dir():
        show(arguments[1], Path(arguments[0]))
        return
    implam, name, folder, settings = os.path.abspath(arguments[0]), arguments[1], Path(arguments[2]), arguments[3:]
    seconds = run(implam, name, folder, list(settings))
    show(name, folder)
    print(f"{'processor, s':34} {seconds:12.5g}")


if __name__ == "__main__":
    if len(sys.argv) < 3 or "--help" in sys.argv:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
