"""Loads at which round delaminations grow under a central load by central differences, on cells longer than the process
zone.
Usage: growth_circles.py IMPLAM FOLDER CASES CELLS [CONTROL] (lists with commas, mm; CONTROL: energy or strength)

equal      one delamination in the mid-plane of an isotropic plate of 2 mm
unequal    one delamination between layers of .25 and 1.75 mm
two, three, five  equal delaminations above each other
axes       one delamination in the mid-plane of an orthotropic plate, E1/E2 = 4; an ellipse; axes30, axes45: turned

A clamped plate of 200 mm under a slow prescribed displacement of its centre, with a starter of 24 mm; elsewhere as
input/verify/cohesive_threshold.nml. The closed forms are those of thin plates, for any radius: the energy release rate
of n equal delaminations is (n + 2) P**2/(32 pi**2 D), of one between layers of D1 and D2 it is
P**2 (1/(D1 + D2) - 1/D)/(32 pi**2); both are corrected for the loaded patch. An orthotropic plate with
D12 + 2 D66 = (D11 D22)**(1/2) = D is an isotropic one of stiffness D in coordinates that are scaled in the ratio
(D11/D22)**(1/4), that of the axes of the delamination. The load is compared over five cells of growth of the radius of
equal area, beyond the first. A finished run is not repeated."""

import csv
import math
import sys
from pathlib import Path
from subprocess import run

import h5py
import numpy as np

MODULUS, POISSON, THICKNESS, TOUGHNESS = 50e9, 0.3, 2e-3, 800.0
SIDE, PATCH, STARTER = 0.2, 4e-3, 24e-3
LAYERS = {"unequal": [.25e-3, 1.75e-3], "two": 3*[THICKNESS/3], "three": 4*[THICKNESS/4], "five": 6*[THICKNESS/6]}
RATIO = 4.0


