"""The summary of a run, compared with its history, closed forms and other runs.
Usage: summaries.py TRIAL IMPLAM FOLDER [LAUNCHER...]     (LAUNCHER takes the number of ranks as its last word)

figures  NAME_summary.json against history and log, with several interfaces and plies
contact  duration of contact and rebound of a sphere on a rigid base against Hertz
restart  a resumed run has the summary of the uninterrupted one: bitwise, with warnings and onsets
ranks    on 1 and 2 ranks: to 1e-9
endings  the summaries of stopped and failed runs report this, with the values reached
errors   large deflection with an accuracy: a coarser run estimates the errors, a finer one confirms them
static   the energy release rate under a static load is proportional to its square and is that of the compliance"""

import json
import math
import re
import sys
from pathlib import Path

from restart import start, wait_until
from solver_runs import (
    EXIT_CONVERGENCE,
    EXIT_STOPPED,
    change_deck,
    exit_code_of,
    history_of,
    read_history,
    require,
    run,
    run_deck,
    write_deck,
)

DAMAGE, COHESIVE = "../small/damage.nml", "../small/cohesive.nml"
# Two interfaces whose zones are filled by damage, so that onset, growth and warnings follow each other.
TWO = ["laminate%angles=0,90,90,0", "laminate%thicknesses=0.5e-3"]
SECOND = ("&delamination below_ply=1 G_Ic=280 G_IIc=900 law='cohesive' zone=33e-3,19e-3 strength_opening=27e6 "
          "strength_shear=40e6 /\n")
PROCESS = ("wall_seconds", "started", "ranks")


def summary_of(folder):
    """Return the only summary in a folder."""
    path, = folder.glob("*_summary.json")
    return json.loads(path.read_text(encoding="utf-8"))


def flat(value, name=""):
    """Return the members of a summary by their paths, without those of a process."""
    if isinstance(value, dict):
        items = value.items()
    elif isinstance(value, list):
        items = enumerate(value)
    else:
        return {name: value}
    found = {}
    for key, inner in items:
        if key not in PROCESS:
            found |= flat(inner, f"{name}/{key}")
    return found


def require_equal(summary, reference, what, tolerance=0.0):
    """Fail unless two summaries agree, numbers to a tolerance relative to themselves."""
    ours, theirs = flat(summary), flat(reference)
    require(ours.keys() == theirs.keys(), f"{what}: the members differ: {sorted(ours.keys() ^ theirs.keys())}")
    for name, value in theirs.items():
        same = ours[name] == value
        if not same and tolerance and isinstance(value, float) and isinstance(ours[name], float):
            same = math.isclose(ours[name], value, rel_tol=tolerance, abs_tol=1e-12)
        require(same, f"{what}: {name} is {ours[name]}, not {value}.")


def close(value, expected, tolerance, what):
    """Fail unless a figure has the expected value, to a relative tolerance."""
    require(math.isclose(value, expected, rel_tol=tolerance, abs_tol=1e-300), f"{what} is {value}, not {expected}.")


def check_interface(entry, history, has_force):
    """Compare the figures of an interface with its columns."""
    ply = entry["ply_above"]
    column = {name: history[f"{name}_below_{ply}"] for name in ("stage", "area", "energy", "extent_x", "extent_y")}
    for name, stage in (("onset", 1), ("first_growth", 2)):
        rows = [row for row, reached in enumerate(column["stage"]) if reached >= stage]
        require((entry[name] is None) == (not rows), f"{name} is {entry[name]}, not in the rows {rows}.")
        if rows:
            require(entry[name]["at"] == history["time"][rows[0]], f"{name} is given for {entry[name]['at']}.")
            if has_force:
                require(entry[name]["force"] == history["force"][rows[0]], f"{name}: another force.")
    for name in ("area", "energy"):
        close(entry[name], column[name][-1], 1e-14, f"{name} below ply {ply}")
    for name, axis in (("extent_x", "x"), ("extent_y", "y")):
        close(entry[axis][1] - entry[axis][0], column[name][-1], 1e-14, name)


