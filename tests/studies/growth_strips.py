#!/usr/bin/env python3
"""Loads at which delaminations grow in strips by central differences, on cells longer than the process zone.
Usage: growth_strips.py run IMPLAM FOLDER KINDS ARMS CELLS [CONTROL] (lists with commas, mm; CONTROL: energy or
strength)

dcb  double cantilever beam: opening
enf  end-notched flexure: shear
slb  single-leg bending, the support under the upper arm only: 43 % of shear

`run` adds a row to growth/strips.csv for each strip that has none, so that a stopped command continues; growth_table.py
writes the tables.

Arms of IM7/8552 of equal thickness, two rows of cells, prescribed displacement with a smooth start in ten periods of
the strip's slowest mode. The kinetic energy is that of the fronts' jumps, not of the loading: a slower motion does
not change it, and longer cracks, which store more energy, jump farther. The closed forms are those of Timoshenko
beams, with the rotation of the arms at the front: opening G = (P a)^2/D at the crack length a + t (E/(10 G13))^(1/2),
shear G = 3 (P a)^2/(64 D) for the central force P per width. Loads are compared with those of the crack length by the
displacement, and by the dissipated area, in the mean over all whole cells of growth after the first."""

import csv
import math
import sys
from pathlib import Path
from subprocess import run

from result_rows import append_row

HERE = Path(__file__).resolve().parent
ROWS = HERE/"growth"/"strips.csv"
COLUMNS = ["strip", "arm", "cell", "control", "cells_opening", "cells_shear", "cells_grown", "kinetic_share",
           "load_by_displacement", "load_by_area", "least", "largest"]
E1, G13, DENSITY = 161e9, 5.2e9, 1580.0
G_I, G_II, ETA = 212.0, 774.0, 2.1
OPENING, SHEAR = 60e6, 90e6


