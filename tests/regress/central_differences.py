"""Central differences with failing plies and interfaces against repeated runs and closed forms.
Usage: central_differences.py TRIAL IMPLAM FOLDER [LAUNCHER...]     (LAUNCHER takes the number of ranks last)

ranks    on 1, 2 and 3 ranks, and from a checkpoint of one number of ranks on another: bitwise
signal   TERM, USR1 and INT end a run with a checkpoint, from which it is continued: bitwise
kill     SIGKILL at any time leaves a checkpoint from which the run continues: bitwise
events   output times do not change steps so that energy is created: the ledger stays closed
travel   an impactor moved slowly has the force of load steps, and a faster one warns
lines    prescribed displacements are met exactly; under smooth motion the force is that of load steps
steep    where slopes stiffen the plate, steps with scaled inertia create no energy
fracture the fracture energy is the toughness times the area, to 1e-6
dent     after the impact the plate comes to rest, with a dent where shear strains of plies are permanent; without
         damping the summary says that vibration is part of the dent
clamps   clamps with a force at nodes with several layers press the plate on the frame without a motion
softened residual stresses that crack plies, shear them permanently or delaminate edges before the impact: the energy
         balances within 1e-4 of the impact, also in implicit steps; the check says that their contact may last longer
         than that of an undamaged plate, where it foresees the end
"""

import random
import re
import signal
import sys
import time
from itertools import pairwise
from pathlib import Path
from subprocess import check_output

from restart import (
    EXIT_DONE,
    EXIT_STOPPED,
    copy_run,
    exit_code,
    go_on,
    main,
    model_lines,
    require_same,
    stamp,
    start,
    wait_until,
)
from solver_runs import checkpoint_of, history_of, read_history, require, run_deck, write_deck

EXPLICIT = "time%integrator='central_difference'"
# Failing plies and an interface, adaptive layers, turned halves on a unilateral frame, plies that soften and fail in
# the fibres, with strengths by their stressed volume and by the strain rate or drawn by position, curved plates,
# prescribed and loaded lines, residual stresses that deflect the plate before the impact, and interfaces that grow by
# their energy release rate on long cells.
MODELS = {"breaking": ("../small/breaking_rounds.nml", [EXPLICIT]), "layers": ("../small/layers.nml", [EXPLICIT]),
          "turned": ("../small/turned.nml", [EXPLICIT, "time%end=150e-6"]),
          "softening": ("../small/crack_bands.nml", [EXPLICIT, "time%end=150e-6"]),
          "permanent": ("../small/crack_bands.nml", [EXPLICIT, "time%end=150e-6", "ply_damage%permanent_shear=.true.",
                                                     "material%shear_failure_strain=0.05",
                                                     "material%rate_strengthening=0.075",
                                                     "material%reference_rate=1e-3",
                                                     "ply_damage%weibull_modulus=41",
                                                     "ply_damage%reference_volume=3750e-9", "material%XT=1000e6"]),
          # Two moduli along the fibres, and strengths of fibres that scatter.
          "scattered": ("../small/crack_bands.nml", [EXPLICIT, "time%end=40e-6", "plate%symmetry='none'",
                                                     "mesh%elements=16, 12", "material%E1c=100e9",
                                                     "material%XT=60e6", "ply_damage%weibull_modulus=10",
                                                     "ply_damage%reference_volume=3750e-9",
                                                     "ply_damage%strength_seed=3",
                                                     "ply_damage%strength_length=1e-3"]),
          "long_cells": ("../which_interfaces.nml", [EXPLICIT, "time%end=800e-6", "mesh%elements=10,20",
                                                     "mesh%cell=4e-3"]),
          "curved": ("../small/breaking_rounds.nml", [EXPLICIT, "plate%curvature_radius=0.2,0.15",
                                                      "plate%in_plane='tangential'", "time%end=150e-6"]),
          # A curved skin that delaminates, on cells of 4 mm.
          "curved_skin": ("../curved_skin.nml", ["mesh%elements=14, 12", "mesh%core=48e-3, 32e-3", "mesh%cell=4e-3",
                                                 "delamination%zone=48e-3, 32e-3", "impactor%energy=30",
                                                 "time%end=450e-6"]),
          "lines": ("three_point.nml", ["time%end=1e-4", EXPLICIT]),
          "cooled": ("../small/cohesive.nml", [EXPLICIT, "time%end=20e-6", "plate%edges='simple'",
                                               "plate%symmetry='point'", "laminate%angles=0, 45, 90",
                                               "impactor%velocity=10",
                                               "material%alpha1=-0.5e-6", "material%alpha2=28e-6",
                                               "thermal%delta_T=-100"])}
