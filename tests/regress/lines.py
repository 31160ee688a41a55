"""Lines on quarters of plates, in time, on ranks and across restarts.
Usage: lines.py quarter|plane|turned|time|edges|opened|ranks|restart IMPLAM FOLDER [LAUNCHER...]
(LAUNCHER takes the number of ranks as its last word)

quarter  a strip against its quarter or half: deflection and forces to 1e-9
plane    a force along a strip stretches it, with linear strains and with von Karman's: F L/(E A) to 1e-6
turned   a strip on two lines under two forces, and half of it with point symmetry: to 1e-9
time     prescribed lines are held exactly, with the force of equilibrium: fixed as in load steps, ramps and smooth
         starts the same with half the step length, the ledger closed; also with a pressure, with two integrators
edges    a line that ends at supported edges: its work is half its force times its displacement, in load steps, in
         time and by central differences; supported nodes do not belong to it
opened   lines that open an interface in the initial equilibrium: its fracture energy is work, and dissipated
ranks    a notched strip in steps of dissipation, on 1 and 2 ranks: to 1e-6; a line to clamped edges on 2 ranks
restart  the same from a checkpoint while damage grows: bitwise"""

import re
import sys
from pathlib import Path

from restart import check_goes_on
from solver_runs import (
    DECKS,
    exit_code_of,
    largest_difference,
    read_history,
    require,
    run_deck,
    write_deck,
)

NOTCHED = ["mesh%elements=56,2", "static%steps=12", "static%dissipation=0.12", "delamination%strength_shear=40e6"]


def check_quarter(implam, folder, _):
    """One line for two symmetric ones, and one at the centre; for a half across the lines, all of them."""
    whole = read_history(run_deck(implam, write_deck(folder / "whole", "three_point.nml")))
    for part, elements in (("quarter", "10,2"), ("half_x", "10,4"), ("half_y", "20,2")):
        deck = write_deck(folder / part, "three_point.nml", [f"plate%symmetry='{part}'", f"mesh%elements={elements}"])
        number = {2: 2, 3: 3, 5: 5}
        if part != "half_y":
            text = deck.read_text(encoding="utf-8")
            deck.write_text("\n".join(line for line in text.splitlines() if "at=-" not in line), encoding="utf-8")
            number = {2: 1, 3: 2, 5: 3}
        found = read_history(run_deck(implam, deck))
        names = {"deflection": "deflection", "work_external": "work_external",
                 **{f"line_force_{line}": f"line_force_{own}" for line, own in number.items()}}
        for name, own in names.items():
            value, expected = found[own][-1], whole[name][-1]
            require(abs(value - expected) <= 1e-9*abs(expected),
                    f"{name}: {value!r} with {part}, not {expected!r}.")


# An undamped cantilever.
CANTILEVER = """&case name='cantilever' kinematics='linear' /
&plate length=0.1, 0.02 edges='clamped','free','free','free' in_plane='fixed' /
&mesh elements=20, 4 /
&material name='al' density=2700 E=70e9 nu=0.3 /
&laminate materials='al' angles=0 thicknesses=2e-3 /
"""
HELD, END = 1e-4, 1e-3
# Difference of the forces with half the step length, of their root mean square: 1.4, 3.8 and 4.9 % at most. The rest
# are waves that the steps do not resolve.
SAME_FORCE = {"smooth": 0.02, "pressed": 0.05, "set": 0.06}
MOVED = f"&line at=0.05 displacement={HELD} history='{{}}' {{}} /\n"
TURNED = "&line at=0 component='theta_x' rotation=0.01 history='fixed' /\n"
PRESSED = "&pressure value=1000 /\n"