class Strip:
    """A specimen with arms of one thickness."""

    def __init__(self, kind, arm, cell):
        """Take lengths that give five whole cells of growth and more from a whole number of cells."""
        self.kind, self.arm, self.cell = kind, arm, cell
        self.bending, self.shear = E1*arm**3/12, 5/6*G13*arm
        self.root = arm*math.sqrt(E1/(10*G13))
        self.growth = 8*cell
        self.span = self.before = 0.0
        # The program refuses plates that are thicker than wide.
        self.width = max(2*cell, 3*arm)
        ahead = 6*cell + 6*arm
        if kind == "dcb":
            self.crack = self.whole(max(8*cell, 20*arm))
            self.length = self.whole(self.crack + self.growth + ahead)
        else:
            self.span = self.whole(max(self.growth/{"enf": .22, "slb": .35}[kind], 30*arm))
            self.crack = self.whole({"enf": .72, "slb": .57}[kind]*self.span)
            self.before = 2*cell
            self.length = 2*(self.span + self.before)

    def whole(self, length):
        """Return the nearest whole number of cells."""
        return round(length/self.cell)*self.cell

    def zones(self):
        """Return the cells in the process zones of opening and shear."""
        opening = (E1*G_I/OPENING**2)**.25*self.arm**.75
        return opening/self.cell, math.sqrt(E1*G_II*self.arm)/SHEAR/self.cell

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

    def travel(self):
        """Return the displacement at the end of the growth."""
        return self.load(self.crack + self.growth)*self.compliance(self.crack + self.growth)

    def crack_at(self, displacement):
        """Return the length of a crack that grows at a displacement, not shorter than the starter: shorter cracks of
        bent strips also grow at larger displacements."""
        low, high = self.crack, 4*self.crack
        for _ in range(60):
            middle = (low + high)/2
            if self.load(middle)*self.compliance(middle) < displacement:
                low = middle
            else:
                high = middle
        return low

    def period(self):
        """Return the period of the slowest mode, of a cantilever or a simple beam."""
        length, factor = (self.crack + self.growth, 3.52) if self.kind == "dcb" else (2*self.span, 9.87)
        return 2*math.pi*length**2/factor*math.sqrt(DENSITY*self.arm/self.bending)

    def deck(self, control):
        """Return the deck."""
        end, width = self.length/2, self.width
        if self.kind == "dcb":
            lines = [f"at={-end}  layer=1  displacement={-self.travel()}  rise=RISE",
                     f"at={-end}  layer=2  displacement={self.travel()}  rise=RISE"]
        else:
            layer = 2 if self.kind == "enf" else 1
            lines = [f"at={-self.span}  layer={layer}  displacement=0  history='fixed'",
                     f"at={self.span}  layer=2  displacement=0  history='fixed'",
                     f"at=0  layer=1  displacement={self.travel()}  rise=RISE"]
        time = 10*self.period()
        first, last = -end, -end + self.before + self.crack
        text = "".join(f"&line {line} /\n" for line in lines).replace("RISE", f"{time/4}")
        edges = "'free', 'clamped', 'free', 'free'" if self.kind == "dcb" else "'free'"
        return f"""&case name='strip'  kinematics='linear' /
&plate length={self.length}, {width}  edges={edges} /
&mesh elements={round(self.length/self.cell)}, 2 /
&material name='m'  density={DENSITY}  E1={E1}  E2=11.38e9  G12={G13}  G13={G13}  G23=3.9e9  nu12=0 /
&laminate materials='m'  angles=0, 0  thicknesses={self.arm}, {self.arm}  shear_correction='5/6' /
{text}&delamination below_ply=1  law='cohesive'  G_Ic={G_I}  G_IIc={G_II}  eta={ETA}  growth_control='{control}'
  strength_opening={OPENING}  strength_shear={SHEAR}  zone={self.length}, {width}  starter_strip={first}, {last} /
&time integrator='central_difference'  end={time}  mass_scaling=1000 /
&output history_every={time/2000} /
"""

    def grown(self, row):
        """Return the growth by the dissipated area."""
        return row["delaminated_area"]/self.width - self.before - self.crack

    def result(self, rows, control):
        """Return the row of the table: means over whole cells of growth after the first."""
        grown = [self.grown(row)/self.cell for row in rows]
        last = math.floor(grown[-1] + 1e-6)
        used = [row for row, cells in zip(rows, grown, strict=True) if 1 <= cells <= last]
        pairs = [self.ratios(row) for row in used]
        share = max(row["energy_kinetic"]/row["work_external"] for row in used or rows[len(rows)//2:])
        if last < 2:
            # The load carried without growth: the median of the last twentieth, since the load oscillates.
            ending = sorted(self.ratios(row)[1] for row in rows[-len(rows)//20:])
            means, bounds = ["", ""], ["", f"{ending[len(ending)//2]:.3f}"]
        else:
            means = [f"{sum(pair[k] for pair in pairs)/len(pairs):.3f}" for k in (0, 1)]
            bounds = [f"{bound(pair[0] for pair in pairs):.3f}" for bound in (min, max)]
        zones = [f"{cells:.2f}" for cells in self.zones()]
        return [self.kind, f"{1e3*self.arm:g}", f"{1e3*self.cell:g}", control, *zones, f"{grown[-1]:.1f}",
                f"{share:.4f}", *means, *bounds]

    def ratios(self, row):
        """Return the load over the closed form by displacement and by area."""
        crack = self.crack + self.grown(row)
        line = 2 if self.kind == "dcb" else 3
        load = abs(row[f"line_force_{line}"])/self.width
        growing = self.crack_at(abs(row[f"line_displacement_{line}"]))
        return load/self.load(growing), load/self.load(crack)


def stored_rows():
    """Return the rows of the table that exist."""
    if not ROWS.exists():
        return []
    with open(ROWS, encoding="utf-8") as table:
        return list(csv.DictReader(table))


def run_strips(implam, folder, kinds, arms, cells, control="energy"):
    """Run the strips that have no row yet, and add their rows."""
    done = {(row["strip"], row["arm"], row["cell"], row["control"]) for row in stored_rows()}
    for kind in kinds.split(","):
        for arm in arms.split(","):
            for cell in cells.split(","):
                strip = Strip(kind, 1e-3*float(arm), 1e-3*float(cell))
                if (kind, f"{float(arm):g}", f"{float(cell):g}", control) in done:
                    continue
                place = Path(folder)/f"{kind}_{arm}_{cell}_{control}"
                place.mkdir(parents=True, exist_ok=True)
                (place/"deck.nml").write_text(strip.deck(control), encoding="utf-8")
                run([implam, place/"deck.nml", "--output", place], check=True, capture_output=True)
                with open(place/"strip_history.csv", encoding="utf-8") as history:
                    rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(history)]
                add_row(strip.result(rows, control))


def add_row(values):
    """Append a row to the table, and print it."""
    append_row(ROWS, COLUMNS, dict(zip(COLUMNS, values, strict=True)))
    print(*values, flush=True)


if __name__ == "__main__":
    run_strips(*sys.argv[2:])
