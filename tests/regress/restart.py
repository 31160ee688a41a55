"""Restarts give the uninterrupted history.
Usage: restart.py TRIAL IMPLAM FOLDER [LAUNCHER...]     (LAUNCHER takes the number of ranks as its last word)

integrators  every pair of integrators, each integrator with linear and von Karman's strains, and adaptive steps:
             bitwise on one rank
contact      delaminated surfaces in contact by both laws: bitwise
ranks        from 1 rank to 2 and back, and from 4 to 2: to 1e-9
rejected     from checkpoints on either side of rejected steps: bitwise
signal       SIGTERM ends a run with a checkpoint and its own exit code: bitwise
ranks_signal two ranks that receive TERM twice, as from a queue, and mpirun that receives USR1, end likewise: to 1e-9
limit        the wall-clock limit ends runs in time with a checkpoint and the same exit code: bitwise
kill         SIGKILL at any time leaves a usable checkpoint: bitwise"""

import filecmp
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from solver_runs import (
    EXIT_DONE,
    EXIT_STOPPED,
    TrialError,
    checkpoint_of,
    exit_code_of,
    history_of,
    largest_difference,
    read_history,
    require,
    run,
    run_deck,
    write_deck,
)

TOLERANCE = 1e-9
IMPACT = "sun_chen_tan_sun.nml"
DAMAGE = "../small/damage.nml"
# Seconds allowed for a run on a busy machine, within the time limit of the test.
PATIENCE = 240
# A strong impact on a coarse mesh: von Karman strains with deflections of several thicknesses where requested.
SHORT = ["mesh%elements=6,6", "impactor%velocity=30", "time%step=2e-6", "time%end=120e-6"]
# Integrators of the plate.
PLATES = ("newmark", "generalized_alpha")
# Steps so long that some do not converge within few iterations.
PERIOD = 60e-6
LONG_STEPS = ["mesh%elements=6,6", "impactor%velocity=300", "case%kinematics='von_karman'", f"time%step={PERIOD!r}",
              "impactor%integrator='conserving'", "solver%tolerance=1e-10", "adapt%on=.false.", "adapt%iterations=1"]
# All are needed: which of the first steps are rejected depends on the solver, and with fewer iterations none succeeds.
FEW_ITERATIONS = range(15, 2, -1)


def copy_run(source, target):
    """Copy the folder of a run, so that the original remains for comparison."""
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)
    return target


def go_on(implam, folder, launcher=()):
    """Restart from the checkpoint in a folder and return the path of the history."""
    run([*launcher, implam, "restart", checkpoint_of(folder)])
    return history_of(folder)


def run_split(implam, folder, deck, settings, launchers=((), ())):
    """Run a deck that leaves a checkpoint and continue from it in a copy; return the paths of both histories."""
    deck = write_deck(folder, deck, settings)
    reference = run_deck(implam, deck, launchers[0])
    return reference, go_on(implam, copy_run(deck.parent, folder.with_name(f"{folder.name}_again")), launchers[1])


def require_same(path, reference, what):
    """Fail unless two histories are the same to the last bit."""
    if filecmp.cmp(path, reference, shallow=False):
        return
    difference, column = largest_difference(read_history(path), read_history(reference))
    raise TrialError(f"{what}: the history differs from the uninterrupted one by {difference:.2e} ({column}).")


def check_goes_on(implam, folder, deck, settings):
    """Fail unless a run continues bitwise from its last checkpoint; return its history."""
    reference, again = run_split(implam, folder / "whole", deck, settings)
    require_same(again, reference, deck)
    return read_history(reference)


def require_close(path, reference, what):
    """Fail unless two histories agree to the tolerance; iterations may differ."""
    expected = read_history(reference)
    left_out = ("refactorisations", "solves", "complementarity")
    counts = [name for name in expected if "iterations" in name or name in left_out]
    difference, column = largest_difference(read_history(path), expected, counts)
    print(f"{what}: largest difference {difference:.2e} ({column})")
    require(difference <= TOLERANCE, f"{what}: the history differs from the uninterrupted one.")


def split_at(fraction, settings):
    """Add a single checkpoint at a fraction of the run, above one half, to the settings of a deck."""
    end = next(float(setting.split("=")[1]) for setting in settings if setting.startswith("time%end"))
    return [*settings, f"output%checkpoint_every={fraction * end!r}"]


