"""Loads at which delaminations grow in strips by central differences, on cells longer than the process zone.
Usage: growth_strips.py IMPLAM FOLDER KINDS ARMS CELLS [CONTROL] (lists with commas, mm; CONTROL: energy or strength)

dcb  double cantilever beam: opening
enf  end-notched flexure: shear
slb  single-leg bending, the support under the upper arm only: 43 % of shear

Two arms of IM7/8552 of equal thickness, two rows of cells, prescribed displacement with a smooth start. The closed
forms are those of Timoshenko beams, with the rotation of the arms at the front: opening G = (P a)^2/D at the crack
length a + t (E/(10 G13))^(1/2), shear G = 3 (P a)^2/(64 D) for the central force P per width. The load is compared with
that of the crack length by the displacement, and by the dissipated area, over the growth beyond the first cell."""

import csv
import math
import sys
from pathlib import Path
from subprocess import run

E1, G13, DENSITY = 161e9, 5.2e9, 1580.0
G_I, G_II, ETA = 212.0, 774.0, 2.1


class Strip:
    """A specimen with arms of one thickness."""

    def __init__(self, kind, arm, cell):
        """Take lengths that give five cells of growth and more from a whole number of cells."""
        self.kind, self.arm, self.cell = kind, arm, cell
        self.bending, self.shear = E1*arm**3/12, 5/6*G13*arm
        self.root = arm*math.sqrt(E1/(10*G13))
        growth = max({"dcb": 8, "enf": 5.5, "slb": 5.5}[kind]*cell, 8e-3)
        self.span = 0.0
        if kind == "dcb":
            self.crack = self.whole(max(30e-3, 20*arm))
            self.length = self.whole(self.crack + growth + 12e-3 + 2*cell)
            self.before = 0.0
        else:
            self.span = self.whole(max(growth/{"enf": .22, "slb": .35}[kind], 40e-3, 30*arm))
            self.crack = self.whole({"enf": .72, "slb": .57}[kind]*self.span)
            self.before = 2*cell
            self.length = 2*(self.span + self.before)
        self.travel = self.load(self.crack + growth)*self.compliance(self.crack + growth)

    def whole(self, length):
        """Return the nearest whole number of cells."""
        return round(length/self.cell)*self.cell

    def load(self, crack):
        """Return the load per width at which a crack grows."""
        if self.kind == "dcb":
            return math.sqrt(G_I*self.bending)/(crack + self.root)
        shear = 3*crack**2/16
        opening = (crack + self.root)**2/4 if self.kind == "slb" else 0.0
        share = shear/(shear + opening)
        return 2*math.sqrt((G_I + (G_II - G_I)*share**ETA)*self.bending/(shear + opening))

    def compliance(self, crack):
        """Return displacement over load per width."""
        if self.kind == "dcb":
            return (crack**3/3 + crack**2*self.root)/self.bending + crack/self.shear
        half = self.span**3/(24*self.bending) + self.span/(2*self.shear)
        if self.kind == "enf":
            return (2*half + crack**3/(8*self.bending))/4
        return (2*half + (7/24*crack**3 + crack**2*self.root/4)/self.bending + crack/(2*self.shear))/4

    def crack_at(self, displacement):
        """Return the length of a crack that grows at a displacement."""
        low, high = self.crack/4, 4*self.crack
        for _ in range(60):
            middle = (low + high)/2
            if self.load(middle)*self.compliance(middle) < displacement:
                low = middle
            else:
                high = middle
        return low

    def deck(self, control):
        """Return the deck."""
        end, width = self.length/2, 2*self.cell
        if self.kind == "dcb":
            lines = [f"at={-end}  layer=1  displacement={-self.travel}  rise=RISE",
                     f"at={-end}  layer=2  displacement={self.travel}  rise=RISE"]
            period = 2*math.pi*(self.length - 12e-3)**2/3.52*math.sqrt(DENSITY*self.arm/self.bending)
        else:
            layer = 2 if self.kind == "enf" else 1
            lines = [f"at={-self.span}  layer={layer}  displacement=0  history='fixed'",
                     f"at={self.span}  layer=2  displacement=0  history='fixed'",
                     f"at=0  layer=1  displacement={self.travel}  rise=RISE"]
            period = 2*math.pi*(2*self.span)**2/9.87*math.sqrt(DENSITY*self.arm/self.bending)
        time = 10*period
        first, last = -end, -end + self.before + self.crack
        text = "".join(f"&line {line} /\n" for line in lines).replace("RISE", f"{time/4}")
        edges = "'free', 'clamped', 'free', 'free'" if self.kind == "dcb" else "'free'"
        return f"""&case name='strip'  kinematics='linear' /
&plate length={self.length}, {width}  edges={edges} /
&mesh elements={round(self.length/self.cell)}, 2 /
&material name='m'  density={DENSITY}  E1={E1}  E2=11.38e9  G12={G13}  G13={G13}  G23=3.9e9  nu12=0 /
&laminate materials='m'  angles=0, 0  thicknesses={self.arm}, {self.arm}  shear_correction='5/6' /
{text}&delamination below_ply=1  law='cohesive'  G_Ic={G_I}  G_IIc={G_II}  eta={ETA}  growth_control='{control}'
  strength_opening=60e6  strength_shear=90e6  zone={self.length}, {width}  starter_strip={first}, {last} /
&time integrator='central_difference'  end={time}  mass_scaling=1000 /
&output history_every={time/2000} /
"""

    def ratios(self, rows):
        """Return loads over the closed form by displacement and by dissipated area, and cells of growth."""
        line = 2 if self.kind == "dcb" else 3
        found = []
        for row in rows:
            crack = row["delaminated_area"]/(2*self.cell) - self.before
            if crack > self.crack + max(self.cell, 1e-3):
                load = abs(row[f"line_force_{line}"])/(2*self.cell)
                growing = self.crack_at(abs(row[f"line_displacement_{line}"]))
                found.append((load/self.load(growing), load/self.load(crack)))
        grown = (rows[-1]["delaminated_area"]/(2*self.cell) - self.before - self.crack)/self.cell
        return found, grown


def main(implam, folder, kinds, arms, cells, control="energy"):
    """Run the strips and print a row of the table for each."""
    print("| strip | arms, mm | cells, mm | cells grown | load by displacement | load by area | least and largest |")
    for kind in kinds.split(","):
        for arm in arms.split(","):
            for cell in cells.split(","):
                strip = Strip(kind, 1e-3*float(arm), 1e-3*float(cell))
                place = Path(folder)/f"{kind}_{arm}_{cell}_{control}"
                place.mkdir(parents=True, exist_ok=True)
                (place/"deck.nml").write_text(strip.deck(control), encoding="utf-8")
                run([implam, place/"deck.nml", "--output", place], check=True, capture_output=True)
                with open(place/"strip_history.csv", encoding="utf-8") as history:
                    rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(history)]
                found, grown = strip.ratios(rows)
                means = [sum(pair[k] for pair in found)/max(1, len(found)) for k in (0, 1)]
                bounds = [bound((pair[0] for pair in found), default=0.0) for bound in (min, max)]
                print(f"| {kind} | {arm} | {cell} | {grown:.1f} | {means[0]:.3f} | {means[1]:.3f} | "
                      f"{bounds[0]:.2f}, {bounds[1]:.2f} |", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