# Ends [s] on several ranks, after plies and interfaces have begun to fail.
ENDS_ON_RANKS = {"breaking": 90e-6, "curved": 60e-6}
STARTED_BY_THREE = "turned", "scattered", "lines", "cooled"


def deck_of(folder, model, *settings):
    """Write the deck of a model and return its path."""
    source, own = MODELS[model]
    deck = write_deck(folder, source, [*own, *settings])
    text = deck.read_text(encoding="utf-8")
    deck.write_text("\n".join(line for line in text.splitlines() if not line.startswith("&static")) + "\n",
                    encoding="utf-8")
    return deck


def end_of(deck):
    """End time of a deck."""
    return float(re.search(r"^&time\b[^/]*\bend=(\S+)", deck.read_text(encoding="utf-8"), re.MULTILINE)[1])


def unknowns_of(folder):
    """Number of unknowns that the log gives first."""
    log, = folder.glob("*.log")
    return int(re.search(r"Model: .* (\d+) unknowns", log.read_text(encoding="utf-8")).group(1))


def check_ranks(implam, folder, launcher):
    """A run on two or three ranks has the history of one, and so has a run restarted from it on other ranks."""
    for model in MODELS:
        # Three ranks on two cores mostly wait: they start the runs of few steps, and end the others.
        first, second = ("3", "2") if model in STARTED_BY_THREE else ("2", "3")
        end = ENDS_ON_RANKS.get(model) or end_of(deck_of(folder / model / "1", model))
        # A step ends at each checkpoint, so that all runs have the same ones.
        settings = [f"time%end={end!r}", f"output%checkpoint_every={0.8 * end!r}"]
        reference = run_deck(implam, deck_of(folder / model / "1", model, *settings))
        found = run_deck(implam, deck_of(folder / model / first, model, *settings), [*launcher, first])
        require_same(found, reference, f"{model} on {first} ranks")
        counts = {unknowns_of(path.parent) for path in (found, reference)}
        require(len(counts) == 1, f"{model}: the logs give {counts} unknowns.")
        for ranks in ("1", second):
            again = go_on(implam, copy_run(found.parent, folder / model / f"again_{ranks}"), [*launcher, ranks])
            require_same(again, reference, f"{model}: from {first} ranks to {ranks}")
        print(f"{model}: the same to the last bit on 1, {first} and {second} ranks", flush=True)


def check_signal(implam, folder, _):
    """Stopped by signals, repeatedly."""
    reference = run_deck(implam, deck_of(folder / "uninterrupted", "breaking"))
    deck = deck_of(folder / "stopped", "breaking")
    process = start(implam, deck, "--output", deck.parent)
    for runs, stop in enumerate((signal.SIGTERM, signal.SIGUSR1, signal.SIGINT), start=1):
        wait_until(lambda runs=runs: model_lines(deck.parent) >= runs, process)
        time.sleep(0.1)
        process.send_signal(stop)
        code = exit_code(process)
        require(code == EXIT_STOPPED, f"After {stop.name} the exit code is {code}, not {EXIT_STOPPED}.")
        print(f"{stop.name} after {len(read_history(history_of(deck.parent))['time'])} rows", flush=True)
        process = start(implam, "restart", checkpoint_of(deck.parent))
    require(exit_code(process) == EXIT_DONE, "The last restart failed.")
    require_same(history_of(deck.parent), reference, "signals")


def check_kill(implam, folder, _):
    """Killed at random moments until the end is reached, while plies fail and layers are added."""
    moments = random.Random(1)
    for model, every in (("breaking", 5e-6), ("layers", 8e-6), ("curved_skin", 85e-6)):
        settings = [f"output%checkpoint_every={every!r}"]
        reference = run_deck(implam, deck_of(folder / model / "uninterrupted", model, *settings))
        deck = deck_of(folder / model / "killed", model, *settings)
        process = start(implam, deck, "--output", deck.parent)
        for _ in range(5):
            before = stamp(deck.parent)
            wait_until(lambda before=before, deck=deck: stamp(deck.parent) != before, process)
            time.sleep(moments.uniform(0, 0.03))
            process.kill()
            process.wait()
            process = start(implam, "restart", checkpoint_of(deck.parent))
        require(exit_code(process) == EXIT_DONE, f"The last run ended with {process.returncode}.")
        require_same(history_of(deck.parent), reference, f"{model}: kills")
        print(f"{model}: 5 kills; the same to the last bit", flush=True)