def check_against_history(folder):
    """Compare a summary of an impact with its history, and the log with the summary."""
    summary, history = summary_of(folder), read_history(history_of(folder))
    peak = max(history["force"])
    require(summary["peak_force"] == peak, f"The peak force is {summary['peak_force']}, not {peak}.")
    require(summary["peak_force_at"] == history["time"][history["force"].index(peak)], "The peak is at another time.")
    require(summary["largest_deflection"] == max(history["deflection"]), "The largest deflection differs.")
    for name in (*(name for name in history if name.startswith("energy_") and name in summary), "work_external",
                 "impactor_velocity", "projected_area", "delaminated_area"):
        close(summary[name], history[name][-1], 1e-13, name)
    kept = summary["energy_impact"] - summary["energy_impactor"]
    if summary["in_contact"]:
        require(summary["energy_absorbed"] is None, "Energy is absorbed before contact has ended.")
    else:
        close(summary["energy_absorbed"], kept, 1e-12, "The absorbed energy")
    for entry in summary["interfaces"]:
        check_interface(entry, history, True)
    close(sum(entry["area"] for entry in summary["interfaces"]), summary["delaminated_area"], 1e-13, "The area")
    close(sum(entry["energy"] for entry in summary["interfaces"]), summary["energy_delamination"], 1e-9, "The energy")
    log = next(folder.glob("*.log")).read_text(encoding="utf-8")
    rounded = float(f"{peak:.3e}")
    printed = re.findall(r"^  peak force +(\S+)(?: \([^)]*\))? at time (\S+)", log, re.MULTILINE)
    require(len(printed) == 1 and float(printed[0][0]) == rounded, f"The log has {printed}, not {rounded}.")
    require(float(printed[0][1]) == float(f"{summary['peak_force_at']:.3e}"), f"The log has {printed}.")
    for warning in summary["warnings"]:
        require(log.count(warning["text"]) >= 1, f"The log's end lacks: {warning['text']}")
    print(f"{folder.name}: {summary['peak_force']:.4g}, {[entry['first_growth'] for entry in summary['interfaces']]}")
    return summary


def check_times(folder):
    """Times of the history are the shortest texts of round numbers, in columns of one width."""
    lines = history_of(folder).read_text(encoding="utf-8").splitlines()
    require(len({len(line) for line in lines[1:]}) == 1, "The rows have different lengths.")
    texts = [line.split(",")[0].strip() for line in lines[1:]]
    require(all(len(text) <= 10 for text in texts), f"Times are {texts}.")
    require("0.00017" in texts and "3e-5" in texts, f"Times are {texts}.")


def two_interfaces(folder):
    """Return a deck with two cohesive interfaces."""
    deck = write_deck(folder, COHESIVE, TWO)
    text = deck.read_text(encoding="utf-8")
    deck.write_text(text.replace("&delamination", f"{SECOND}&delamination", 1), encoding="utf-8")
    return deck


def check_figures(implam, folder, _):
    """Fronts with failing plies, one and two cohesive interfaces."""
    deck = write_deck(folder / "damage", DAMAGE, ["time%end=300e-6", "ply_damage%d=1", "output%fields_every=30e-6"])
    run_deck(implam, deck)
    check_times(deck.parent)
    summary = check_against_history(deck.parent)
    history = read_history(history_of(deck.parent))
    # Closed-form threshold force of the cross-ply; its reduced stiffnesses are those of the deck.
    e1, e2, g, nu = 139e9, 9.4e9, 4.5e9, 0.309
    q11, q22 = e1 / (1 - nu**2 * e2 / e1), e2 / (1 - nu**2 * e2 / e1)
    ply = 0.6666667e-3
    whole, core = (3 * ply)**3 / 12, ply**3 / 12
    d11, d22 = q11 * (whole - core) + q22 * core, q22 * (whole - core) + q11 * core
    d12, d66 = nu * q22 * whole, g * whole
    bending = math.sqrt(math.sqrt(d11 * d22) * (math.sqrt(d11 * d22) + d12 + 2 * d66) / 2)
    toughness = 400
    close(summary["interfaces"][0]["threshold_force"], math.pi * math.sqrt(32 * bending * toughness / 3), 1e-9,
          "The threshold force")
    for mode in ("fibre_failures", "matrix_cracks", "matrix_crushings"):
        require(summary[mode] == history[mode][-1], f"{mode} are {summary[mode]}.")
    cracked = sum(ply["matrix_crack_area"] for ply in summary["plies"])
    require(summary["matrix_cracks"] > 0 and 0 < cracked < 3 * 0.04**2, f"Cracked area {cracked}.")
    run_deck(implam, write_deck(folder / "cohesive", COHESIVE))
    one = check_against_history(folder / "cohesive")
    require("threshold_force_at_starter" not in one, "There is no starter.")
    require(any("process zone" in warning["text"] for warning in one["warnings"]), "The process zone is not reported.")
    require(any("below ply 2 has reached" in warning["text"] for warning in one["warnings"]), "The border is missing.")
    run_deck(implam, two_interfaces(folder / "two"))
    two = check_against_history(folder / "two")
    ratio = two["interfaces"][0]["threshold_force"] / two["interfaces"][1]["threshold_force"]
    close(ratio, math.sqrt(900 / 400), 1e-12, "The ratio of the threshold forces")
    require(0 < two["projected_area"] <= two["delaminated_area"], "The projected area is out of range.")
    for single in (summary, one):
        require(single["in_contact"] and single["delaminated_area"] > 0, "The deck is not the expected one.")
        close(single["projected_area"], single["delaminated_area"], 1e-12, "The area projected of one interface")


