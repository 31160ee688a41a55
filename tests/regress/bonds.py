"""Laminated beams and the plate of all plies: doublers whose bond may delaminate.
Usage: bonds.py TRIAL IMPLAM FOLDER [LAUNCHER...]     (LAUNCHER takes the number of ranks as its last word)

plates   a doubler over the full plate, on either face, also with a stringer on it, equals the plate of all plies with
         the interface between them
stiff    a strong bond tends to the rigid one
strips   single-leg bending, and a skin with a bonded flange in three-point bending: energy release rate and load at
         growth
explicit single-leg bending by central differences on long cells: load at growth
ranks    two doublers with one bond, one on the struck face, the interfaces of the plies and failing plies: 1 and 3
         ranks and a restart give the same history
mirror   a doubler on the struck face, and the mirror image of that plate with the doubler on its back
second   a second impact beside the first, on another mesh: areas do not shrink"""

import math
import sys
from itertools import pairwise
from pathlib import Path

from restart import copy_run, go_on, require_same
from solver_runs import exit_code_of, read_history, require, run, run_deck
from zones import ALL, BOND, EXPLICIT, HALF, OTHER_HALF, PLATE, STRINGER

LAW = "law='cohesive' G_Ic=0.03 G_IIc=0.08"
# Of the plate of all plies, and of that with the doubler.
INTERFACES = ("&delamination below_ply={plies} zone=60,40 " + LAW + " /",
              "{others}&delamination doubler='all' " + LAW + " /")
PLIES_FAIL = "&ply_damage criteria='hashin' /\n"
# Time, speed, further groups, faces of the doubler, interfaces of the laminate, and end. Open surfaces that touch
# amplify round-off later.
FACES = {"back": (HALF, OTHER_HALF, 3), "front": (OTHER_HALF, HALF, 0)}
PLATES = {"implicit": ("step=2e-6", 4000, PLIES_FAIL, ("back",), (), 2e-4),
          "explicit": (EXPLICIT, 4000, PLIES_FAIL, ("front",), (), 2e-4),
          "interfaces": (EXPLICIT, 7000, "", ("back", "front"), (1, 2), 1.35e-4),
          "stiffened": (EXPLICIT, 7000, STRINGER + "\n", ("front",), (), 1.35e-4)}
SAME = 1e-8  # measured: 1.2e-9 after growth, which amplifies round-off, else 1e-11
COLUMNS = ("force", "deflection", "impactor_velocity", "energy_strain", "delaminated_area", "energy_delamination",
           "projected_area", "area_below_3", "energy_error")