class Circle:
    """A plate with delaminations in one cell size."""

    def __init__(self, case, cell):
        """Take the travel that gives five cells of growth and more."""
        self.case, self.cell = case, cell
        self.layers = LAYERS.get(case, 2*[THICKNESS/2])
        self.turned = float(case[4:] or 0) if case.startswith("axes") else None
        self.bending = self.stiffness_of(THICKNESS)
        separate = sum(self.stiffness_of(layer) for layer in self.layers)
        self.number = len(self.layers) - 1
        self.released = (1/separate - 1/self.bending)/(32*math.pi**2*self.number)
        if self.number > 1:
            self.released = (self.number + 2)/(32*math.pi**2*self.bending)
        self.first = STARTER/math.sqrt(math.pi)
        self.last = self.first + 6.5*cell
        area = self.number*math.pi*self.last**2
        load = self.load(self.last)
        self.travel = load*0.0056*SIDE**2/self.bending + 2*TOUGHNESS*area/load + (load/1e8)**(2/3)

    def stiffness_of(self, thickness):
        """Return the bending stiffness of a layer."""
        return MODULUS*thickness**3/(12*(1 - POISSON**2))

    def load(self, radius):
        """Return the load at which delaminations of a radius grow."""
        patch = PATCH**2/math.pi
        return math.sqrt(TOUGHNESS/self.released)/(1 - patch/(2*radius**2))

    def material(self):
        """Return moduli with the bending stiffness of the isotropic plate, or the same geometric mean."""
        if self.turned is None:
            return f"E={MODULUS}  nu={POISSON}", "angles=" + ", ".join(len(self.layers)*["0"])
        larger, smaller = MODULUS*math.sqrt(RATIO), MODULUS/math.sqrt(RATIO)
        major = POISSON*math.sqrt(RATIO)
        # 2 G12 = (1 - nu) sqrt(E1 E2)/(1 - nu**2), as D12 = nu sqrt(D11 D22).
        shear = MODULUS/(2*(1 + POISSON))
        angles = ", ".join(len(self.layers)*[str(self.turned)])
        return (f"E1={larger}  E2={smaller}  nu12={major}  G12={shear}  G13={shear}  G23={shear}", f"angles={angles}")

    def deck(self, control):
        """Return the deck."""
        stretch = 1.0 if self.turned is None else RATIO**(1/8)
        zone = 2*self.cell*math.ceil(stretch*self.last/self.cell + 2)
        outer = round((SIDE - zone)/2/max(6e-3, self.cell))
        symmetry, share = ("quarter", 2) if not self.turned else ("point", 1)
        elements = [round(zone/self.cell/2) + outer, (2//share)*(round(zone/self.cell/2) + outer)]
        material, angles = self.material()
        density = 1600
        period = 2*math.pi*SIDE**2/36*math.sqrt(density*THICKNESS/self.bending)
        time = 4*period
        below = ", ".join(map(str, range(1, self.number + 1)))
        return f"""&case name='circle'  kinematics='linear' /
&plate length={SIDE}, {SIDE}  edges='clamped'  symmetry='{symmetry}' /
&mesh elements={elements[0]}, {elements[1]}  patch={PATCH}  core={zone}, {zone}  cell={self.cell} /
&material name='m'  density={density}  {material} /
&laminate materials='m'  {angles}  thicknesses={', '.join(map(str, self.layers))}  shear_correction='5/6' /
&impactor travel={self.travel}  rise={time/8} /
&indentation law='hertz'  k=1e8 /
&delamination below_ply={below}  G_c={TOUGHNESS}  law='cohesive'  strength_shear=60e6  strength_opening=60e6
  zone={zone}, {zone}  starter={STARTER}  growth_control='{control}' /
&time integrator='central_difference'  end={time}  mass_scaling=1000 /
&output history_every={time/4000} /
"""

    def figures(self, place):
        """Return cells grown, mean ratio of the load, and least and largest mean over one cell of growth."""
        with open(place/"circle_history.csv", encoding="utf-8") as history:
            rows = [(float(row["delaminated_area"])/self.number, float(row["force"]))
                    for row in csv.DictReader(history)]
        radius = np.sqrt(np.array([row[0] for row in rows])/math.pi)
        force = np.array([row[1] for row in rows])
        ratio = force/np.array([self.load(max(r, self.first)) for r in radius])
        grown = (radius - self.first)/self.cell
        means = [ratio[(grown >= k) & (grown < k + 1)].mean() for k in range(1, 6) if grown[-1] >= k + 1]
        return grown[-1], means

    def axes(self, place):
        """Return the ratio of the axes of the delamination, and the angle of the longer one, by second moments."""
        with h5py.File(place/"circle.h5") as file:
            mesh, last = (file[group][max(file[group])] for group in ("meshes", "times"))
            corners = mesh["coordinates"][:, :2][mesh["connectivity"][:]]
            weight = last["cells/delaminated_above"][:]*np.prod(np.ptp(corners, axis=1), axis=1)
        x, y = corners.mean(axis=1).T
        product = 0.0 if not self.turned else (weight*x*y).sum()
        moments = np.array([[(weight*x*x).sum(), product], [product, (weight*y*y).sum()]])
        sizes, directions = np.linalg.eigh(moments)
        return math.sqrt(sizes[1]/sizes[0]), math.degrees(math.atan2(directions[1, 1], directions[0, 1])) % 180


def main(implam, folder, cases, cells, control="energy"):
    """Run the plates and print a row of the table for each."""
    print("| case | cells, mm | cells grown | load over closed form | least and largest mean of a cell | axes, angle |")
    for case in cases.split(","):
        for cell in cells.split(","):
            circle = Circle(case, 1e-3*float(cell))
            place = Path(folder)/f"{case}_{cell}_{control}"
            place.mkdir(parents=True, exist_ok=True)
            if not (place/"circle_summary.json").exists():
                (place/"deck.nml").write_text(circle.deck(control), encoding="utf-8")
                run([implam, place/"deck.nml", "--output", place], check=True, capture_output=True)
            grown, means = circle.figures(place)
            print(f"| {case} | {cell} | {grown:.1f} | {sum(means)/max(1, len(means)):.3f} | "
                  f"{min(means, default=0):.3f}, {max(means, default=0):.3f} | "
                  "{:.3f}, {:.0f} |".format(*circle.axes(place)), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
