"""Matrix strengths by the strain rate: a beam under a growing pressure cracks later by the factor of the closed form.
Usage: strain_rate.py IMPLAM FOLDER

Without strengthening its outer ply cracks at the strain YT/E2 and the time t; strain and time grow in proportion, so that with
strengthening it cracks at F t with F = 1 + r log10(YT/(E2 t)/reference rate) (theory (M31)). Central differences and implicit
steps. Below the reference rate nothing changes, to the last bit."""

import math
import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck, write_deck

STRAIN, GAIN, REFERENCE = 60e6/7.7e9, 0.075, 1e-3
IMPLICIT = ["time%integrator='generalized_alpha'", "time%step=2e-6"]


def crack_time(implam, folder, settings):
    """Return the time of the first matrix crack, and the history."""
    path = run_deck(implam, write_deck(folder, "rate.nml", settings))
    history = read_history(path)
    times = [time for time, energy in zip(history["time"], history["energy_matrix_cracking"], strict=True) if energy > 0]
    require(times, f"{path}: no matrix crack.")
    return times[0], path


def check(implam, folder):
    """Run the beam with and without strengthening."""
    for name, settings, tolerance in (("explicit", [], 0.01), ("implicit", IMPLICIT, 0.01)):
        folder_of = Path(folder) / name
        static, path = crack_time(implam, folder_of / "static", [*settings, "material%rate_strengthening=0"])
        factor = 1 + GAIN*math.log10(STRAIN/static/REFERENCE)
        fast, _ = crack_time(implam, folder_of / "fast", settings)
        print(f"{name}: cracks at {1e3*static:.4f} and {1e3*fast:.4f} ms, ratio {fast/static:.4f}, closed form {factor:.4f}")
        require(abs(fast/static/factor - 1) < tolerance, f"{name}: the ratio is {fast/static}, not {factor}.")
        _, slow = crack_time(implam, folder_of / "slow", [*settings, "material%reference_rate=1e3"])
        require(rows(slow) == rows(path), f"{name}: strengths have changed below the reference rate.")


def rows(path):
    """Return the rows of a history without its comments."""
    return [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]


if __name__ == "__main__":
    sys.exit(exit_code_of(check, *sys.argv[1:]))