def check_contact(implam, folder, _):
    """A ball on a rigid base: Hertz gives the duration 2.9433 alpha/v = 69.829 us; with steps of .25 us."""
    deck = write_deck(folder, "rigid_base.nml")
    run_deck(implam, deck)
    summary = summary_of(folder)
    require(summary["contacts"] == 1 and not summary["in_contact"], "One contact was expected.")
    close(summary["contact_duration"], 69.829e-6, 0.125 / 69.829, "The duration of contact")
    close(summary["contact_until"], 69.829e-6, 0.125 / 69.829, "The end of contact")
    close(summary["rebound_velocity"], 1, 1e-6, "The rebound")
    close(summary["peak_force"], 1728.713, 2e-5, "The peak force")
    print(summary["contact_duration"])
    # A ball released at the plate has no energy; residual stress does not count as impact energy.
    deck = write_deck(folder / "released", "sun_chen_elastic.nml", [
        "impactor%velocity=0", "impactor%gravity=9.81", "time%end=50e-6", "material%alpha1=0", "material%alpha2=28e-6",
        "thermal%delta_T=-50"])
    run_deck(implam, deck)
    require(summary_of(deck.parent)["energy_impact"] == 0, "The impact energy is not zero.")
    log, = deck.parent.glob("*.log")
    require("nfinity" not in log.read_text(encoding="utf-8"), "A ratio to zero energy is printed.")


def check_restart(implam, folder, _):
    """From a checkpoint before onset, and from one after growth and warnings."""
    for name, end in (("before", 150e-6), ("after", 240e-6)):
        deck = two_interfaces(folder / name)
        text = deck.read_text(encoding="utf-8")
        deck.write_text(f"{text}&output checkpoint_every={end - 5e-6!r} /\n", encoding="utf-8")
        run_deck(implam, deck)
        reference = summary_of(deck.parent)
        run([implam, "restart", deck.parent])
        require_equal(summary_of(deck.parent), reference, name)


def check_ranks(implam, folder, launcher):
    """Two ranks."""
    deck = two_interfaces(folder)
    deck.write_text(deck.read_text(encoding="utf-8") + "&solver tolerance=1e-9 /\n", encoding="utf-8")
    run_deck(implam, deck)
    reference = summary_of(folder)
    run_deck(implam, deck, [*launcher, "2"])
    ours = summary_of(folder)
    for summary in (ours, reference):
        for name in ("costs", "energy_error", "energy_contact"):
            del summary[name]
    require_equal(ours, reference, "ranks", 1e-6)


OVERLOAD = """&case name='overload' kinematics='von_karman' /
&plate length=0.1, 0.1 edges='clamped' symmetry='quarter' /
&mesh elements=4, 4 /
&material name='ply' E1=139e9 E2=9.4e9 G12=4.5e9 G13=4.5e9 G23=2.98e9 nu12=0.309
  XT=1500e6 YT=40e6 YC=150e6 S12=70e6 Sf=70e6 Sm23=70e6 /
&laminate materials='ply' angles=0, 90, 0 thicknesses=1e-3 /
&ply_damage d=100 e=1e-6 /
&pressure value=20e6 /
&static steps=10 /
&solver max_iterations=4 /
"""


def check_overload(implam, folder):
    """Failed plies cannot carry the load: the run ends at .3 of it with a sentence. There 2 % of the energy are
    algorithmic, little beside the energy at the full load, which is not reached; the warning is given at the end."""
    folder.mkdir(parents=True, exist_ok=True)
    deck = folder / "overload.nml"
    deck.write_text(OVERLOAD, encoding="utf-8")
    run([implam, deck, "--output", folder], EXIT_CONVERGENCE)
    summary = summary_of(folder)
    require(summary["exit"]["message"] == "No equilibrium at 0.3 of the load: the plate with its failed plies cannot "
            "carry it.", summary["exit"])
    share, reached = summary["energy_algorithmic"]/summary["work_external"], summary["load_factor_reached"]
    require(share > 0.01 and abs(reached - 0.3) < 1e-9, f"{share:.3f} of the energy is algorithmic at {reached}.")
    texts = [warning["text"] for warning in summary["warnings"]]
    require(any(text.startswith("Load steps have dissipated more than 1 % of the energy") for text in texts), texts)


