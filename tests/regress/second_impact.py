"""Further impacts on a struck panel.
Usage: second_impact.py TRIAL IMPLAM FOLDER [LAUNCHER...]     (LAUNCHER takes the number of ranks as its last word)

elastic  an undamaged panel at rest responds to a second impact as the first
kept     on the mesh of the first run the state before the contact is that of its end, bitwise
dent     at the same place the contact begins in the dent of the first run, elsewhere and with another law without one
beside   at another place, on other mesh lines: damage is kept while the panel comes to rest and grows from there; from
         a checkpoint within the run: bitwise
covered  an impact beside an edge, then a compression on another mesh: its layers cover all of the damage
ranks    the same on three ranks: bitwise
ten      ten impacts at three places: areas never shrink, the ledgers close"""

import filecmp
import json
import shutil
import sys
from pathlib import Path

import h5py
import numpy as np
from compression import CHECKPOINT, COMPRESSION, IMPACT, deck_of, strike
from solver_runs import EXIT_STOPPED, change_deck, read_history, require, run

SECOND = "second_impact"
REST_TIME = 0.27e-3
# Relative. Measured: 1.4e-5, 8.7e-4 (a step is 8e-4 of the contact), 8.5e-6, 4.3e-4.
REPEATED = {"peak_force": 5e-5, "contact_duration": 2e-3, "rebound_velocity": 5e-5, "energy_absorbed": 1e-3}
# Of the largest energy. Measured: 8e-5 beside the first impact, 5e-5 in ten impacts.
CLOSED = 2e-4
ENERGIES = ("impactor", "kinetic", "strain", "indentation", "delamination", "ply_damage", "contact", "friction",
            "algorithmic", "layers", "damping")
# The run stops at a row of the history: after one step.
EVERY_STEP = "output%history_every=0"
ELASTIC = "ply_damage", "delamination"
YIELDING = ["indentation%law='tan_sun'", "indentation%k=1e9", "indentation%alpha_cr=1e-6"]


def strike_again(implam, folder, settings=(), launcher=()):
    """Strike the panel again; return the path of the history."""
    run([*launcher, implam, deck_of(folder, SECOND, settings)], folder=folder)
    return folder / f"{SECOND}_history.csv"


def summary_of(folder, name):
    """Return the summary of a run."""
    return json.loads((folder / f"{name}_summary.json").read_text(encoding="utf-8"))


def elastic_deck(folder, name, settings):
    """Write the deck of the second impact without damage; return its name."""
    text = (folder / deck_of(folder, SECOND)).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith(tuple(f"&{group}" for group in ELASTIC))]
    text = change_deck("\n".join(lines) + "\n", [f"case%name='{name}'", *settings])
    if name == "first":
        text = "\n".join(line for line in text.splitlines() if not line.startswith("&initial_state")) + "\n"
    (folder / f"{name}.nml").write_text(text, encoding="utf-8")
    return f"{name}.nml"


