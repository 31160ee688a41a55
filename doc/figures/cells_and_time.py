"""Draws cells_and_time.svg: error of the area and of the peak force of peanut.nml against the processor time, from
tests/studies/growth/plates.csv. Usage: cells_and_time.py [FOLDER]"""

import csv
import sys
from pathlib import Path

from drawing import BLUE, INK, RED, plt, save

ROWS = Path(__file__).resolve().parents[2] / "tests" / "studies" / "growth" / "plates.csv"


def main():
    """Draw the picture."""
    with open(ROWS, encoding="utf-8") as table:
        rows = [row for row in csv.DictReader(table) if row["deck"] == "peanut"]
    finest = min((row for row in rows if row["control"] == "energy"), key=lambda row: float(row["cell"]))
    figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
    for name, label, marker in (("projected_area", "area", "o"), ("peak_force", "peak force", "s")):
        for control, colour in (("energy", BLUE), ("strength", RED)):
            points = sorted((float(row["seconds"]), 100 * (float(row[name]) / float(finest[name]) - 1), row["cell"])
                            for row in rows if row["control"] == control)
            axes.semilogx([point[0] for point in points], [point[1] for point in points], marker + "-", color=colour,
                          fillstyle="full" if name == "projected_area" else "none", label=f"{label}, growth by {control}")
            if name == "projected_area" and control == "energy":
                for number, (seconds, error, cell) in enumerate(points):
                    axes.annotate(f"{cell} mm", (seconds, error), xytext=(0, -14 if number % 2 else -24),
                                  textcoords="offset points", ha="center", fontsize=8)
    axes.axhline(0, color=INK, linewidth=0.8)
    axes.set_xticks([2, 5, 10, 20, 50], ["2", "5", "10", "20", "50"])
    axes.minorticks_off()
    axes.set(xlabel="processor time [s]", ylabel="error against the finest cells [%]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    save(figure, "cells_and_time")


if __name__ == "__main__":
    sys.exit(main())
