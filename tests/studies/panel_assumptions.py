#!/usr/bin/env python3
"""Effect of assumptions on the 25 J panel: differences of the variants of a sweep from its first one, run by run
(doc/studies/measured_panels.md). Usage: panel_assumptions.py FOLDER [FOLDER ...]

FOLDER holds the results of scatter/assumptions_25J.toml, further ones those of sweeps without variants such as
panel_25J_fine.toml, each of them one variant. Prints the mean of the first variant and the differences of the others,
over pairs of runs with the same random inputs. With few pairs their standard deviation is poorly known; it is therefore
pooled over the variants, and a star marks differences beyond Student's t (5 %) of the pooled standard error. Absorbed
energy and end of contact are estimated from the state at 2 ms, see ESTIMATES."""

import csv
import sys
from pathlib import Path

import numpy as np
from measured_panels import FIBRES_FAIL
from scipy.special import stdtrit

DISSIPATED = ("indentation", "delamination", "ply_damage", "contact", "friction", "algorithmic")
# Least squares over 13 runs to the end of contact (nine with cells of 3 mm, four of 1.5 mm); prediction errors, each
# run left out in turn, are .15 J and .034 ms. Their tractions are those at the end of the step; with weighted jumps
# both estimates are too small, by up to 2.4 J and .3 ms, more where the struck face delaminates.
# D: energy dissipated until 2 ms, J; V: velocity of the impactor at that time, m/s.
ESTIMATES = {"absorbed energy, J": lambda d, v: -1.115 + 1.064 * d,
             "end of contact, ms": lambda d, v: 2.977 + 0.0818 * d + 0.3485 * v}
MOMENT = 2e-3


def figures_of(folder):
    """Figures of one run, by name; NaN where fibres do not fail."""
    path = next(folder.glob("*_history.csv"))
    with path.open(encoding="utf-8") as file:
        rows = np.genfromtxt((line for line in file if not line.startswith("#")), delimiter=",", names=True)
    time = rows["time"]
    kept = rows[time <= 1.001 * MOMENT]
    force, moved, torn = kept["force"] / 1e3, 1e3 * kept["impactor_displacement"], kept["energy_fibre_tension"]
    fails = int(np.argmax(torn > FIBRES_FAIL)) if (torn > FIBRES_FAIL).any() else None
    at_moment = {name: float(np.interp(MOMENT, time, rows[name])) for name in rows.dtype.names if name != "time"}
    dissipated = sum(at_moment[f"energy_{name}"] for name in DISSIPATED)
    result = {"peak force, kN": force.max(), "largest displacement, mm": moved.max()}
    result |= {f"force at {at} ms, kN": float(np.interp(1e-3 * at, time, rows["force"])) / 1e3
               for at in (1.0, 1.2, 1.6)}
    result |= {"fibres fail at, ms": np.nan if fails is None else 1e3 * kept["time"][fails],
               "projected area, mm²": 1e6 * at_moment["projected_area"],
               "area of all interfaces, mm²": 1e6 * at_moment["delaminated_area"]}
    return result | {name: law(dissipated, at_moment["impactor_velocity"]) for name, law in ESTIMATES.items()}


def runs_of(folders):
    """Figures of the runs of each variant, by the factor of the velocity, which identifies the inputs."""
    variants = {}
    for folder in folders:
        with (folder / "table.csv").open(encoding="utf-8") as file:
            ended = [row for row in csv.DictReader(file) if row["exit_code"] == "0"]
        for row in ended:
            name = row.get("variant", folder.name).strip("'")
            variants.setdefault(name, {})[row["impactor.velocity factor"]] = figures_of(folder / row["folder"])
    return variants


def compared(variants):
    """For each figure: mean of the first variant, and differences of the others with pairs and pooled error."""
    (first, base), *others = variants.items()
    names = next(iter(base.values())).keys()
    table = {}
    for name in names:
        changes = {variant: [run[name] - base[key][name] for key, run in runs.items() if key in base]
                   for variant, runs in others}
        changes = {variant: np.array([x for x in found if np.isfinite(x)]) for variant, found in changes.items()}
        freedom = sum(max(0, len(found) - 1) for found in changes.values())
        squares = sum(((found - found.mean())**2).sum() for found in changes.values() if len(found) > 1)
        spread = (squares / freedom)**0.5 if freedom else np.nan
        values = [run[name] for run in base.values() if np.isfinite(run[name])]
        table[name] = {"first": first, "runs": len(values), "mean": float(np.mean(values)),
                       "error": float(np.std(values, ddof=1) / len(values)**0.5), "spread": spread,
                       "limit": float(stdtrit(freedom, 0.975)) if freedom else np.nan,
                       "differences": {variant: (len(found), float(found.mean()), spread / len(found)**0.5)
                                       for variant, found in changes.items() if len(found)}}
    return table


def rounded(number, digits=2, sign="+"):
    """Text of a number with some digits and without an exponent."""
    return f"{float(f'{number:.{digits}g}'):{sign}g}"


def printed(table):
    """Lines of the table: means of the first variant, differences of the others, and their standard errors."""
    first = next(iter(table.values()))
    cells = [["", "pairs", *table],
             [first["first"], "", *(f"{entry['mean']:.4g} ± {rounded(entry['error'], 2, '')}"
                                      for entry in table.values())]]
    for variant in dict.fromkeys(name for entry in table.values() for name in entry["differences"]):
        row = []
        for entry in table.values():
            pairs, mean, error = entry["differences"].get(variant, (0, np.nan, np.nan))
            row.append(rounded(mean) + "*" * int(abs(mean) > entry["limit"] * error) if pairs else "-")
        cells.append([variant, str(max(entry["differences"].get(variant, (0,))[0] for entry in table.values())), *row])
    cells.append(["standard deviation", "", *(rounded(entry["spread"], 2, "") for entry in table.values())])
    return [f"| {' | '.join(row)} |" for row in [cells[0], ["---"] * len(cells[0]), *cells[1:]]]


def main():
    """Print the table."""
    folders = [Path(folder) for folder in sys.argv[1:]]
    variants = runs_of(folders)
    if not variants:
        raise SystemExit(f"No run is complete in {', '.join(map(str, folders))}.")
    print("\n".join(printed(compared(variants))))


if __name__ == "__main__":
    if len(sys.argv) < 2 or "--help" in sys.argv:
        raise SystemExit(__doc__)
    main()
