"""Restarts of runs with growing delaminations and failing plies give the uninterrupted history.
Usage: restart_growth.py TRIAL IMPLAM FOLDER [LAUNCHER...]     (LAUNCHER takes the number of ranks as its last word)

every    a run with released ties and contact restarted after each step, and continued to its end after some of them:
         bitwise
splits   just before and just after a step with the most growth, by each rule of growth and of energy release: bitwise
moments  SIGTERM and SIGKILL while a step with several releases is being computed: bitwise, the same cells delaminated
ranks    from 2 ranks to 1, from 1 to 2: to 1e-9
rejected from checkpoints next to rejected steps, while delaminations grow: bitwise
cohesive the same with a cohesive interface: bitwise
layers   the same with adaptive layers: bitwise
softening the same with plies that soften: bitwise
nose     the same with `contact_area='sphere'`: bitwise
explicit at the checks of a run by central differences, with a low-pass filter of the force: bitwise"""

import signal
import sys
import time
from itertools import pairwise

from released_cells import damage_of, min_releases, released_cells
from restart import (
    SINGLE_STEP,
    check_next_to_rejections,
    copy_run,
    exit_code,
    go_on,
    main,
    require_close,
    require_same,
    run_split,
    start,
    wait_until,
)
from solver_runs import (
    EXIT_STOPPED,
    TrialError,
    checkpoint_of,
    history_of,
    read_history,
    require,
    run,
    run_deck,
    write_deck,
)

DECK = "../small/damage.nml"
STEP = 10e-6
# A run restarted after each step has to be the uninterrupted one; from some of its checkpoints it is continued to the
# end, as state of several steps is lost in it.
CONTINUED = 4
GROWING = ["mesh%elements=10,10", "impactor%velocity=3", "delamination%G_c=200", "delamination%zone=28.3e-3,20.6e-3",
           "delamination%starter=8.9e-3"]
# Up to the first cracks, with residual stress from curing.
SOFTENING = ["time%end=120e-6", "thermal%delta_T=-150", "material%alpha1=-0.3e-6", "material%alpha2=28e-6"]
NOSE = ["impactor%contact_area='sphere'", "time%step=16e-6", "time%end=240e-6",
        "material%shear_failure_strain=.05", "ply_damage%in_situ=.true."]
# By central differences, with a row about every fifty steps.
EXPLICIT = ["time%integrator='central_difference'", "time%end=150e-6", "output%force_filter=2e4",
            "output%history_every=4e-6"]
# Steps that take a second, with several releases each.
RUNNING = ["mesh%elements=20,20", "impactor%velocity=3", "delamination%G_c=100", f"time%end={11 * STEP!r}",
           f"output%checkpoint_every={STEP!r}", f"output%fields_every={STEP!r}"]


# The operator is updated for delamination and contact over many steps before it is factored again.
FOLLOWING = ["mesh%elements=8,8", "plate%edges='simple'", "plate%symmetry='none'", "impactor%velocity=6",
             "delamination%G_c=50", "time%end=100e-6", "time%step=5e-6", "time%integrator='newmark'",
             "time%beta=0.28", "time%gamma=0.55"]


def growth(history, column="delaminated_area"):
    """Return the area that delaminated in each step but the first, or the growth of another column."""
    area = history[column]
    return [0.0, *(after - before for before, after in pairwise(area))]


def split_after(step, settings):
    """Add a single checkpoint after a step, some steps before the end, to the settings of a deck."""
    return [*settings, f"output%checkpoint_every={step * STEP!r}", f"time%end={min(2 * step - 1, step + 7) * STEP!r}"]


def check_every(implam, folder, _):
    """From every checkpoint of a run to its end."""
    check_all_checkpoints(implam, folder, DECK, FOLLOWING)


def check_cohesive(implam, folder, _):
    """From every checkpoint of a run with a cohesive interface."""
    check_all_checkpoints(implam, folder, "../small/cohesive.nml", [])


def check_layers(implam, folder, _):
    """From every checkpoint of a run in which layers are added."""
    check_all_checkpoints(implam, folder, "../small/layers.nml", [])
    layered = read_history(history_of(folder / "uninterrupted"))["layered_below_2"]
    require(len(set(layered)) > 2, "Layers grew less than twice: the trial is void.")


