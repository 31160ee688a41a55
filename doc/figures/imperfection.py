"""Draws imperfection.svg: strength of the undamaged panel of doc/studies/residual_strength.md against its imperfection.
Usage: imperfection.py [FOLDER]"""

import sys
from pathlib import Path

from matplotlib.figure import Figure

AMPLITUDES, STRENGTHS = (0.01, 0.03, 0.1, 0.3, 1.0), (460, 441, 415, 381, 332)
EIGENVALUE = 438


def main(folder):
    """Draw the picture."""
    figure = Figure(figsize=(6, 3.4), layout="constrained")
    axes = figure.subplots()
    axes.semilogx(AMPLITUDES, STRENGTHS, "o-", color="C0", label="strength, plies that fail")
    axes.axhline(EIGENVALUE, color="black", linestyle="--", linewidth=1, label="buckling of the elastic panel")
    axes.set(xlabel="amplitude of the imperfection [mm]", ylabel="stress [MPa]", ylim=(0, 500))
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(Path(folder) / "imperfection.svg")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent)