def check_events(implam, folder, _):
    """Karas' elastic impact with output times near each other: steps of alternating lengths would excite the fastest
    modes up to 1e9 times the energy of the impact."""
    settings = [EXPLICIT, "time%end=200e-6", "time%mass_scaling=1"]
    outputs = {"none": [], "near": ["output%fields_every=0.17e-6", "output%history_every=0.23e-6"],
               "far": ["output%fields_every=2.3e-6", "output%history_every=1.7e-6"]}
    for name, output in outputs.items():
        history = read_history(run_deck(implam, write_deck(folder / name, "karas.nml", [*settings, *output])))
        error = max(map(abs, history["energy_error"]))/history["energy_impactor"][0]
        print(f"{name}: {history['step'][-1]:.0f} steps, the ledger is closed to {error:.1e}")
        require(error < 1e-4, f"{name}: the energy error is {error:.2g} of the impact energy.")
        require(abs(history["impactor_velocity"][-1]/-0.65693 - 1) < 2e-3, f"{name}: the rebound velocity differs.")


def check_travel(implam, folder, _):
    """An elastic plate under slow and under fast indentation."""
    push = ["impactor%travel=1e-3", "indentation%k=1e9"]
    elastic = "indented.nml", [*push, "case%kinematics='von_karman'"]
    static = write_deck(folder / "static", elastic[0], elastic[1])
    moved = write_deck(folder / "moved", elastic[0], [*elastic[1], EXPLICIT, "time%end=8e-3", "impactor%rise=4e-3"])
    fast = write_deck(folder / "fast", elastic[0], [*elastic[1], EXPLICIT, "time%end=0.2e-3", "time%settle=0.1e-3"])
    for deck, group in ((static, None), (moved, "&static"), (fast, "&static")):
        lines = [line for line in deck.read_text(encoding="utf-8").split("\n&")
                 if not line.startswith("delamination") and not (group and line.startswith(group[1:]))]
        text = "\n&".join(lines)
        deck.write_text(text.replace("dissipation=0.36", ""), encoding="utf-8")
    expected, found = (read_history(run_deck(implam, deck)) for deck in (static, moved))
    worst = max(abs(force - between(found, "impactor_displacement", place, "force"))
                for place, force in zip(expected["impactor_displacement"], expected["force"], strict=True)
                if place > 0.4e-3)/expected["force"][-1]
    kinetic = max(found["energy_kinetic"])/found["work_external"][-1]
    error = max(map(abs, found["energy_error"]))/found["work_external"][-1]
    print(f"The force differs by {worst:.2g} of the largest; of the work kinetic {kinetic:.1e}, ledger {error:.1e}")
    require(worst < 0.01, f"The force differs from that of load steps by {100*worst:.2g} %.")
    require(kinetic < 0.01 and error < 1e-4, "Kinetic energy or energy error is not small.")
    last = read_history(run_deck(implam, fast))["time"][-1]
    require(last < 0.21e-3, f"A travel of .2 ms ends after {last:.3g} s.")
    log = next(fast.parent.glob("*.log")).read_text(encoding="utf-8")
    require(re.search(r"warning.*kinetic", log, re.IGNORECASE), "There is no warning of a fast travel.")


def between(history, column, place, name):
    """Return a column at a value of another one, by linear interpolation between rows."""
    rows = list(zip(history[column], history[name], strict=True))
    for (before, first), (after, second) in pairwise(rows):
        if before <= place <= after and after > before:
            return first + (place - before)/(after - before)*(second - first)
    return rows[-1][1]


CANTILEVER = """&case name='cantilever' kinematics='linear' /
&plate length=0.1, 0.02 edges='clamped','free','free','free' in_plane='fixed' /
&mesh elements=20, 4 /
&material name='al' density=2700 E=70e9 nu=0.3 /
&laminate materials='al' angles=0 thicknesses=2e-3 /
"""


