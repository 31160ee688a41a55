"""Beam theory and the plate of all plies: doublers and ply drops, also with a stringer on a doubler.
Usage: zones.py IMPLAM FOLDER

Beams bend with the stiffness about the centroid of each part, with 5/6 of the shear stiffness; a force along a strip at
the skin's mid-plane bends the part whose centroid lies beside it."""

import sys
from pathlib import Path

from solver_runs import exit_code_of, read_history, require, run_deck

LENGTH, WIDTH, MODULUS, PLY = 100.0, 20.0, 70e3, 2.0
BEAM = """&case kinematics='linear' /
&plate length={length:g},{width:g} edges='clamped','free','free','free' /
&mesh elements=20,2 /
&material name='alloy' E={modulus:g} nu=0 /
{plies}
&line at={end:g} {load} /
&gauge at=-25,0 face='back' /
&gauge at=-25,0 face='front' /
&static /
"""
SKIN = "&laminate materials='alloy' stacking='[0]' ply_thickness=2 /\n"
ON_BACK = SKIN + "&doubler name='root' at=-25,0 size=50,20 materials='alloy' stacking='[0]' ply_thickness=2 /"
ON_FRONT = ON_BACK.replace("name='root'", "name='root' face='front'")
DROPPED = ("&laminate materials='alloy' stacking='[0_2]' ply_thickness=2 /\n"
           "&ply_drop plies=2 at=25,0 size=50,20 flat_face='{flat}' /")
CLOSE = 1e-9  # measured: 3e-11

PLATE = """&case units='mm-t-s' /
&plate length=60,40 edges='clamped' /
&mesh elements=12,8 patch=8 /
&material library='im7_8552' name='ply' /
&laminate materials='ply' stacking='[{laminate}]' ply_thickness=0.5 /
{doubler}
&impactor mass=1e-3 velocity={speed} radius=8 /
&indentation law='hertz' k=30000 /
{damage}
&time end=2e-4 {time} /
&solver tolerance=1e-11 /
&output history_every=1e-5 /
"""
ALL, HALF, OTHER_HALF = "0/90/45/-45/90/0", "0/90/45", "-45/90/0"
BOND = "&doubler name='all' face='{face}' at=0,0 size=60,40 materials='ply' stacking='[{plies}]' ply_thickness=0.5 /"
EXPLICIT = "integrator='central_difference' step=2e-8"
DAMAGE = ("&ply_damage criteria='hashin' /\n"
          "&delamination below_ply={below} law='cohesive' G_Ic=0.03 G_IIc=0.08 zone=60,40 /")
STRINGER = "&stringer name='web' along='x' at=10 height=10 thickness=1 E=70e3 density=1.6e-9 /"
# Times, speed, and groups of damage or a stringer.
TRIALS = {"implicit": ("step=5e-6", 1500, ""), "explicit": (EXPLICIT, 1500, ""),
          "failing": (EXPLICIT, 4000, DAMAGE), "stiffened": (EXPLICIT, 1500, STRINGER)}
# Relative to the largest value of each column. Measured: 1e-14; failures amplify round-off.
SAME = {"implicit": 1e-10, "explicit": 1e-10, "failing": 1e-9, "stiffened": 1e-10}
DAMAGED = ("delaminated_area", "energy_ply_damage")
COLUMNS = ("force", "deflection", "impactor_velocity", "energy_strain", *DAMAGED)


def beam(folder, implam, name, plies, load):
    """Return displacement of the end and strains of the root on back and front."""
    path = folder / name / "deck.nml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(BEAM.format(length=LENGTH, width=WIDTH, modulus=MODULUS, end=LENGTH / 2, plies=plies, load=load),
                    encoding="utf-8")
    history = read_history(run_deck(implam, path))
    return [history[column][-1] for column in ("line_displacement_1", "gauge_strain_1", "gauge_strain_2", "deflection")]


def compare(name, found, expected):
    """Print and check figures."""
    worst = max(abs(one / other - 1) for one, other in zip(found, expected, strict=True))
    print(f"{name}: {worst:.1e} of beam theory")
    require(worst < CLOSE, f"{name}: {found}, expected {expected}.")


def try_beams(implam, folder):
    """Bend and pull stepped strips."""
    inertia = [WIDTH * (part * PLY)**3 / 12 for part in (2, 1)]
    area = [WIDTH * part * PLY for part in (2, 1)]
    half = LENGTH / 2
    force = 10.0
    tip = force / MODULUS * ((LENGTH**3 - half**3) / 3 / inertia[0] + half**3 / 3 / inertia[1]) \
        + force * half / (5 / 6 * MODULUS / 2) * (1 / area[0] + 1 / area[1])
    for name, plies in (("back", ON_BACK), ("front", ON_FRONT), ("flat front", DROPPED.format(flat="front")),
                        ("flat back", DROPPED.format(flat="back"))):
        compare("bent, " + name, beam(folder, implam, "bent " + name, plies, f"force={force}")[:1], [tip])
    force, offset = 100.0, PLY / 2
    for name, plies, sign in (("back", ON_BACK, 1), ("front", ON_FRONT, -1)):
        curvature = force * offset / (MODULUS * inertia[0])
        mean = force / (MODULUS * area[0])
        pulled = [mean * half + force / (MODULUS * area[1]) * half + offset * curvature * half,
                  mean - sign * curvature * PLY, mean + sign * curvature * PLY, sign * curvature * half * half / 2]
        found = beam(folder, implam, "pulled " + name, plies, f"component='u' force={force}")
        compare("pulled, " + name, found, pulled)


# Plies of the laminate, face and plies of the doubler, and the interface that may delaminate, in the plate of all plies
# and in that with the doubler.
PLATES = ((HALF, "back", OTHER_HALF, 2, 2), (OTHER_HALF, "front", HALF, 4, 1))


def plate_of(folder, implam, trial, laminate, bond, below):
    """Return the history of a plate."""
    time, speed, groups = trial
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "deck.nml"
    path.write_text(PLATE.format(laminate=laminate, doubler=bond, time=time, speed=speed,
                                 damage=groups.format(below=below)), encoding="utf-8")
    return read_history(run_deck(implam, path))


def try_full_plates(implam, folder):
    """Compare plates with a doubler over their full area with the plate of all plies."""
    for name, trial in TRIALS.items():
        expected = None
        for laminate, face, added, below_of_all, below in PLATES:
            place = folder / f"{name} {face}"
            if expected is None or trial[2] == DAMAGE:
                expected = plate_of(place / "all", implam, trial, ALL, "", below_of_all)
            found = plate_of(place / "bonded", implam, trial, laminate, BOND.format(face=face, plies=added), below)
            for column in COLUMNS:
                largest = max(map(abs, expected[column]))
                difference = max(abs(one - other) for one, other in zip(expected[column], found[column], strict=True))
                print(f"{name}, {face}, {column}: {difference / (largest or 1):.1e} of {largest:.4g}")
                require(difference <= SAME[name] * largest, f"{name}: {column} differs.")
            require(trial[2] != DAMAGE or min(max(expected[column]) for column in DAMAGED) > 0, "Nothing fails.")


def main(implam, folder):
    """Run all."""
    return max(exit_code_of(trial, implam, Path(folder)) for trial in (try_beams, try_full_plates))


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