def check_softening(implam, folder, _):
    """From every checkpoint of a run with softening plies and residual stress."""
    check_all_checkpoints(implam, folder, "../small/crack_bands.nml", SOFTENING, "energy_ply_damage")


def check_nose(implam, folder, _):
    """From every checkpoint of a run with a spherical contact area and nonlinear shear."""
    check_all_checkpoints(implam, folder, "../small/crack_bands.nml", NOSE, "energy_ply_damage")
    areas = read_history(history_of(folder / "uninterrupted"))["contact_area"]
    require(len(set(areas)) > 2, "The area of contact changed less than twice: the trial is void.")


def check_explicit(implam, folder, _):
    """From each check of the limits in a run by central differences with softening plies."""
    reference = run_deck(implam, write_deck(folder / "uninterrupted", "../small/crack_bands.nml", EXPLICIT))
    history = read_history(reference)
    require(history["energy_ply_damage"][-1] > 0 and history["force_filtered"][-1] > 0, "The trial is void.")
    deck = write_deck(folder / "look_by_look", "../small/crack_bands.nml", EXPLICIT)
    words, checks = [deck, "--output", deck.parent], 0
    while run_to_check(implam, words) == EXIT_STOPPED:
        words, checks = ["restart", checkpoint_of(deck.parent)], checks + 1
    require(checks >= len(history["time"]), f"The run stopped {checks} times only: the trial is void.")
    require_same(history_of(deck.parent), reference, "a run for each check")
    print(f"Stopped {checks} times and continued: the same to the last bit")


def run_to_check(implam, words):
    """Continue until the wall-clock time is checked; return the exit code."""
    return exit_code(start(implam, *words, *SINGLE_STEP))


def check_all_checkpoints(implam, folder, source, settings, grows="delaminated_area"):
    """A run that is restarted after each step, and from every CONTINUED-th of its checkpoints to the end."""
    reference = run_deck(implam, write_deck(folder / "uninterrupted", source, settings))
    history = read_history(reference)
    steps = len(history["time"])
    require(max(growth(history, grows)) > 0 and any(old == new for old, new in pairwise(history["refactorisations"])),
            "Nothing grew, or the operator was not updated: the trial is void.")
    deck = write_deck(folder / "step_by_step", source, settings)
    words = [deck, "--output", deck.parent]
    for step in range(1, steps):
        run([implam, *words, *SINGLE_STEP], EXIT_STOPPED)
        words = ["restart", checkpoint_of(deck.parent)]
        if step % CONTINUED:
            continue
        copy = copy_run(deck.parent, folder / "again")
        require_same(go_on(implam, copy), reference, f"from the checkpoint after step {step}")
        require(damage_of(history_of(copy)) == damage_of(reference), f"Other cells delaminated after step {step}.")
    run([implam, *words])
    require_same(history_of(deck.parent), reference, "a run for each step")
    require(damage_of(history_of(deck.parent)) == damage_of(reference), "Other cells delaminated, a run for each step.")
    require(steps > 2 * CONTINUED, f"A run of {steps} steps is hardly continued: the trial is void.")
    print(f"Restarted after each of {steps - 1} steps, continued after every {CONTINUED}th: the same to the last bit")


def check_splits(implam, folder, _):
    """Before and after the step with the most growth."""
    for rule, release in (("equilibrium", "vcct"), ("one_per_step", "two_state")):
        split_around_growth(implam, folder, f"{rule}_{release}",
                            [f"delamination%growth='{rule}'", f"delamination%energy_release='{release}'"])


def split_around_growth(implam, folder, name, choices):
    """Split before and after the step with the most growth."""
    settings = [*GROWING, *choices]
    scout = write_deck(folder / name, DECK, [*settings, f"time%end={20 * STEP!r}"])
    grown = growth(read_history(run_deck(implam, scout)))
    limit = 1 + max(range(len(grown)), key=grown.__getitem__)
    for step in (limit - 1, limit):
        reference, again = run_split(implam, folder / f"{name}_{step}", DECK, split_after(step, settings))
        require_same(again, reference, f"{name} split after step {step}")
        require(damage_of(again) == damage_of(reference), f"{name}: other cells delaminated.")
        history = read_history(reference)
        later = history["delaminated_area"][-1] - history["delaminated_area"][step - 1]
        require(later > 0, f"{name}: nothing grew after the split, the trial is void.")
        print(f"{name} split after step {step}: {1e6 * later:.0f} mm^2 grow after it, the same to the last bit")


