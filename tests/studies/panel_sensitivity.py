#!/usr/bin/env python3
"""Sensitivity of a measured panel to 10 % of each input (doc/studies/measured_panels.md).
Usage: panel_sensitivity.py IMPLAM 6.5J|25J FOLDER [GROUP%KEY=VALUE ...]

Runs the deck of measured_panels.py unchanged and with each value of material, interface and indentation 10 % larger,
each in its own folder, and prints a row of a table: peak force, largest displacement and projected area, of the changed
decks in per cent of the unchanged one. The first rows change one value by 1e-6, which shows the effect of round-off.
With time%end=2e-3 a run ends after the largest displacement. Complete runs in FOLDER are not repeated."""

import re
import subprocess
import sys
from pathlib import Path

from measured_panels import DECKS, rows_of

# The most influential inputs first.
INPUTS = {"delamination": ("G_IIc", "G_Ic", "eta", "friction"),
          "material": ("S12", "YT", "E1", "E2", "G12", "G13", "G23", "XC", "G_fc", "XT", "G_ft", "G_mt", "G_mc", "YC",
                       "nu12", "density"),
          "indentation": ("k", "alpha_cr")}
TRIFLES = -1e-6, 1e-6, 2e-6  # relative changes of the density, of the size of round-off


def changes(text):
    """Name of a row, folder and setting: the trifling changes, then each input 10 % larger."""
    for group, key, more in ([("material", "density", part) for part in TRIFLES]
                             + [(group, key, None) for group, keys in INPUTS.items() for key in keys]):
        value = float(re.search(rf"\b{key}=([\d.e+-]+)", text)[1])
        row = key if more is None else f"{key}, but {more:+.0e} of it"
        folder = f"{group}_{key}" if more is None else f"{group}_{key}_{more:+.0e}"
        yield row, folder, f"{group}%{key}={(1 + (more or 0.1))*value:.10g}"


def figures(folder):
    """Peak force, largest displacement and projected area of a completed run, or None."""
    histories = list(folder.glob("*_history.csv"))
    if not (folder / "ended").exists() or not histories:
        return None
    rows = rows_of(histories[0])
    return (max(row["force"] for row in rows), max(row["impactor_displacement"] for row in rows),
            rows[-1]["projected_area"])


def run(arguments, folder, settings):
    """Run one deck, unless it has been run."""
    if figures(folder) is None:
        command = [sys.executable, str(Path(__file__).with_name("measured_panels.py")), arguments[0], arguments[1],
                   str(folder), *settings]
        if subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode == 0:
            (folder / "ended").touch()
    return figures(folder)


def main(arguments):
    """Run all decks."""
    text = (DECKS / f"t700_m21_{arguments[1]}.nml").read_text(encoding="utf-8")
    given, folder = arguments[3:], Path(arguments[2])
    base = run(arguments, folder / "as_it_is", given)
    if base is None:
        sys.exit(f"The unchanged deck did not end: see {folder / 'as_it_is'}.")
    print("| 10 % more of | peak force | largest displacement | projected area |\n" + "|---"*4 + "|")
    print(f"| none | {base[0]/1e3:.2f} kN | {1e3*base[1]:.2f} mm | {1e6*base[2]:.0f} mm2 |", flush=True)
    for row, name, change in changes(text):
        changed = run(arguments, folder / name, [*given, change])
        parts = "no end" if changed is None else \
            " | ".join(f"{100*(a/b - 1):+.1f} %" for a, b in zip(changed, base, strict=True))
        print(f"| {row} | {parts} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 4 or "--help" in sys.argv:
        raise SystemExit(__doc__)
    main(sys.argv[1:])
