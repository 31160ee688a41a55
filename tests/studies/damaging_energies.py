#!/usr/bin/env python3
"""Energy balance of the models of damaging_models.py, and its change with step and damping.
Usage: damaging_energies.py IMPLAM SEED ...

Prints a line for each run: unchanged, with half the step, with rho_inf=.99. Each has the energies dissipated by
integrators, plies and delaminations in % of the impact energy, the delaminated area in mm2, fibre failures, peak force
in N, steps, rejected steps, iterations and processor time in s."""

import csv
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "bench"))
from damaging_models import deck, ended, model

WAYS = (("as it is", 1, ""), ("half the step", 2, ""), ("rho_inf=.99", 1, "rho_inf=.99 "))


def line(implam, seed, parts, damping):
    """Run a model; return its printed figures."""
    s = model(seed)
    s["steps"] *= parts
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "model.nml"
        path.write_text(deck(s).replace("&time ", "&time " + damping), encoding="utf-8")
        code, said, seconds = ended([implam, path, "--output", name])
        if code:
            return f"ends with {code}: {said}"
        with (Path(name) / "model_history.csv").open(encoding="utf-8") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    last = rows[-1]
    taken = " ".join(f"{100 * last['energy_' + of] / s['energy']:6.2f}"
                     for of in ("algorithmic", "ply_damage", "delamination"))
    return (f"{taken} {1e6 * last['delaminated_area']:6.1f} {last['fibre_failures']:4.0f} "
            f"{max(row['force'] for row in rows):6.0f} {last['step']:4.0f} {last['rejected']:4.0f} "
            f"{last['total_iterations']:6.0f} {seconds:6.1f}")


def main(implam, *seeds):
    """Run the models."""
    for seed in seeds:
        for title, parts, damping in WAYS:
            print(f"{seed:>3} {title:14}", line(Path(implam).absolute(), int(seed), parts, damping), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