def line_history(implam, folder, groups):
    """Return the history of the cantilever with some groups, its ledger closed to round-off."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "deck.nml").write_text(CANTILEVER + groups, encoding="utf-8")
    history = read_history(run_deck(implam, folder / "deck.nml"))
    error, work = max(map(abs, history["energy_error"])), max(map(abs, history["work_external"]))
    require(error <= 1e-8*work, f"{error/work:.2g} of the work is the energy error in {folder.name}.")
    return history


def check_time(implam, folder, _):
    """Lines fixed from the start, ramps, and fixed lines while a pressure deflects the plate."""
    static = line_history(implam, folder / "static", MOVED.format("fixed", "") + TURNED + "&static steps=1 /\n")
    for name, integrator in (("alpha", ""), ("newmark", "integrator='newmark' beta=0.25 gamma=0.5")):
        end = f"&time end={END} {integrator} step="
        fixed = line_history(implam, folder / f"{name}_fixed", MOVED.format("fixed", "") + TURNED + f"{end}1e-5 /\n")
        for line in ("line_force_1", "line_force_2", "work_external"):
            worst = max(abs(force/static[line][-1] - 1) for force in fixed[line])
            require(worst < 1e-6, f"{name}: {line} is off by {worst:.2g} of that in load steps.")
        ramp = line_history(implam, folder / f"{name}_ramp", MOVED.format("ramp", "") + f"{end}1e-5 /\n")
        worst = max(abs(place/(HELD*time/END) - 1) for time, place in zip(ramp["time"], ramp["line_displacement_1"],
                                                                          strict=True))
        require(worst < 1e-4, f"{name}: the line is off by {worst:.2g}.")
        for kind, groups in (("smooth", MOVED.format("ramp", "rise=3e-4")),
                             ("pressed", PRESSED + MOVED.format("ramp", "rise=3e-4")),
                             ("set", MOVED.format("fixed", "rise=3e-4"))):
            coarse, fine = (line_history(implam, folder / f"{name}_{kind}_{step}", f"{groups}{end}{step} /\n")
                            for step in ("5e-6", "2.5e-6"))
            forces = coarse["line_force_1"][1:], fine["line_force_1"][3::2]
            difference = rms(a - b for a, b in zip(*forces, strict=True))/rms(forces[1])
            print(f"{name} {kind}: the force differs by {difference:.2g} with half the step")
            require(difference < SAME_FORCE[kind], f"{name}: the force depends on the step.")


def check_plane(implam, folder, _):
    """A plate has in-plane motion also where strains are linear and the laminate does not couple it with bending."""
    force, expected = 1e3, 1e3*0.1/(70e9*0.02*2e-3)
    for kinematics in ("linear", "von_karman"):
        case = folder / kinematics
        case.mkdir(parents=True, exist_ok=True)
        (case / "deck.nml").write_text(CANTILEVER.replace("linear", kinematics).replace("nu=0.3", "nu=0")
                                       + f"&line at=0.05 component='u' force={force} /\n&static /\n", encoding="utf-8")
        place = read_history(run_deck(implam, case / "deck.nml"))["line_displacement_1"][-1]
        require(abs(place/expected - 1) < 1e-6, f"{kinematics}: the end moves by {place!r}, not {expected!r}.")


def check_turned(implam, folder, _):
    """A plate symmetric under rotation by 180 degrees about z cannot tilt, so one line and its image support it."""
    found = {}
    for symmetry, elements, sides in (("none", "8,4", (1, -1)), ("point", "4,4", (1,))):
        case = folder / symmetry
        case.mkdir(parents=True, exist_ok=True)
        lines = "".join(f"&line at={0.05*side} displacement=0 /\n&line at={0.0125*side} force=30 /\n" for side in sides)
        (case / "deck.nml").write_text(CANTILEVER.replace("'clamped',", "'free',").replace("elements=20, 4", (
            f"grading=1 elements={elements}")).replace("in_plane", f"symmetry='{symmetry}' in_plane")
            + lines + "&static /\n", encoding="utf-8")
        found[symmetry] = read_history(run_deck(implam, case / "deck.nml"))
    for name in ("deflection", "work_external", "line_force_1", "line_displacement_2"):
        value, expected = found["point"][name][-1], found["none"][name][-1]
        require(abs(value - expected) <= 1e-9*abs(expected), f"{name}: {value!r} of the half, not {expected!r}.")


# Nodes at the ends of the line are supported by the edges.
CLAMPED = "'clamped'"
BETWEEN_EDGES = CANTILEVER.replace("'clamped','free','free','free'", "{}").replace("0.1, 0.02", "0.1, 0.06")


def check_edges(implam, folder, _):
    """Clamped, simple and one free edge; deflection, and a displacement along the line."""
    for edges, line in (("'clamped'", ""), ("'simple'", "direction='x'"), ("'clamped','free','free','clamped'", ""),
                        ("'clamped'", "component='u'")):
        found = {}
        for name, end in (("static", "&static steps=1 /"), ("time", "&time end=1e-4 step=1e-5 /"),
                          ("explicit", "&time end=1e-5 integrator='central_difference' /")):
            case = folder / re.sub(r"\W+", "_", f"{edges}{line}{name}")
            case.mkdir(parents=True, exist_ok=True)
            (case / "deck.nml").write_text(f"{BETWEEN_EDGES.format(edges)}&line at=0 displacement={HELD} "
                                           f"history='fixed' {line} /\n{end}\n", encoding="utf-8")
            history = read_history(run_deck(implam, case / "deck.nml"))
            force, place, work = (history[column][-1] for column in ("line_force_1", "line_displacement_1",
                                                                     "work_external"))
            found[name] = force
            require(abs(place/HELD - 1) < 1e-3, f"{case.name}: the line is at {place!r}.")
            require(abs(force*HELD/2/work - 1) < 1e-3, f"{case.name}: a force of {force!r} did a work of {work!r}.")
        require(max(found.values())/min(found.values()) < 1.001, f"{edges} {line}: the forces are {found}.")


# A double cantilever whose crack grows in the initial equilibrium. The mass is at rest, so there is no other motion.
OPENED = """&case name='opened' kinematics='linear' /
&plate length=0.066, 0.025 edges='free','clamped','free','free' /
&mesh elements=44, 2 /
&material name='ply' density=1580 E1=139.4e9 E2=10.16e9 G12=4.6e9 G13=4.6e9 G23=3.54e9 nu12=0.30 /
&laminate materials='ply' angles=0,0 thicknesses=2*1.5e-3 shear_correction='5/6' /
&line at=-0.033 layer=1 displacement=-0.7e-3 history='fixed' /
&line at=-0.033 layer=2 displacement=0.7e-3 history='fixed' /
&delamination below_ply=1 law='cohesive' G_Ic=170.3 G_IIc=493 strength_opening=10e6 strength_shear=40e6
              zone=0.066,0.025 starter_strip=-0.033,-0.003 /