MODULUS, WIDTH, TOUGHNESS, SKIN = 139e9, 20e-3, 300.0, 1e-3
STRIP = """&case kinematics='linear' /
&plate length=0.12, 0.02 edges='free' /
&mesh elements={elements},2 /
&material name='i' density=1600 E=139e9 nu=0 /
&laminate materials='i' angles=0 thicknesses=1e-3 /
&doubler name='{name}' at={middle},0 size={length},0.02 materials='i' stacking='[0]' ply_thickness={thickness} /
&line at=-0.05 displacement=0 history='fixed' /
&line at=0.05 displacement=0 history='fixed' /
&line at=0 {load} /
&delamination doubler='{name}' G_c=300 strength_opening={strengths[0]} strength_shear={strengths[1]}
              starter_strip={edge}, {front} /
&static {static} /
"""
# By central differences: half of the span, edge and front, side of a cell, and the length that the rotation of the arms
# at the front adds to the crack, (E t^2/(10 G))^(1/2).
HALF_SPAN, EDGE, FRONT, CELL, ROOT = 50e-3, -36e-3, -20e-3, 2e-3, SKIN * math.sqrt(0.2)
SLOW_STRIP = """&case kinematics='linear' /
&plate length=0.12, 0.02 edges='free' /
&mesh elements=60,2 /
&material name='i' density=1600 E=139e9 nu=0 /
&laminate materials='i' angles=0 thicknesses=1e-3 /
&doubler name='arm' at={middle},0 size={length},0.02 materials='i' stacking='[0]' ply_thickness=1e-3 /
&line at=-{half} displacement=0 history='fixed' /
&line at={half} displacement=0 history='fixed' /
&line at=0 displacement={travel} rise={rise} /
&delamination doubler='arm' G_c=300 strength_opening=60e6 strength_shear=90e6 starter_strip={edge}, {front} /
&time integrator='central_difference' end={end} mass_scaling=1000 /
&output history_every={every} /
"""
MIRRORED = """&case units='SI' /
&plate length=0.1, 0.08 edges='clamped' in_plane='fixed' /
&mesh elements=20, 16 /
&material library='im7_8552' name='ply' /
&laminate materials='ply' stacking='[{laminate}]' ply_thickness=0.25e-3 /
&doubler name='pad' face='{face}' at=0.005, 0.01 size=0.04, 0.02 materials='ply' stacking='[{doubler}]'
         ply_thickness=0.5e-3 /
&delamination doubler='pad' law='cohesive' G_Ic=280 G_IIc=790 starter_strip=-0.015, 0 /
&line at=0.03 displacement={sign}1.5e-3 {rise} /
{rest}
"""
MIRROR = 1e-9  # measured: 4e-14
# Thickness, x of both edges, and of the front. Half of the span: 50 mm.
STRIPS = {"single leg": (1e-3, -35e-3, 60e-3, -20e-3), "flange": (0.6e-3, -25e-3, 45e-3, -15e-3)}


def bending_stiffness(thickness):
    """Bending stiffness of skin and doubler about their common axis, of the skin without."""
    area, offset = SKIN + thickness, (SKIN + thickness) / 2
    axis = thickness * offset / area
    return MODULUS * WIDTH * ((SKIN**3 + thickness**3) / 12 + SKIN * axis**2 + thickness * (offset - axis)**2)


def release_rate(crack, thickness):
    """Energy release rate of a force of 1 at mid-span; `crack`: distance of the front from the support.

    The moment before the front is that of the skin alone, P crack/2, behind it that of skin and doubler."""
    return crack**2 / (8 * WIDTH) * (1 / bending_stiffness(0) - 1 / bending_stiffness(thickness))


def strip(folder, implam, name, **changes):
    """Return the history of a strip."""
    thickness, edge, end, front = STRIPS[name]
    values = {"elements": 120, "name": name, "middle": (edge + end) / 2, "length": end - edge, "thickness": thickness,
              "edge": edge, "front": front} | changes
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "deck.nml"
    path.write_text(STRIP.format(**values), encoding="utf-8")
    return read_history(run_deck(implam, path))


def try_strips(implam, folder):
    """Compare energy release rate and load at growth with laminated beams."""
    for name, (thickness, edge, _, front) in STRIPS.items():
        step = 2e-3
        energies = [strip(folder / name / side, implam, name, load="force=20", static="", strengths=(1e15, 1e15),
                          front=front + offset)["energy_strain"][-1]
                    for side, offset in (("before", -step), ("behind", step))]
        found = (energies[1] - energies[0]) / (2 * step * WIDTH)
        expected = 400 * release_rate(front + 50e-3, thickness)
        print(f"{name}: energy release rate {found / expected:.4f} of the closed form")
        require(abs(found / expected - 1) < 0.03, f"{name}: the energy release rate differs.")
        rows = strip(folder / name / "grows", implam, name, load="displacement=4e-3", strengths=(30e6, 60e6),
                     static="steps=40 dissipation=0.08")
        ratios = []
        for area, force in zip(rows["delaminated_area"], rows["line_force_3"], strict=True):
            crack = edge + 50e-3 + area / WIDTH
            if area / WIDTH > front - edge + 3e-3:
                ratios.append(abs(force) / math.sqrt(TOUGHNESS / release_rate(crack, thickness)))
        mean = sum(ratios) / len(ratios)
        print(f"{name}: load at growth {mean:.4f} of the closed form in the mean of {len(ratios)} steps, "
              f"{min(ratios):.4f} to {max(ratios):.4f}")
        require(len(ratios) > 10, f"{name}: nothing grows.")
        require(abs(mean - 1) < 0.03, f"{name}: the load at growth differs.")
        require(max(map(abs, rows["energy_error"])) < 1e-6 * max(rows["work_external"]), f"{name}: ledger.")