def check_elastic(implam, folder, _):
    """The same impact twice, the second on a plate that has come to rest."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run([implam, elastic_deck(folder, "first", ["time%settle=0", "time%end=0.5e-3"])], folder=folder)
    again = ["initial_state%from='first_restart.h5'", "time%settle=0.5e-3", "time%end=1e-3"]
    run([implam, elastic_deck(folder, "again", again)], folder=folder)
    first, second = summary_of(folder, "first"), summary_of(folder, "again")
    for name, tolerance in REPEATED.items():
        difference = second[name] / first[name] - 1
        print(f"{name} {first[name]:.6g}, again {second[name]:.6g}: {difference:.1e}")
        require(abs(difference) < tolerance, f"{name} of an undamaged panel differs.")
    require(abs(second["peak_force_at"] - first["peak_force_at"] - 0.5e-3) < 1e-6, "The impact begins before rest.")


def check_kept(implam, folder, _):
    """One step after the end of the first run, before the impactor presses."""
    strike(implam, folder)
    settings = ["plate%symmetry='point'", "mesh%elements=10, 16", "impactor%at=0, 0", "time%settle=0", EVERY_STEP]
    deck = deck_of(folder, SECOND, settings)
    run([implam, deck, "--wall-limit", "1e-3"], EXIT_STOPPED, folder)
    with h5py.File(folder / CHECKPOINT) as end, h5py.File(folder / f"{SECOND}_restart.h5") as start:
        for name in ("cohesive/law", "cohesive/points", "ply_failure/stiffness", "ply_failure/crack_bands"):
            require(np.array_equal(end[f"state/{name}"], start[f"state/{name}"]), f"{name} differs.")
        before, after = (np.asarray(file["state/motion/displacement"]) for file in (end, start))
        step = np.asarray(start["state/explicit/step"]) * np.asarray(start["state/motion/velocity"])
    # The first step starts from rest: its displacement is that of the end and the step's own.
    require(np.abs(after - step - before).max() <= 1e-15 * np.abs(before).max(), "The displacements differ.")
    for place in summary_of(folder, IMPACT)["interfaces"]:
        require(place["area"] > 0, "The first impact has left no delamination.")
    kept = summary_of(folder, SECOND)
    require(kept["delaminated_area_before"] == summary_of(folder, IMPACT)["delaminated_area"], "The area differs.")


def check_dent(implam, folder, _):
    """Contact on the dent begins at once, and its law is that of reloading."""
    shutil.rmtree(folder, ignore_errors=True)
    run([implam, deck_of(folder, IMPACT, [*YIELDING, "time%end=0.8e-3"])], folder=folder)
    dent = summary_of(folder, IMPACT)["dent_indentation"]
    require(dent > 0, "The first impact has left no dent.")
    half = ["plate%symmetry='point'", "mesh%elements=10, 16", "impactor%at=0, 0", "impactor%velocity=2", *YIELDING]
    rows = read_history(strike_again(implam, folder, half))
    log = (folder / f"{SECOND}.log").read_text(encoding="utf-8")
    require("strikes the dent of that run" in log, "The log does not mention the dent.")
    start = max(i for i, time in enumerate(rows["time"]) if time <= REST_TIME)
    at_rest, then = rows["indentation"][start:start + 2]
    print(f"dent {dent:.3g}, indentation at rest {at_rest:.3g}, then {then:.3g}")
    require(all(abs(value - dent) < 1e-12 * dent for value in rows["indentation"][:start + 1]), "Not in the dent.")
    require(then > dent and rows["force"][start + 1] > 0, "The contact does not begin then.")
    # A weak impact does not reach the largest indentation of the first one: the dent stays as it is.
    require(summary_of(folder, SECOND)["dent_indentation"] == dent, "An elastic impact changes the dent.")
    for settings in ([*half[:2], "impactor%at=0, 0", "impactor%velocity=2"], YIELDING):
        deck = deck_of(folder, SECOND, [*settings, EVERY_STEP])
        run([implam, deck, "--wall-limit", "1e-3"], EXIT_STOPPED, folder)
        rows = read_history(folder / f"{SECOND}_history.csv")
        require(rows["indentation"][0] == 0, "The face has a dent where it was not struck, or by another law.")


def largest_energy(rows):
    """Return the largest sum of all energies of a history."""
    return max(sum(rows[f"energy_{name}"][i] for name in ENERGIES) for i in range(len(rows["time"])))


def check_beside(implam, folder, launcher):
    """Damage is mapped to lines of its own, held until the panel is at rest, and grows by the impact."""
    strike(implam, folder)
    path = strike_again(implam, folder, ["output%checkpoint_every=0.5e-3", "output%checkpoint_at_end=.false."])
    rows, reference = read_history(path), folder / "reference.csv"
    first, second = summary_of(folder, IMPACT), summary_of(folder, SECOND)
    start = max(i for i, time in enumerate(rows["time"]) if time <= REST_TIME)
    area = first["delaminated_area"]
    require(abs(second["delaminated_area_before"] / area - 1) < 1e-12, "The area before the impact is another one.")
    require(all(abs(value / area - 1) < 1e-12 for value in rows["delaminated_area"][:start + 1]),
            "The area changes before the impact.")
    require(not any(rows["force"][:start + 1]) and rows["force"][start + 3] > 0, "The impact begins before rest.")
    error = max(map(abs, rows["energy_error"])) / largest_energy(rows)
    print(f"area {1e6 * area:.0f}, then {1e6 * second['delaminated_area']:.0f} mm2; energy error {error:.1e}")
    require(second["delaminated_area"] > 1.1 * area, "The second impact does not delaminate.")
    require(error < CLOSED, "The ledger does not close.")
    shutil.copy(path, reference)
    if launcher:
        other = strike_again(implam, folder, launcher=[*launcher, "3"])
    else:
        run([implam, "restart", f"{SECOND}_restart.h5"], folder=folder)
        other = path
    require(filecmp.cmp(other, reference, shallow=False), "The history differs from the first one.")


def check_covered(implam, folder, _):
    """Layers beside an edge of the plate, about another centre, cover the damage when the panel is compressed."""
    strike(implam, folder)
    strike_again(implam, folder, ["impactor%at=-14e-3, 6e-3"])
    settings = [f"initial_state%from='{SECOND}_restart.h5'", "plate%symmetry='none'", "mesh%elements=20, 16",
                "time%settle=0.01e-3", "line%rise=0.02e-3", "time%end=0.05e-3"]
    run([implam, deck_of(folder, COMPRESSION, settings)], folder=folder)
    mapping = summary_of(folder, COMPRESSION)["mapping"]
    kept = [place["area_after"] / place["area_before"] for place in mapping["interfaces"]]
    print("areas after over before mapping: " + ", ".join(f"{share:.4f}" for share in kept))
    require(min(kept) > 0.99, "The mapping has lost delaminated area.")


def check_ten(implam, folder, _):
    """Each run begins with the end of the one before."""
    strike(implam, folder)
    areas = [summary_of(folder, IMPACT)["delaminated_area"]]
    begun, worst = CHECKPOINT, 0.0
    for number in range(2, 11):
        at = ("15e-3, 5e-3", "-12e-3, 0", "0, 0")[number % 3]
        name = f"impact{number}"
        settings = [f"case%name='{name}'", f"initial_state%from='{begun}'", f"impactor%at={at}",
                    f"impactor%velocity={2 + 0.5 * number}"]
        text = (folder / deck_of(folder, SECOND, settings)).read_text(encoding="utf-8")
        (folder / f"{name}.nml").write_text(text, encoding="utf-8")
        run([implam, f"{name}.nml"], folder=folder)
        rows, summary = read_history(folder / f"{name}_history.csv"), summary_of(folder, name)
        grown = np.diff([areas[-1], *rows["delaminated_area"]])
        require(grown.min() >= -1e-12 * areas[-1], f"The area shrinks in impact {number}.")
        worst = max(worst, max(map(abs, rows["energy_error"])) / largest_energy(rows))
        areas.append(summary["delaminated_area"])
        begun = f"{name}_restart.h5"
    print("areas " + ", ".join(f"{1e6 * area:.0f}" for area in areas) + f" mm2; energy error {worst:.1e}")
    require(areas[-1] > 1.2 * areas[0], "Nine impacts do not delaminate.")
    require(worst < CLOSED, "The ledger does not close.")


def main(trial, implam, folder, launcher):
    """Run one trial."""
    trials = {"elastic": check_elastic, "kept": check_kept, "dent": check_dent, "beside": check_beside,
              "covered": check_covered, "ranks": check_beside, "ten": check_ten}
    trials[trial](implam, Path(folder).resolve(), launcher)


if __name__ == "__main__":
    main(sys.argv[1], str(Path(sys.argv[2]).resolve()), sys.argv[3], sys.argv[4:])
