"""Closed forms: a layer over a circular delamination buckles and grows under equal compression along x and y.
Usage: buckled_circle.py IMPLAM FOLDER     (formulas: input/verify/buckled_circle.nml)"""

import math
import sys
from pathlib import Path

from solver_runs import read_history, require, run_deck, write_deck

MODULUS, POISSON, THICKNESS, TOUGHNESS = 60e9, 0.3, 0.5e-3, 300.0
STRAIN = 5e-3
BEFORE = 1.0e-3
# Nodes on the outline are tied: the clamped radius exceeds that of the area of the released nodes by a sixth of a cell.
CELL = 0.5e-3
# Growth is compared once the process zone has formed and moved by a cell all around.
MOVED = 0.5e-3
# Excess of the energy release rate by numerical integration of von Karman's equations of the clamped layer over
# Hutchinson and Suo's: 1.0 % at 1.2 of the buckling strain, 2.4 % at 1.5, 3.3 % at 1.7 and 4.6 % at 2.
BEYOND_BUCKLING = 0.0467


def buckling_strain(radius):
    """Return the strain at which a clamped circular layer buckles."""
    return 1.2235 * (THICKNESS / radius)**2 / (1 + POISSON)


def release_rate(strain, radius):
    """Return the energy release rate of the buckled layer."""
    ratio = strain / buckling_strain(radius)
    factor = (1 + BEYOND_BUCKLING * (ratio - 1)) / (1 + 0.9021 * (1 - POISSON))
    return factor * THICKNESS * MODULUS * strain**2 / (1 - POISSON) * (1 - ratio**-2)


def growth_strain(radius):
    """Return the strain at which its energy release rate equals the toughness."""
    low, high = buckling_strain(radius), 4 * buckling_strain(radius)
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if release_rate(middle, radius) > TOUGHNESS else (middle, high)
    return low


def southwell(strains, deflections):
    """Return the buckling strain by two deflections under a fixed force: each is a/(1 - strain/critical)."""
    ratio = deflections[1] / deflections[0]
    return (ratio * strains[1] - strains[0]) / (ratio - 1)


def main(implam, folder):
    """Compare both strains."""
    rows = read_history(run_deck(implam, write_deck(folder, "buckled_circle.nml")))
    strains = [STRAIN * load for load in rows["load_factor"]]
    first, last = (next(i for i, strain in enumerate(strains) if strain > part * BEFORE) for part in (0.32, 0.99))
    radii = [math.sqrt(area / math.pi) + CELL / 6 for area in rows["delaminated_area"]]
    found = southwell([strains[i] for i in (first, last)], [rows["deflection"][i] for i in (first, last)])
    expected = buckling_strain(radii[0])
    ratios = [strain / growth_strain(radius) for strain, radius in zip(strains, radii, strict=True)
              if radius > radii[0] + MOVED]
    require(ratios, "The delamination does not grow.")
    mean = sum(ratios) / len(ratios)
    print(f"buckles at {1e6 * found:.0f}e-6, {100 * (found / expected - 1):+.2f} %; grows from a radius of "
          f"{1e3 * radii[0]:.2f} to {1e3 * radii[-1]:.2f} mm at {mean:.4f} of the closed form's strain in the mean of "
          f"{len(ratios)} steps, {min(ratios):.4f} to {max(ratios):.4f}")
    require(abs(found / expected - 1) < 0.03, "The buckling strain differs.")
    require(abs(mean - 1) < 0.04, "The strain at growth differs.")


if __name__ == "__main__":
    main(str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve())