def check_endings(implam, folder, _):
    """A run stopped before the end of its first step; a run without equilibrium."""
    deck = write_deck(folder / "stopped", DAMAGE)
    run([implam, deck, "--output", deck.parent, "--wall-limit", "1e-3"], EXIT_STOPPED)
    summary = summary_of(deck.parent)
    require(summary["exit"]["kind"] == "stopped" and summary["exit"]["code"] == EXIT_STOPPED, summary["exit"])
    require(0 < summary["time_reached"] < 240e-6, f"It reached {summary['time_reached']}.")
    run([implam, "restart", deck.parent])
    summary = summary_of(deck.parent)
    require(summary["exit"] == {"kind": "done", "code": 0, "message": ""}, summary["exit"])
    reference = write_deck(folder / "whole", DAMAGE)
    run_deck(implam, reference)
    require_equal(summary, summary_of(reference.parent), "stopped")
    deck = write_deck(folder / "failed", "large_deflection.nml", ["pressure%value=1e15", "solver%max_iterations=3"])
    run([implam, deck, "--output", deck.parent], EXIT_CONVERGENCE)
    summary = summary_of(deck.parent)
    require(summary["exit"]["kind"] == "failed" and "No equilibrium" in summary["exit"]["message"], summary["exit"])
    check_overload(implam, folder / "overload")
    killed = write_deck(folder / "killed", DAMAGE)
    run_deck(implam, killed)
    killed.write_text(change_deck(killed.read_text(encoding="utf-8"), ["time%end=1"]), encoding="utf-8")
    process = start(implam, killed, "--output", killed.parent)
    wait_until(lambda: not list(killed.parent.glob("*_summary.json")), process)
    process.kill()
    process.wait()
    require(not list(killed.parent.glob("*_summary.json")), "A killed run leaves the summary of an earlier run.")


def check_errors(implam, folder, _):
    """Sun and Chen's plate struck by 100 g at 10 m/s: errors from the elastic impact, from a coarse run, or none."""
    fast = ["case%kinematics='von_karman'", "impactor%velocity=10", "impactor%mass=0.1", "mesh%elements=6,6",
            "time%step=8e-6", "time%end=1500e-6", "case%accuracy='draft'"]
    found = {}
    for name, settings in (("fast", fast), ("finer", [*fast, "case%refine=2", "case%error_estimate=.false."]),
                           ("unknown", fast[:-1]), ("slow", ["case%accuracy='draft'"])):
        deck = write_deck(folder / name, "../sun_chen.nml", settings)
        run_deck(implam, deck)
        found[name] = summary_of(deck.parent)
        log = next(deck.parent.glob("*.log")).read_text(encoding="utf-8")
        require(("errors              not known" in log) == (name in ("finer", "unknown")), f"{name}: wrong log.")
    sources = {name: summary["estimated_errors"]["source"] for name, summary in found.items()}
    require(sources == {"fast": "coarse_run", "finer": "none", "unknown": "none", "slow": "elastic"}, f"{sources}")
    for figure in ("peak_force", "peak_force_at", "contact_duration", "largest_deflection", "impactor_velocity"):
        off = abs(found["fast"][figure] - found["finer"][figure])
        estimate = found["fast"]["estimated_errors"][figure]
        print(f"{figure}: error {off:.3g}, estimate {estimate:.3g} of {found['finer'][figure]:.4g}")
        require(off <= 2 * estimate, f"The error of {figure} is {off}, the estimate {estimate}.")
    check_coarse_run(implam, folder)
    check_coarse_core(implam, folder)


# A plate with a core of equal cells, whose full mesh has an odd number of elements per half.
CORED = """&case name='cored' error_estimate=.true. kinematics='linear' /
&plate length=0.1,0.1 edges='clamped' symmetry='{}' /
&mesh elements={} core=24e-3,24e-3 cell=4e-3 patch=4e-3 /
&material name='ply' density=1580 E1=139e9 E2=9.4e9 G12=4.5e9 G23=2.98e9 nu12=0.309 /
&laminate materials='ply' stacking='[0_4/90_4]s' ply_thickness=0.125e-3 /
&impactor mass=1.0 energy=1 radius=8e-3 /
&indentation law='tan_sun' alpha_cr=80.3e-6 /
&time end=2e-3 step=20e-6 /
"""