def plate(folder, implam, trial, laminate, groups):
    """Return the path of the history of a plate."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "deck.nml"
    text = PLATE.format(laminate=laminate, doubler="", time=trial[0], speed=trial[1], damage=trial[2] + groups)
    path.write_text(text.replace("end=2e-4", f"end={trial[-1]}"), encoding="utf-8")
    return run_deck(implam, path)


def try_plates(implam, folder):
    """Compare plates with a doubler bonded over their full area, on either face, with the plate of all plies."""
    for name, trial in PLATES.items():
        faces, others, _ = trial[3:]
        for face in faces:
            laminate, doubler, below = FACES[face]
            place = f"{name} {face}"
            changed = (*trial[:2], trial[2].replace("&stringer", f"&stringer face='{face}'"), *trial[3:])
            plies = [3, *(ply + (0 if below else 3) for ply in others)]
            expected = read_history(plate(folder / place / "all", implam, changed, ALL, INTERFACES[0].format(
                plies=", ".join(map(str, sorted(plies))))))
            of_laminate = INTERFACES[0].format(plies=", ".join(map(str, others))) + "\n" if others else ""
            bond = BOND.format(face=face, plies=doubler) + "\n"
            found = read_history(plate(folder / place / "bonded", implam, changed, laminate,
                                       bond + INTERFACES[1].format(others=of_laminate)))
            for column in COLUMNS:
                largest = max(map(abs, expected["energy_impactor" if column == "energy_error" else column]))
                there = found[f"area_below_{below}" if column == "area_below_3" else column]
                difference = max(abs(one - other) for one, other in zip(expected[column], there, strict=True))
                print(f"{place}, {column}: {difference / (largest or 1):.1e} of {largest:.4g}")
                require(difference <= SAME * largest, f"{place}: {column} differs.")
            require(max(expected["area_below_3"]) > 0, f"{place}: the bond does not fail.")


def try_stiff(implam, folder):
    """A strip under a force at mid-span with a rigid and with stronger and stronger bonds."""
    settings = {"load": "force=0.02", "static": "", "strengths": (1e6, 1e6)}
    gaps = []
    for stiffness in (1e12, 1e13, 1e14, None):
        text = STRIP.replace("starter_strip={edge}, {front}", f"stiffness={stiffness}")
        if stiffness is None:
            text = text.replace(text[text.index("&delamination"):text.index("&static")], "")
        path = folder / f"{stiffness}" / "deck.nml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text.format(elements=120, name="pad", middle=0, length=0.12, thickness=0.6e-3,
                                    **settings), encoding="utf-8")
        gaps.append(read_history(run_deck(implam, path))["line_displacement_3"][-1])
    gaps = [one / gaps[-1] - 1 for one in gaps[:-1]]
    print("deflection with stronger bonds over that with a rigid one, minus 1: "
          + ", ".join(f"{gap:.2e}" for gap in gaps))
    require(gaps[0] > gaps[1] > gaps[2] > 0 and gaps[2] < 5e-3, "The bond does not tend to the rigid one.")


def travel(crack, load):
    """Displacement of the force at mid-span: both halves of the beam, the moment before the front on the skin alone."""
    skin, both, shear = bending_stiffness(0), bending_stiffness(SKIN), 5 / 12 * MODULUS * WIDTH * SKIN
    half = HALF_SPAN**3 / (3 * both) + HALF_SPAN / (2 * shear)
    cracked = half + crack**3 / 3 * (1 / skin - 1 / both) + crack**2 * ROOT / 4 / skin + crack / (2 * shear)
    return load * (half + cracked) / 4


def growth_load(crack):
    """Load at growth of single-leg bending, with the rotation of the arms at the front in its opening part."""
    shear, opening = 3 / 64 * crack**2, (crack + ROOT)**2 / 16
    return math.sqrt(TOUGHNESS * WIDTH * bending_stiffness(0) / (shear + opening))


def crack_at(displacement):
    """Length of a crack that grows at a displacement."""
    low, high = HALF_SPAN + FRONT, 4 * HALF_SPAN
    for _ in range(60):
        middle = (low + high) / 2
        if travel(middle, growth_load(middle)) < displacement:
            low = middle
        else:
            high = middle
    return low


def try_explicit(implam, folder):
    """Bend a single leg slowly by central differences, on cells about as long as the process zones.

    The front jumps from node to node; loads are those of the crack that grows at the displacement, in the mean over
    whole cells of growth after the first, as in tests/studies/growth_strips.py."""
    last = 0.9 * HALF_SPAN
    period = 2 * math.pi * (2 * HALF_SPAN)**2 / math.pi**2 * math.sqrt(1600 * SKIN * WIDTH / bending_stiffness(0))
    path = folder / "deck.nml"
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(SLOW_STRIP.format(travel=travel(last, growth_load(last)), end=10 * period, rise=2.5 * period,
                                      every=period / 100, half=HALF_SPAN, edge=EDGE, front=FRONT,
                                      middle=(EDGE + 60e-3) / 2, length=60e-3 - EDGE), encoding="utf-8")
    rows = read_history(run_deck(implam, path))
    grown = [area / WIDTH - (FRONT - EDGE) for area in rows["delaminated_area"]]
    require(grown[-1] > 6 * CELL, "The bond hardly fails.")
    last = math.floor(grown[-1] / CELL) * CELL
    ratios = [abs(force) / growth_load(crack_at(abs(displacement))) for length, force, displacement in
              zip(grown, rows["line_force_3"], rows["line_displacement_3"], strict=True) if CELL <= length <= last]
    mean = sum(ratios) / len(ratios)
    print(f"load at growth {mean:.4f} of the closed form in the mean of {len(ratios)} rows")
    require(abs(mean - 1) < 0.03, "The load at growth differs.")
    largest = max(rows["work_external"])
    print(f"ledger: {max(map(abs, rows['energy_error'])) / largest:.1e} of the work")
    require(max(map(abs, rows["energy_error"])) < 2e-3 * largest, "The ledger does not close.")


SMALL = """&case units='mm-t-s' /
&plate length=60,40 edges='clamped' /
&mesh elements=15,10 patch=4 /
&material library='im7_8552' name='ply' /
&laminate materials='ply' stacking='[0/90/45]' ply_thickness=0.25 /
&doubler name='flange' at=0,8 size=32,12 materials='ply' stacking='[0/90]' ply_thickness=0.25 /
&doubler name='pad' at=-16,-8 size=16,8 materials='ply' stacking='[45]' ply_thickness=0.25 /
&doubler name='patch' at=16,-8 size=16,8 materials='ply' stacking='[90]' ply_thickness=0.25 /
&doubler name='cap' face='front' at=0,1 size=16,26 materials='ply' stacking='[0]' ply_thickness=0.25 /
&impactor mass=1e-4 velocity=6000 radius=8 at={at} /
&indentation law='hertz' k=30000 /
&ply_damage criteria='hashin' /
&delamination below_ply='all' G_Ic=0.1 G_IIc=0.25 /
&delamination doubler='flange','pad' G_Ic=0.1 G_IIc=0.25 /
&delamination doubler='cap' G_Ic=0.1 G_IIc=0.25 /
{more}
&time integrator='central_difference' end={end} {rest} /
&output history_every=1e-5 checkpoint_every=5e-5 fields_every=1e-4 /
"""


def try_ranks(implam, folder, launcher):
    """Run a plate with four doublers, of which three may come off, on 1 and 3 ranks and from a checkpoint."""
    histories = []
    for ranks in (1, 3):
        path = folder / str(ranks) / "deck.nml"
        path.parent.mkdir(parents=True, exist_ok=True)
        text = SMALL.format(at="2,4", more="", end=2.2e-4, rest="").replace("velocity=6000", "velocity=12000")
        path.write_text(text, encoding="utf-8")
        histories.append(run_deck(implam, path, [*launcher, str(ranks)]))
        require_same(histories[-1], histories[0], f"{ranks} ranks")
    require_same(go_on(implam, copy_run(folder / "1", folder / "again")), histories[0], "restart")
    rows = read_history(histories[0])
    require(min(rows[f"area_below_{ply}"][-1] for ply in (0, 2, 3)) > 0, "An interface does not fail.")
    require(max(map(abs, rows["energy_error"])) < 2e-3 * rows["energy_impactor"][0], "The ledger does not close.")


def try_second(implam, folder):
    """Strike beside the first impact, on other mesh lines: areas are kept until the contact begins, and grow."""
    ends = []
    for name, at, more, rest in (("first", "2,4", "", "settle=1e-4"),
                                   ("second", "-10,6", "&initial_state from='first_restart.h5' /", "settle=4e-4")):
        path = folder / f"{name}.nml"
        folder.mkdir(parents=True, exist_ok=True)
        path.write_text(SMALL.format(at=at, more=more, end=8e-4, rest=rest).replace(
            "&case", f"&case name='{name}'"), encoding="utf-8")
        run([implam, path.name], folder=folder)
        rows = read_history(folder / f"{name}_history.csv")
        ends.append(rows)
        largest = max(rows["energy_impactor"])
        print(f"{name}: bond {rows['area_below_3'][0]:.2f} to {rows['area_below_3'][-1]:.2f} mm2, ledger "
              f"{max(map(abs, rows['energy_error'])) / largest:.1e}")
        require(max(map(abs, rows["energy_error"])) < 2e-3 * largest, f"{name}: the ledger does not close.")
    for column in ("area_below_0", "area_below_1", "area_below_2", "area_below_3"):
        before, after = ends[0][column][-1], ends[1][column]
        require(abs(after[0] - before) <= 0.02 * before, f"{column}: {before}, and {after[0]} in the second run.")
        require(all(later >= now * (1 - 1e-9) for now, later in pairwise(after)), f"{column} shrinks.")


def try_mirror(implam, folder):
    """Bend a plate and its mirror image by a line, in load steps and in time, until the bond grows."""
    for name, rise, rest in (("steps", "", "&static steps=4 /"),
                             ("time", "rise=1.4e-4", "&time integrator='central_difference' end=1.5e-4 /")):
        ends = []
        for face, sign, laminate, doubler in (("front", "", "0/45/-45/90", "0/90"),
                                              ("back", "-", "90/-45/45/0", "90/0")):
            path = folder / name / face / "deck.nml"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(MIRRORED.format(face=face, sign=sign, laminate=laminate, doubler=doubler, rise=rise,
                                            rest=rest), encoding="utf-8")
            ends.append(read_history(run_deck(implam, path)))
        for column in ("energy_strain", "energy_kinetic", "energy_delamination", "delaminated_area", "line_force_1"):
            one, other = ends[0][column], [value * (-1 if "line" in column else 1) for value in ends[1][column]]
            largest = max(map(abs, one))
            difference = max(abs(here - there) for here, there in zip(one, other, strict=True))
            print(f"{name}, {column}: {difference / (largest or 1):.1e} of {largest:.4g}")
            require(difference <= MIRROR * largest, f"{name}: {column} differs.")
        require(ends[0]["delaminated_area"][-1] > ends[0]["delaminated_area"][0], f"{name}: the bond does not grow.")


TRIALS = {"ranks": try_ranks, "mirror": try_mirror, "second": try_second, "explicit": try_explicit,
          "plates": try_plates, "stiff": try_stiff, "strips": try_strips}


def main(trial, implam, folder, *launcher):
    """Run one trial."""
    return exit_code_of(TRIALS[trial], implam, Path(folder), *([launcher] if launcher else []))


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