def check_lines(implam, folder, _):
    """A cantilever loaded at once, smoothly, and in load steps."""
    end, held = 4e-3, 1e-4
    groups = {"static": "&static steps=1 /", "cooled": f"&thermal delta_T=-100 /\n&time {EXPLICIT[5:]} end={end} /",
              **dict.fromkeys(("ramp", "smooth", "fixed"), f"&time {EXPLICIT[5:]} end={end} /")}
    found = {}
    for name, group in groups.items():
        deck = write_deck(folder / name, "karas.nml")
        rise = {"smooth": f"rise={0.5 * end}", "fixed": "history='fixed'"}.get(name, "")
        deck.write_text(f"{CANTILEVER}&line at=0.05 displacement={held} {rise} /\n{group}\n", encoding="utf-8")
        found[name] = read_history(run_deck(implam, deck))
        error = max(map(abs, found[name]["energy_error"]))/max(map(abs, found[name]["work_external"]))
        print(f"{name}: the ledger is closed to {error:.1e} of the work")
        require(error < 1e-6, f"{name}: the energy error is {error:.2g} of the work.")
        require(abs(found[name]["line_displacement_1"][-1]/held - 1) < 1e-9, f"{name}: the displacement differs.")
    for moment, place in zip(found["ramp"]["time"], found["ramp"]["line_displacement_1"], strict=True):
        require(abs(place - held*moment/end) < 1e-9*held, "The displacement of the line is not that of the ramp.")
    worst = max(abs(force/found["static"]["line_force_1"][-1] - 1) for force in found["fixed"]["line_force_1"])
    print(f"Prescribed from the start, the force differs by {worst:.2g} from that in load steps")
    require(worst < 1e-3, "The force of a fixed line is not that of load steps.")
    force = found["smooth"]["line_force_1"][-1]/found["static"]["line_force_1"][-1]
    print(f"With a smooth ramp the force is {force:.4f} of that in load steps")
    require(abs(force - 1) < 0.05, "The force is not that of load steps.")
    check_layer(implam, folder)


JOINED = """&case name='joined' /
&plate length=50e-3, 16e-3 edges='clamped','free','free','free' in_plane='fixed' /
&mesh elements=10, 4 /
&material name='m' density=1580 E1=171.42e9 E2=9.08e9 G12=5.29e9 G23=2.99e9 nu12=0.32 /
&laminate materials='m' angles=0, 90, 30 thicknesses=0.5e-3 /
&delamination below_ply=1 zone=30e-3, 16e-3 law='cohesive' G_c=500 strength_opening=60e6 strength_shear=60e6 /
"""


def check_layer(implam, folder):
    """A line that moves the lower of two joined layers by more than would separate them if the upper one stayed."""
    found = {}
    for name, history, group in (("layer_static", "ramp", "&static steps=1 /"),
                                 ("layer_fixed", "fixed", f"&time {EXPLICIT[5:]} end=2e-6 /")):
        deck = write_deck(folder / name, "karas.nml")
        line = f"&line at=10e-3 layer=2 component='u' displacement=3e-5 history='{history}' /"
        deck.write_text(f"{JOINED}{line}\n{group}\n", encoding="utf-8")
        found[name] = read_history(run_deck(implam, deck))
        require(found[name]["delaminated_area"][-1] == 0, f"{name}: the layers separate.")
    worst = max(abs(force/found["layer_static"]["line_force_1"][-1] - 1)
                for force in found["layer_fixed"]["line_force_1"])
    print(f"Prescribed at its lower layer from the start, the force differs by {worst:.2g} from that in load steps")
    require(worst < 2e-3, "The force of a line on a lower layer is not that of load steps.")


STEEP = """&case name='steep' /
&plate length=0.05, 0.05 edges='clamped' symmetry='quarter' /
&mesh elements=8, 8 grading=1 patch=3e-3 /
&material name='m' density=1600 E1=130e9 E2=7.7e9 G12=4.8e9 G23=3.8e9 nu12=0.30 /
&laminate materials='m' angles=0, 90, 90, 0 thicknesses=0.25e-3 /
&impactor mass=0.15 velocity=40 radius=6e-3 /
&indentation alpha_cr=80.3e-6 /
"""


def check_steep(implam, folder, _):
    """A plate that deflects by eight thicknesses: membrane forces and slopes act on w, whose inertia is not scaled."""
    for scaling in (1, 10):
        deck = write_deck(folder / str(scaling), "karas.nml")
        deck.write_text(f"{STEEP}&time {EXPLICIT[5:]} end=400e-6 mass_scaling={scaling} /\n", encoding="utf-8")
        history = read_history(run_deck(implam, deck))
        error = max(map(abs, history["energy_error"]))/history["energy_impactor"][0]
        print(f"Inertia scaled {scaling} times: {history['step'][-1]:.0f} steps, the ledger is closed to {error:.1e}")
        require(error < 1e-4, f"The energy error is {error:.2g} of the impact energy.")