def check_integrators(implam, folder, _):
    """Every pair of integrators, each integrator with both kinematics, and adaptive steps."""
    cases = {}
    for impactor, plates in (("gear4", PLATES), ("trapezoidal", PLATES), ("central", PLATES[::-1]),
                             ("conserving", PLATES[::-1])):
        for plate, kinematics in zip(plates, ("linear", "von_karman"), strict=True):
            cases[f"{impactor}_{plate}_{kinematics}"] = [f"impactor%integrator='{impactor}'",
                f"time%integrator='{plate}'", f"case%kinematics='{kinematics}'", "time%rho_inf=0.8"]
    for impactor in ("gear4", "conserving"):
        cases[f"{impactor}_adaptive"] = [f"impactor%integrator='{impactor}'", "case%kinematics='von_karman'",
            "adapt%on=.true.", "time%step=0.1e-6", "time%step_max=4e-6", "adapt%refactor='deflection'"]
    for name, settings in cases.items():
        reference, again = run_split(implam, folder / name, IMPACT, split_at(0.53, SHORT + settings))
        require_same(again, reference, name)
        print(f"{name}: {len(read_history(reference)['time'])} rows, the same to the last bit")


def check_contact(implam, folder, _):
    """Delaminated faces in contact, by both laws: the pressures and their decay are restored."""
    laws = {"augmented_lagrangian": [], "continuous_penalty": ["delamination%contact_exponent=1.5"]}
    for contact, exponent in laws.items():
        law = [f"delamination%contact='{contact}'", *exponent]
        settings = split_at(0.53, ["time%end=0.3e-3", *law])
        reference, again = run_split(implam, folder / contact, "../small/delamination.nml", settings)
        pressed = max(read_history(reference)["contact_iterations"])
        require(pressed > 0, f"{contact}: no faces were in contact, the trial is void.")
        require_same(again, reference, contact)
        print(f"{contact}: the same to the last bit")


def check_ranks(implam, folder, launcher):
    """Changes of the number of ranks."""
    settings = split_at(0.53, [*SHORT, "case%kinematics='von_karman'"])
    for first, second in ((1, 2), (2, 1), (4, 2)):
        launchers = [*launcher, str(first)], [*launcher, str(second)]
        reference, again = run_split(implam, folder / f"ranks_{first}_{second}", IMPACT, settings, launchers)
        require_close(again, reference, f"from {first} to {second} ranks")


def rejections(path, period):
    """Return the numbers of checkpoint periods in which a step was rejected, and the last checkpoint's period."""
    history = read_history(path)
    rejected = [0.0, *history["rejected"]]
    found = {int(time / period * (1 - 1e-9)) for i, time in enumerate(history["time"]) if rejected[i + 1] > rejected[i]}
    return found, int(history["time"][-1] / period * (1 + 1e-9))


def split_next_to_rejections(implam, folder, deck, settings, period, periods):
    """Split runs next to the first periods with a rejected step; return the histories, and the numbers of splits just
    before and just after such a step."""
    scout = write_deck(folder / "scout", deck, [*settings, f"time%end={periods * period!r}"])
    try:
        found, _ = rejections(run_deck(implam, scout), period)
    except TrialError as failure:
        raise TrialError(f"No number of iterations rejects steps and yet reaches the end: {failure}") from None
    before, after, histories = 0, 0, []
    # Half a period after a checkpoint would not reveal a lost step: the halved and the full step both fit in.
    ends = {number + share for number in sorted(found)[:2] for share in (0.9999, 1.9999) if number + share > 1}
    for end in sorted(ends):
        reference, again = run_split(implam, folder / f"end_{end}", deck, [*settings, f"time%end={end * period!r}"])
        require_same(again, reference, f"end after {end} periods")
        histories.append(reference)
        now, last = rejections(reference, period)
        before += last in now
        after += last - 1 in now
    return histories, before, after


def check_next_to_rejections(implam, folder, deck, settings, period, periods):
    """Runs whose last checkpoint is just before and just after rejected steps, with fewer and fewer iterations allowed
    until there have been both; return all histories."""
    settings = [*settings, f"output%checkpoint_every={period!r}"]
    before, after, histories = 0, 0, []
    for limit in FEW_ITERATIONS:
        few = [*settings, f"solver%max_iterations={limit}"]
        found, just_before, just_after = split_next_to_rejections(implam, folder / f"iterations_{limit}", deck, few,
                                                                  period, periods)
        before, after, histories = before + just_before, after + just_after, histories + found
        if before and after:
            print(f"Down to {limit} iterations at most, checkpoints just before a rejected step: {before}, just after: "
                  f"{after}; the same to the last bit")
            return histories
    raise TrialError("No checkpoint was next to a rejected step: the trial is void.")