"""
# Measured: 3e-8 of the work.
SAME_ENERGY = 1e-6


def check_opened(implam, folder, _):
    """Fracture energy of the initial equilibrium, with implicit steps and by central differences."""
    for name, steps in (("implicit", "step=1e-6 integrator='generalized_alpha'"),
                        ("explicit", "integrator='central_difference' mass_scaling=1")):
        deck = folder / name / "opened.nml"
        deck.parent.mkdir(parents=True, exist_ok=True)
        deck.write_text(f"{OPENED}&time end=2e-6 {steps} /\n", encoding="utf-8")
        history = read_history(run_deck(implam, deck))
        work, fracture = history["work_external"][-1], history["energy_below_1"][-1]
        print(f"{name}: {fracture:.6g} of fracture, {work:.6g} of work")
        require(fracture > 0.02*work, "The crack has not grown.")
        for what, value, expected in (("energy_delamination", history["energy_delamination"][-1], fracture),
                                      ("energy_error", history["energy_error"][-1], 0.0),
                                      ("work_external", work, fracture + history["energy_strain"][-1])):
            require(abs(value - expected) <= SAME_ENERGY*work, f"{name}: {what} is {value}, not {expected}.")


def rms(values):
    """Return the root mean square."""
    squares = [value*value for value in values]
    return (sum(squares)/len(squares))**0.5


def check_ranks(implam, folder, launcher):
    """One rank and two."""
    one = read_history(run_deck(implam, write_deck(folder / "one", "enf.nml", NOTCHED)))
    two = read_history(run_deck(implam, write_deck(folder / "two", "enf.nml", NOTCHED), (*launcher, "2")))
    require(one["delaminated_area"][-1] > 1.03*one["delaminated_area"][0], "The crack does not grow.")
    left_out = [name for name in one if "iterations" in name or name in ("factorizations", "solves")]
    difference, name = largest_difference(two, one, left_out)
    require(difference <= 1e-6, f"{name} differs by {difference:.2g} of its largest value.")
    deck = folder / "held" / "deck.nml"
    deck.parent.mkdir(parents=True, exist_ok=True)
    deck.write_text(f"{BETWEEN_EDGES.format(CLAMPED)}&line at=0.025 displacement={HELD} /\n&static steps=1 /\n",
                    encoding="utf-8")
    history = read_history(run_deck(implam, deck, (*launcher, "2")))
    force, place, work = (history[column][-1] for column in ("line_force_1", "line_displacement_1", "work_external"))
    require(abs(place/HELD - 1) < 1e-3, f"On two ranks the line is at {place!r}.")
    require(abs(force*HELD/2/work - 1) < 1e-3, f"On two ranks a force of {force!r} did a work of {work!r}.")


def check_restart(implam, folder, _):
    """From the last checkpoint, while damage grows."""
    rows = check_goes_on(implam, folder, "enf.nml", [*NOTCHED, "output%checkpoint_every=0.7"])
    require(rows["load_factor"][-1] < max(rows["load_factor"]), "The load does not decrease.")


def trial(kind, implam, folder, *launcher):
    """Run one trial."""
    checks = {"quarter": check_quarter, "plane": check_plane, "turned": check_turned, "time": check_time,
              "edges": check_edges, "opened": check_opened, "ranks": check_ranks, "restart": check_restart}
    require((DECKS / "enf.nml").exists(), "The decks are missing.")
    checks[kind](implam, Path(folder), launcher)


if __name__ == "__main__":
    raise SystemExit(exit_code_of(trial, *sys.argv[1:]))
