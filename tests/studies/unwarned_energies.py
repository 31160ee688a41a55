#!/usr/bin/env python3
"""Runs with more than 1 % of energy error or algorithmic dissipation and without a warning of it.
Usage: unwarned_energies.py FOLDER...

Reads every NAME_summary.json below the folders, such as build/tests/regress after ctest, or the results of a sweep.
The energy created or dissipated by integrators or load steps, and the energy error, are compared with the largest
energy at the end. Fronts record fracture energy before the motion has released it; this is not counted as created."""

import json
import sys
from pathlib import Path

TOLERANCE = 0.01


def open_share(summary):
    """Return the fraction of the energy that is created, dissipated by integrators or in error; 0 without energy."""
    def of(name):
        return summary.get(name) or 0.0

    # The energy transferred by the impactor is included: for one laid on the plate it is the only one.
    limit = max(of("energy_impact"), of("energy_impact") - of("energy_impactor"), of("work_external"),
                of("energy_kinetic") + of("energy_strain"))
    if limit <= 0:
        return 0.0
    fronts = sum(entry["energy"] for entry in summary.get("interfaces", []) if not entry["is_cohesive"])
    created = max(0.0, -of("energy_algorithmic") - fronts)
    return max(created, of("energy_algorithmic"), abs(of("energy_error"))) / limit


def warned(summary):
    """Return whether the run, not the deck, has a warning."""
    return any(entry["at"] is not None for entry in summary["warnings"])


def main(folders):
    """List the runs; fail if there are any."""
    paths = sorted(path for folder in folders for path in Path(folder).rglob("*_summary.json"))
    found = 0
    for path in paths:
        summary = json.loads(path.read_text(encoding="utf-8"))
        share = open_share(summary)
        if summary["exit"]["kind"] == "done" and share > TOLERANCE and not warned(summary):
            found += 1
            print(f"{path}: {100 * share:.2g} %")
    print(f"{len(paths)} runs, {found} without a warning")
    return 1 if found or not paths else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