def check_rejected(implam, folder, _):
    """Long steps with von Karman's strains."""
    check_next_to_rejections(implam, folder, IMPACT, LONG_STEPS, PERIOD, 8)


def start(implam, *words):
    """Start the program and return its process."""
    return subprocess.Popen([str(word) for word in (implam, *words)], stdin=subprocess.DEVNULL,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def wait_until(condition, process):
    """Wait until the condition holds; the process must still be running then."""
    latest = time.monotonic() + PATIENCE
    while not condition() and process.poll() is None and time.monotonic() < latest:
        time.sleep(0.01)
    require(process.poll() is None, f"The run ended too early, with {process.returncode}.")


def exit_code(process):
    """Wait for a process to end and return its exit code; one that runs too long is killed."""
    try:
        return process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        raise


def model_lines(folder):
    """Return the number of runs in a folder that have set up their model, by the log that they share."""
    return sum(log.read_text(encoding="utf-8").count("Model:") for log in folder.glob("*.log"))


def stamp(folder):
    """Return the time at which the checkpoint in a folder was written; 0 if there is none."""
    return max((path.stat().st_mtime_ns for path in folder.glob("*_restart.h5")), default=0)


LONG = ["mesh%elements=16,16", "case%kinematics='von_karman'", "impactor%velocity=10", "time%end=2400e-6"]


def check_signal(implam, folder, _):
    """Stopped by signals, repeatedly."""
    reference = run_deck(implam, write_deck(folder / "uninterrupted", IMPACT, LONG))
    deck = write_deck(folder / "stopped", IMPACT, LONG)
    process = start(implam, deck, "--output", deck.parent)
    for runs, stop in enumerate((signal.SIGTERM, signal.SIGUSR1, signal.SIGINT), start=1):
        wait_until(lambda runs=runs: model_lines(deck.parent) >= runs, process)
        time.sleep(0.02)
        process.send_signal(stop)
        code = exit_code(process)
        require(code == EXIT_STOPPED, f"After {stop.name} the exit code is {code}, not {EXIT_STOPPED}.")
        rows = len(read_history(history_of(deck.parent))["time"])
        print(f"{stop.name} after {rows} rows", flush=True)
        process = start(implam, "restart", checkpoint_of(deck.parent))
    require(exit_code(process) == EXIT_DONE, "The last restart failed.")
    require_same(history_of(deck.parent), reference, "signals")


# Options that end a run after its next step.
SINGLE_STEP = ["--wall-limit", "1e-3"]


def ranks_of(process, implam):
    """Return the processes of the program that a launcher has started."""
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            # The name of a process is in brackets and may hold anything.
            name, rest = status.read_text(encoding="utf-8").split("(", 1)[1].rsplit(")", 1)
        except (OSError, IndexError):
            continue
        if int(rest.split()[1]) == process.pid and Path(implam).name.startswith(name):
            found.append(int(status.parent.name))
    return found


def signal_twice(process, implam):
    """Send TERM to every rank, twice."""
    ranks = ranks_of(process, implam)
    require(len(ranks) == 2, f"mpirun has started {len(ranks)} ranks.")
    for _ in range(2):
        for rank in ranks:
            os.kill(rank, signal.SIGTERM)
        time.sleep(0.001)


def check_ranks_signal(implam, folder, launcher):
    """Signals to two ranks and to their launcher."""
    reference = run_deck(implam, write_deck(folder / "uninterrupted", IMPACT, LONG))
    deck = write_deck(folder / "stopped", IMPACT, LONG)
    words = [deck, "--output", deck.parent]
    stops = {"TERM twice": lambda process: signal_twice(process, implam),
             "USR1 to mpirun": lambda process: process.send_signal(signal.SIGUSR1)}
    for runs, (name, stop) in enumerate(stops.items(), start=1):
        process = start(*launcher, "2", implam, *words)
        # Rows are written at intervals, but the first one is written after METIS has been called.
        wait_until(lambda runs=runs: model_lines(deck.parent) >= runs, process)
        time.sleep(0.5)
        stop(process)
        code = exit_code(process)
        require(code == EXIT_STOPPED, f"After {name} the exit code is {code}, not {EXIT_STOPPED}.")
        print(f"{name} after {len(read_history(history_of(deck.parent))['time'])} rows", flush=True)
        words = ["restart", checkpoint_of(deck.parent)]
    run([implam, *words])
    require_close(history_of(deck.parent), reference, "signals")


def stop_by_limit(implam, folder, command, seconds):
    """Run a command that the wall-clock limit must end; return the number of rows written."""
    begun = time.monotonic()
    said = run([implam, *command], EXIT_STOPPED)
    took = time.monotonic() - begun
    require("wall-clock time" in said, f"The sentence does not name the wall-clock time: {said}")
    require(took < seconds or seconds == 0, f"With {seconds} s the run took {took:.2f} s.")
    rows = len(read_history(history_of(folder))["time"])
    print(f"Stopped after {took:.2f} of {seconds} s with {rows} rows", flush=True)
    return rows


def check_limit(implam, folder, _):
    """Stopped by the wall-clock limit: by the deck's, by the command line's, and after every single step."""
    # Two seconds of each limit are reserved for the start and the end of the program, so the limits must be longer.
    took, step = 0, 1e-6
    while took < 4:
        step /= 2
        settings = [*LONG, f"time%step={step!r}"]
        begun = time.monotonic()
        reference = run_deck(implam, write_deck(folder / "uninterrupted", IMPACT, settings))
        took = time.monotonic() - begun
    seconds = max(0.25 * took, 3.0)
    deck = write_deck(folder / "limited", IMPACT, [*settings, f"time%wall_limit={seconds!r}"])
    rows = [stop_by_limit(implam, deck.parent, [deck, "--output", deck.parent], seconds)]
    checkpoint = checkpoint_of(deck.parent)
    seconds *= 1.2
    rows.append(stop_by_limit(implam, deck.parent, ["restart", checkpoint, "--wall-limit", seconds], seconds))
    require(rows[0] > 10 and rows[1] > rows[0] + 10, f"Stopped too early: {rows} rows.")
    run([implam, "restart", checkpoint, "--wall-limit", PATIENCE])
    require_same(history_of(deck.parent), reference, "limits")
    settings = [*SHORT, "time%end=10e-6", "case%kinematics='von_karman'"]
    reference = run_deck(implam, write_deck(folder / "few_steps", IMPACT, settings))
    deck = write_deck(folder / "each_step", IMPACT, settings)
    command = [deck, "--output", deck.parent]
    for step in range(1, 5):
        rows = stop_by_limit(implam, deck.parent, [*command, *SINGLE_STEP], 0)
        require(rows == step, f"{rows} rows were written instead of one per run.")
        command = ["restart", checkpoint_of(deck.parent)]
    run([implam, *command, *SINGLE_STEP])
    require_same(history_of(deck.parent), reference, "a run for each step")


def check_kill(implam, folder, _):
    """Killed at random moments until the end is reached."""
    settings = [*LONG, "output%checkpoint_every=5e-6"]
    reference = run_deck(implam, write_deck(folder / "uninterrupted", IMPACT, settings))
    deck = write_deck(folder / "killed", IMPACT, settings)
    moments = random.Random(1)
    process = start(implam, deck, "--output", deck.parent)
    for _ in range(8):
        before = stamp(deck.parent)
        wait_until(lambda before=before: stamp(deck.parent) != before, process)
        time.sleep(moments.uniform(0, 0.05))
        process.kill()
        process.wait()
        process = start(implam, "restart", checkpoint_of(deck.parent))
    require(exit_code(process) == EXIT_DONE, f"The last run ended with {process.returncode}.")
    require_same(history_of(deck.parent), reference, "kills")
    print("8 kills; the same to the last bit")


TRIALS = {"integrators": check_integrators, "contact": check_contact, "ranks": check_ranks, "rejected": check_rejected,
          "signal": check_signal, "ranks_signal": check_ranks_signal, "limit": check_limit, "kill": check_kill}


def main(trials, trial, implam, folder, *launcher):
    """Run one of the trials; the exit code is 1 if it fails."""
    shutil.rmtree(folder, ignore_errors=True)
    return exit_code_of(trials[trial], os.path.abspath(implam), Path(folder), launcher)


if __name__ == "__main__":
    raise SystemExit(main(TRIALS, *sys.argv[1:]))