def check_coarse_core(implam, folder):
    """The coarse run of a full plate gives the errors of that of its quarter, which has the same mesh."""
    estimates = []
    for part, elements in (("none", "10,10"), ("quarter", "5,5")):
        deck = folder / f"cored_{part}" / "cored.nml"
        deck.parent.mkdir(parents=True, exist_ok=True)
        deck.write_text(CORED.format(part, elements), encoding="utf-8")
        run_deck(implam, deck)
        estimates.append(summary_of(deck.parent)["estimated_errors"])
    print(f"errors of the full plate and of its quarter: {estimates}")
    require(estimates[0]["source"] == "coarse_run", "There was no coarse run.")
    for figure in ("peak_force", "largest_deflection", "impactor_velocity"):
        close(estimates[0][figure], estimates[1][figure], 1e-6, f"The error of {figure}")


def check_coarse_run(implam, folder):
    """The coarse run is that of the coarser deck, also with a spherical contact area."""
    blunt = ["plate%length=0.1,0.1", "mesh%patch=4e-3", "impactor%radius=2", "impactor%contact_area='sphere'",
             "impactor%mass=0.1", "time%end=100e-6"]
    fine = ["mesh%elements=16,16", "time%step=2e-6", "case%error_estimate=.true."]
    coarse = ["mesh%elements=8,8", "time%step=4e-6", "case%error_estimate=.false."]
    found = []
    for name, settings in (("blunt", fine), ("blunt_coarse", coarse)):
        deck = write_deck(folder / name, "../sun_chen.nml", [*blunt, *settings])
        run_deck(implam, deck)
        found.append(summary_of(deck.parent))
    third = abs(found[0]["impactor_velocity"] - found[1]["impactor_velocity"]) / 3
    estimate = found[0]["estimated_errors"]["impactor_velocity"]
    print(f"estimate {estimate:.6g}, a third of the difference {third:.6g}")
    require(abs(estimate - third) <= 1e-3 * third, "The coarse run is not that of the coarser deck.")


def static_run(implam, folder, starter):
    """Return the history and the summary of four load steps on a plate whose lower faces separate freely."""
    deck = write_deck(folder, "../small/static_damage.nml", [
        "mesh%elements=12,12", "delamination%below_ply=1", "delamination%G_c=400", "delamination%contact='none'",
        "delamination%zone=60e-3,60e-3", f"delamination%starter={starter}", "static%steps=4"])
    text = "".join(line for line in deck.read_text(encoding="utf-8").splitlines(keepends=True)
                   if not line.startswith("&ply_damage"))
    deck.write_text(text, encoding="utf-8")
    run_deck(implam, deck)
    return read_history(history_of(folder)), summary_of(folder)


def check_static(implam, folder, _):
    """The largest rate on the front of a square is above the mean rate, which follows from the change of compliance."""
    history, summary = static_run(implam, folder / "small", 30e-3)
    ratio = history["release_ratio"]
    require(ratio[-1] > 0, "The release rate is 0.")
    for row, load in enumerate(history["time"]):
        close(ratio[row], ratio[-1] * load**2, 1e-6, f"The ratio at load {load}")
    wider, _ = static_run(implam, folder / "large", 38e-3)
    growth = wider["delaminated_area"][-1] - history["delaminated_area"][-1]
    require(growth > 0, "The larger starter is not larger.")
    # Under a given load twice the energy release is the increase of the work of the load.
    mean = (wider["energy_strain"][-1] - history["energy_strain"][-1]) / growth / 400
    print(f"largest {ratio[-1]:.4g}, mean {mean:.4g}")
    require(0.2 * ratio[-1] < mean < ratio[-1], f"The mean ratio is {mean}, the largest {ratio[-1]}.")
    require(summary["interfaces"][0]["first_growth"] is None and "peak_force" not in summary, "Growth is reported.")
    deck = write_deck(folder / "pressed", "framed_panel.nml", ["mesh%elements=6, 6", "static%steps=1",
                                                               "case%kinematics='linear'"])
    run_deck(implam, deck)
    log, = (path.read_text(encoding="utf-8") for path in deck.parent.glob("*.log"))
    strength, = re.findall("^  residual strength .*", log, re.MULTILINE)
    require(", load factor 1," in strength and "1 step (" in log and ", 1 rank," in log, f"The log has {strength}")


TRIALS = {"figures": check_figures, "contact": check_contact, "restart": check_restart, "ranks": check_ranks,
          "endings": check_endings, "errors": check_errors, "static": check_static}

if __name__ == "__main__":
    trial, implam, folder, *launcher = sys.argv[1:]
    raise SystemExit(exit_code_of(TRIALS[trial], implam, Path(folder), launcher))