def rows_written(folder):
    """Return the current number of rows of the history in a folder; 0 if there is none yet."""
    return sum(max(0, path.read_text(encoding="utf-8", errors="replace").count("\n") - lines_before_rows(path))
               for path in folder.glob("*_history.csv"))


def lines_before_rows(path):
    """Return the number of lines before the first row of a history."""
    with path.open(encoding="utf-8", errors="replace") as file:
        return 1 + sum(line.startswith("#") for line in file)


def stop_during(implam, deck, step, stop, delay):
    """Send a signal some seconds after a step has begun; return whether the files of the run show that it was still
    being computed."""
    process = start(implam, deck, "--output", deck.parent)
    wait_until(lambda: rows_written(deck.parent) >= step - 1, process)
    time.sleep(delay)
    # Suspended, so that the step is certainly not completed when the signal arrives.
    process.send_signal(signal.SIGSTOP)
    inside = rows_written(deck.parent) == step - 1
    process.send_signal(stop)
    process.send_signal(signal.SIGCONT)
    code = exit_code(process)
    if stop == signal.SIGKILL:
        return inside
    require(code == EXIT_STOPPED, f"After {stop.name} the exit code is {code}, not {EXIT_STOPPED}.")
    return inside and len(read_history(history_of(deck.parent))["time"]) == step


def check_moments(implam, folder, _):
    """Stopped and killed within the step with the most releases."""
    reference = run_deck(implam, write_deck(folder / "uninterrupted", DECK, RUNNING))
    cells = released_cells(reference)
    require(len(cells) == len(read_history(reference)["time"]), "The fields are not those of every step.")
    releases = [0, *(min_releases(before, after) for before, after in pairwise(cells))]
    step = 1 + max(range(len(releases)), key=releases.__getitem__)
    print(f"Step {step} has {releases[step - 1]} releases at least, {len(cells[step - 1] - cells[step - 2])} cells")
    require(releases[step - 1] > 1, "No step has several releases: the trial is void.")
    for stop in (signal.SIGTERM, signal.SIGKILL):
        # The faster the machine, the sooner the step is completed.
        for trial in range(6):
            deck = write_deck(folder / stop.name, DECK, RUNNING)
            if stop_during(implam, deck, step, stop, 0.1 / 2**trial):
                break
        else:
            raise TrialError(f"{stop.name} never arrived within the step.")
        go_on(implam, deck.parent)
        require_same(history_of(deck.parent), reference, stop.name)
        require(released_cells(history_of(deck.parent)) == cells, f"{stop.name}: other cells delaminated.")
        print(f"{stop.name} within step {step}: the same to the last bit, the same cells in every step")


def check_ranks(implam, folder, launcher):
    """Changes of the number of ranks just before the growth."""
    for first, second in ((2, 1), (1, 2)):
        settings = split_after(11, [*GROWING, "solver%tolerance=1e-9"])
        launchers = [*launcher, str(first)], [*launcher, str(second)]
        reference, again = run_split(implam, folder / f"ranks_{first}_{second}", DECK, settings, launchers)
        require_close(again, reference, f"from {first} to {second} ranks")
        require(damage_of(again) == damage_of(reference), "Other cells delaminated.")
        require(read_history(reference)["delaminated_area"][-1] > read_history(reference)["delaminated_area"][10],
                "Nothing grew after the split, the trial is void.")


def check_rejected(implam, folder, _):
    """Steps that are repeated with half the length while delaminations grow."""
    tight = [*GROWING, "delamination%G_c=100", f"time%step={STEP!r}", "solver%tolerance=1e-9"]
    histories = check_next_to_rejections(implam, folder, DECK, tight, STEP, 16)
    require(max(max(growth(read_history(path))) for path in histories) > 0, "Nothing grew: the trial is void.")


TRIALS = {"every": check_every, "splits": check_splits, "moments": check_moments, "ranks": check_ranks,
          "rejected": check_rejected, "cohesive": check_cohesive,
          "layers": check_layers,
          "softening": check_softening, "nose": check_nose, "explicit": check_explicit}


if __name__ == "__main__":
    raise SystemExit(main(TRIALS, *sys.argv[1:]))