def check_fracture(implam, folder, _):
    """The dissipated energy is G_c times the delaminated area where all modes have the same toughness."""
    deck = deck_of(folder / "deck", "breaking")
    history = read_history(run_deck(implam, deck))
    starter = history["delaminated_area"][0]
    recorded, area = history["energy_delamination"][-1], history["delaminated_area"][-1] - starter
    print(f"{recorded:.6g} J are recorded as fracture for {1e6*area:.3f} mm2")
    require(area > 5e-5 and abs(recorded/(490*area) - 1) < 1e-6, "The fracture energy is not G_c times the area.")


def check_dent(implam, folder, _):
    """Damped to rest after the impact, with permanent and with elastic shear strains."""
    depths = {}
    for name, settings in (("stays", []), ("goes", ["ply_damage%permanent_shear=.false."])):
        history = read_history(run_deck(implam, write_deck(folder / name, "../small/dent.nml", settings)))
        last = {column: values[-1] for column, values in history.items()}
        impact = history["energy_impactor"][0]
        depths[name] = last["dent_depth"] - last["dent_indentation"]
        print(f"{name}: dent {1e6*depths[name]:.2f} um and {1e6*last['dent_indentation']:.2f} um of the indentation, "
              f"energy {last['energy_permanent_shear']:.4g} J, kinetic {last['energy_kinetic']:.3g} J, "
              f"damped {last['energy_damping']:.4g} J, error {last['energy_error']:.3g} J of {impact:.3g} J",
              flush=True)
        require(last["force"] == 0 and last["impactor_velocity"] < 0, "The impactor has not rebounded.")
        require(last["energy_kinetic"] < 1e-6*impact, "The plate is not at rest.")
        require(last["energy_damping"] > 1e-4*impact, "Damping has dissipated nothing.")
        require(abs(last["energy_error"]) < 1e-3*impact, "The ledger is not closed.")
        require((last["energy_permanent_shear"] > 1e-3*impact) == (name == "stays"), f"{name}: wrong energy.")
    require(depths["stays"] > 5*abs(depths["goes"]), "Permanent strains cause no dent.")
    run_deck(implam, write_deck(folder / "vibrates", "../small/dent.nml", ["time%settle=0"]))
    for name, vibrates in (("stays", False), ("vibrates", True)):
        lines = [line for line in (folder / name / "dent.log").read_text(encoding="utf-8").splitlines()
                 if line.lstrip().startswith("dent  ")]
        require(len(lines) == 1 and lines[0].endswith("; with residual vibration") == vibrates, lines)


SOFTENED = """&case name='softened' /
&plate length=0.074, 0.085 edges='simple','simple','free','free' /
&mesh elements=16, 14 patch=3.2e-3 core=16e-3, 13e-3 cell=1.6e-3 /
&material name='m' density=1600 E1=130e9 E2=7.7e9 G12=4.8e9 G23=3.8e9 nu12=0.30 alpha1=-0.3e-6 alpha2=28e-6
  XT=2080e6 XC=1250e6 YT=20.34e6 YC=290e6 S12=76e6 G_ft=130e3 G_fc=60e3 G_mt=400 G_mc=1500 /
&laminate materials='m' angles=45, -45, -45, 45 thicknesses=0.4177e-3 /
&impactor mass=0.89 velocity=3.7 radius=11.5e-3 /
&indentation law='hertz' /
&ply_damage criteria='hashin' /
&thermal delta_T=-100 /
&delamination below_ply=1 G_c=268 law='cohesive' starter=6.5e-3 zone=16e-3, 13e-3 contact='none' /
&delamination below_ply=3 G_c=268 law='cohesive' starter=6.5e-3 zone=16e-3, 13e-3 contact='none' /
"""


YIELDED = """&case name='yielded' /
&plate length=60e-3, 40e-3 edges='clamped','clamped','simple','simple' /
&mesh elements=8, 8 patch=8e-3 /
&material name='m' density=1580 E1=171.42e9 E2=9.08e9 G12=5.29e9 G23=2.99e9 nu12=0.32 alpha1=-1e-6 alpha2=28e-6
  XT=600e6 XC=300e6 YT=1e9 YC=200e6 S12=70e6 G_ft=133e3 G_fc=47e3 G_mt=277 G_mc=788 shear_failure_strain=0.05 /
&laminate materials='m' angles=30, -60 thicknesses=0.4e-3 /
&impactor mass=0.1 velocity=0.02 radius=6e-3 /
&indentation law='hertz' /
&ply_damage criteria='hashin' permanent_shear=.true. /
&thermal delta_T=-200 /
"""


DELAMINATED = """&case name='delaminated' /
&plate length=60e-3, 40e-3 edges='free' /
&support clamps=0,-15e-3, 0,15e-3, 20e-3,0 /
&mesh elements=8, 8 patch=8e-3 /
&material name='m' density=1580 E1=171.42e9 E2=9.08e9 G12=5.29e9 G23=2.99e9 nu12=0.32 alpha1=-1e-6 alpha2=28e-6 /
&laminate materials='m' angles=0, 90 thicknesses=0.4e-3 /
&impactor mass=0.1 velocity=0.05 radius=6e-3 /
&indentation law='hertz' /
&delamination below_ply=1 zone=60e-3, 40e-3 law='cohesive' G_Ic=5 G_IIc=10 strength_opening=5e6 strength_shear=5e6 /
&thermal delta_T=-200 /
"""


def check_softened(implam, folder, _):
    """Residual stresses that crack the matrix before the impact, whose equilibrium takes more than a hundred iterations
    by the secant stiffness alone; stresses that cause permanent shear strains; stresses that delaminate free edges."""
    explicit, implicit = EXPLICIT[5:], "integrator='generalized_alpha' step=1e-6"
    for name, text, mode, steps in (("softened", SOFTENED, "matrix_cracking", explicit),
                                    ("yielded", YIELDED, "permanent_shear", explicit),
                                    ("delaminated", DELAMINATED, "delamination", explicit),
                                    ("delaminated_implicit", DELAMINATED, "delamination", implicit)):
        deck = write_deck(folder / name, "karas.nml")
        deck.write_text(f"{text}&time {steps} end=2e-6 /\n", encoding="utf-8")
        history = read_history(run_deck(implam, deck))
        spent = history[f"energy_{mode}"][0]
        print(f"{name}: {spent:.3g} J are dissipated before the impact")
        require(spent > 0, f"{name}: nothing is dissipated before the impact.")
        error = max(map(abs, history["energy_error"]))/history["energy_impactor"][0]
        print(f"{name}: the ledger is closed to {error:.1e} of the impact")
        require(error < 1e-4, f"{name}: the energy error is {error:.2g} of the impact energy.")
    deck = write_deck(folder / "foreseen", "karas.nml")
    for end, unknown in (("", True), ("end=1e-3", False)):
        deck.write_text(f"{DELAMINATED}&time {explicit} {end} /\n", encoding="utf-8")
        said = check_output([implam, "check", str(deck)], text=True)
        require(("damage may change the number of steps" in said) == unknown, f"The check says: {said}")


CLAMPED = """&case name='clamped' units='mm-t-s' /
&plate length=60, 40 edges='free' symmetry='point' /
&support window=50, 30 unilateral=.true. /
&support clamps=28,18, -28,18, 28,-18, -28,-18 clamp_force=1100 /
&mesh elements=14, 20 patch=4 core=24, 24 cell=2 /
&material name='cf' library='t700gc_m21' /
&laminate materials='cf' stacking='[45/0/-45/90]s' ply_thickness=0.25 /
&impactor mass=1e-3 velocity=10 radius=6 /
&delamination below_ply='between_angles' zone=60, 40 /
&time end=5e-6 /
"""


def check_clamps(implam, folder, _):
    """An impact of .05 mJ on a plate that four clamps press on its frame: nothing but the impact moves it."""
    deck = write_deck(folder / "clamped", "karas.nml")
    deck.write_text(CLAMPED, encoding="utf-8")
    found, energy = read_history(run_deck(implam, deck)), 0.05
    for column in ("energy_delamination", "energy_contact", "energy_algorithmic", "energy_error"):
        worst = max(map(abs, found[column]))/energy
        print(f"{column}: at most {worst:.1e} of the impact energy")
        require(worst < 1e-4, f"{column} is {worst:.2g} of the impact energy.")
    require(min(found["energy_strain"]) > -1e-9*energy, "Clamps in equilibrium have released energy.")


TRIALS = {"ranks": check_ranks, "signal": check_signal, "kill": check_kill, "events": check_events,
          "travel": check_travel, "lines": check_lines, "steep": check_steep, "fracture": check_fracture,
          "dent": check_dent, "clamps": check_clamps, "softened": check_softened}

if __name__ == "__main__":
    Path(sys.argv[3]).parent.mkdir(parents=True, exist_ok=True)
    raise SystemExit(main(TRIALS, *sys.argv[1:]))
