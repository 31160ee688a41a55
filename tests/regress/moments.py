#!/usr/bin/env python3
"""Runs killed or stopped at random times and resumed must end as the uninterrupted run.
Usage: moments.py TRIAL IMPLAM FOLDER COUNT LAUNCHER...     (LAUNCHER takes the number of ranks as its last word)

kills    SIGKILL COUNT times on one rank and COUNT times on two, every other one while a checkpoint is being written:
         histories and damage are those of the uninterrupted run, bitwise on one rank and to 1e-9 on two; no file
         is left
signals  TERM, INT and USR1 to the program, to one rank, to both and to mpirun, COUNT times each, once and twice in
         turn: a checkpoint, or nothing written yet, and the code of the manual; a run continued from it ends likewise
early    before main is entered, and while METIS has replaced the handler of TERM: the same"""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from itertools import product
from pathlib import Path

from released_cells import damage_of
from restart import ranks_of, require_close, require_same, wait_until
from restart_growth import GROWING, SOFTENING, rows_written
from solver_runs import EXIT_DONE, EXIT_STOPPED, exit_code_of, history_of, require, run, run_deck, write_deck

HERE = Path(__file__).resolve().parent
os.environ |= {"OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_hwloc_base_binding_policy": "none",
               "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
               "PRTE_MCA_hwloc_default_binding_policy": "none"}
# Fronts that grow while plies fail, a cohesive interface, and plies that soften; a checkpoint in each step.
MODELS = {"fronts": ("../small/damage.nml", [*GROWING, "time%end=400e-6", "output%checkpoint_every=10e-6",
                                             "output%fields_every=50e-6"]),
          "cohesive": ("../small/cohesive.nml", ["output%checkpoint_every=10e-6", "output%fields_every=50e-6"]),
          "softening": ("../small/crack_bands.nml", [*SOFTENING, "output%checkpoint_every=5e-6",
                                                     "output%fields_every=30e-6"])}
# Range of the signals: the fronts grow until 170e-6, and a run outlasts the latest signal by a dozen steps.
SIGNALLED = "time%end=240e-6"
# A few steps behind the checkpoint of a signal at the start.
SHORT = "time%end=60e-6"
PATIENCE = 1800  # seconds, on a busy machine
MPIRUN_STOPPED = 1  # exit code of Open MPI's launcher after TERM and INT


class Model:
    """A deck, its uninterrupted run, and interrupted ones."""

    def __init__(self, implam, folder, name, launcher=(), settings=()):
        """Run it once, with settings in addition to the model's own."""
        self.implam, self.folder, self.name, self.launcher = implam, folder / name, name, launcher
        source, own = MODELS[name]
        self.settings = source, [*own, *settings, "solver%tolerance=1e-9"]
        self.reference = run_deck(implam, write_deck(self.folder / "alone", *self.settings), launcher)
        self.damage = damage_of(self.reference)

    def fresh(self):
        """Return the path of the deck in a folder without other files."""
        return write_deck(self.folder / "disturbed", *self.settings)

    def start(self, deck, errors=subprocess.DEVNULL, **variables):
        """Start the run, or continue it if there is a checkpoint; return the launcher's process, or the program's.
        `errors` takes the standard error."""
        words = ["restart", deck.parent] if list(deck.parent.glob("*_restart.h5")) else [deck, "--output", deck.parent]
        return subprocess.Popen([str(word) for word in (*self.launcher, self.implam, *words)], start_new_session=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors,
                                env=os.environ | variables)

    def ranks(self, process):
        """Return the numbers of the program's processes."""
        return ranks_of(process, self.implam) if self.launcher else [process.pid]

    def check_end(self, deck, what):
        """An interrupted run has ended as the uninterrupted one, with the same files."""
        history = history_of(deck.parent)
        if self.launcher:
            require_close(history, self.reference, what)
        else:
            require_same(history, self.reference, what)
        require(damage_of(history) == self.damage, f"{what}: other cells have delaminated or other plies failed.")
        left = {path.name for path in deck.parent.iterdir()} - {path.name for path in self.reference.parent.iterdir()}
        require(not left, f"{what}: {sorted(left)} are left over.")


def state_of(number):
    """Return the letter of a process's state and its session; Z and 0 if it has ended."""
    try:
        state, _, _, session = Path(f"/proc/{number}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()[:4]
    except OSError:
        return "Z", 0
    return state, int(session)


def session_of(process):
    """Return the processes of a launcher's session that still run."""
    numbers = [int(path.name) for path in Path("/proc").glob("[0-9]*")]
    states = {number: state_of(number) for number in numbers}
    return [number for number, (state, session) in states.items() if session == process.pid and state != "Z"]


def stop_all(numbers):
    """Suspend processes, so that their files do not change; return those that are suspended. A process that has begun
    to exit takes no signal any more and ends normally."""
    send(numbers, signal.SIGSTOP)
    while any(state_of(number)[0] not in "TXZ" for number in numbers):
        time.sleep(0.0005)
    return [number for number in numbers if state_of(number)[0] == "T"]


def send(numbers, stop):
    """Send a signal to processes, of which some may have ended."""
    for number in numbers:
        try:
            os.kill(number, stop)
        except ProcessLookupError:
            continue


def end_of(process):
    """Wait for the end of a session and return the exit code."""
    code = process.wait(PATIENCE)
    latest = time.monotonic() + PATIENCE
    while session_of(process):
        require(time.monotonic() < latest, "Ranks continue without their launcher.")
        time.sleep(0.02)
    return code


def wait_for_writing(deck, process, times):
    """Wait until a checkpoint is being written for the given number of times, or until the run ends."""
    aside = [deck.parent / name for name in ("damage", "cohesive", "crack_bands")]
    aside = [path.with_name(path.name + "_restart.h5.tmp") for path in aside]
    for _ in range(times):
        for wanted in (False, True):
            while any(path.exists() for path in aside) != wanted and process.poll() is None:
                time.sleep(0.0005)


def wait_for_rows(deck, process, more):
    """Wait until the run has written the given number of further rows, however slow the machine, or until the run
    ends."""
    wanted = rows_written(deck.parent) + more
    while rows_written(deck.parent) < wanted and process.poll() is None:
        time.sleep(0.002)


def kill_once(model, deck, moments, writing):
    """Kill a run at a random moment; return whether it was still running, whether a checkpoint was being written, and
    whether the run has nevertheless ended."""
    process = model.start(deck)
    if writing:
        wait_for_writing(deck, process, moments.randrange(1, 6))
        time.sleep(moments.uniform(0, 0.004))
    elif moments.random() < 0.25:
        time.sleep(moments.uniform(0, 0.5))  # while the run is set up or the checkpoint read
    else:
        wait_for_rows(deck, process, moments.randrange(1, 9))
        time.sleep(moments.uniform(0, 0.03))
    running = session_of(process)
    victims = moments.choice([running, [process.pid], model.ranks(process)[:1]])
    hit = bool(set(stop_all(running)) & set(victims))
    written = bool(list(deck.parent.glob("*_restart.h5.tmp")))
    send(victims, signal.SIGKILL)
    send(running, signal.SIGCONT)
    code = end_of(process)
    require(code != EXIT_DONE or not hit, "A killed run ends with 0.")
    return hit, written, code == EXIT_DONE


def check_kills(implam, folder, count, launcher):
    """On one rank, then on two."""
    for ranks, launched in ((1, ()), (2, (*launcher, "2"))):
        moments = random.Random(ranks)
        models = [Model(implam, folder / str(ranks), name, launched) for name in MODELS]
        kills, writing, chains = 0, 0, 0
        while kills < count:
            model = models[chains % len(models)]
            deck, ended, mine = model.fresh(), False, 0
            # After the last kill the run is not interrupted.
            while not ended:
                if kills >= count or mine >= 12:
                    ended = end_of(model.start(deck)) == EXIT_DONE
                    require(ended, "The run does not end without interruption.")
                    break
                hit, written, ended = kill_once(model, deck, moments, kills % 2 == 1)
                kills, writing, mine = kills + hit, writing + (hit and written), mine + hit
            model.check_end(deck, f"{model.name}, {ranks} rank(s), {mine} kills")
            chains += 1
            print(f"{model.name}, {ranks} rank(s): {mine} kills, {kills} so far, {writing} of them within a checkpoint",
                  flush=True)
        print(f"{ranks} rank(s): {kills} kills, {writing} while a checkpoint was being written, in {chains} chains: "
              f"{'to 1e-9' if launched else 'the same to the last bit'}, no file left over", flush=True)


def printed(model, deck, target, stop, times, rows):
    """Stop a run; return the exit code and its standard error."""
    errors = deck.with_name("errors")
    with errors.open("w", encoding="utf-8") as file:
        process = model.start(deck, file)
    wait_until(lambda: list(deck.parent.glob("*.log")), process)
    if rows:
        wait_for_rows(deck, process, rows)
    chosen = {"mpirun": [process.pid], "one rank": model.ranks(process)[:1]}.get(target) or model.ranks(process)
    for _ in range(times):
        send(chosen, stop)
        time.sleep(0.002)
    code, said = end_of(process), errors.read_text(encoding="utf-8")
    errors.unlink()
    return code, said


def check_signals(implam, folder, count, launcher):
    """Every signal to every target; the run is then continued without interruption."""
    moments = random.Random(3)
    alone = Model(implam, folder / "1", "fronts", settings=[SIGNALLED])
    both = Model(implam, folder / "2", "fronts", (*launcher, "2"), [SIGNALLED])
    targets = (alone, "the program"), (both, "one rank"), (both, "both ranks"), (both, "mpirun")
    stops = signal.SIGTERM, signal.SIGINT, signal.SIGUSR1
    for (place, (model, target)), (turn, stop) in product(enumerate(targets), enumerate(stops)):
        checkpoints = 0
        for trial in range(count):
            # Each target and each signal occurs once and twice, also with one trial of a pair.
            times = 1 + (place + turn + trial) % 2
            what = f"{stop.name} {'twice' if times == 2 else 'once'} to {target}"
            saved = check_signalled(model, target, stop, times, moments.randrange(12), what)
            checkpoints += saved
        print(f"{stop.name} to {target}: a checkpoint {checkpoints} of {count} times", flush=True)


def check_signalled(model, target, stop, times, rows, what):
    """Stop a run after some rows and continue it; return whether it has left a checkpoint."""
    deck = model.fresh()
    code, said = printed(model, deck, target, stop, times, rows)
    saved = bool(list(deck.parent.glob("*_restart.h5")))
    if target == "mpirun" and stop != signal.SIGUSR1:
        require(code == MPIRUN_STOPPED, f"{what}: code {code}, not {MPIRUN_STOPPED}.")
    else:
        require(code == EXIT_STOPPED and saved, f"{what}: code {code}, checkpoint: {saved}.")
        require(said.count("signal received") == 1, f"{what}: instead of one line that announces the end\n{said}")
    require(end_of(model.start(deck)) == EXIT_DONE, f"{what}: it is not continued.")
    model.check_end(deck, what)
    return saved


def check_early(implam, folder, _, launcher):
    """At moments that a timer would not meet; a first step is taken and saved."""
    library = folder / "early.so"
    folder.mkdir(parents=True)
    run(["cc", "-shared", "-fPIC", "-o", library, HERE.parent / "support/early_signals.c", "-ldl"])
    models = {1: Model(implam, folder / "1", "fronts", settings=[SHORT]),
              2: Model(implam, folder / "2", "fronts", (*launcher, "2"), [SHORT])}
    cases = [("load", stop, 1) for stop in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1)]
    for moment, stop, ranks in (*cases, ("metis", signal.SIGTERM, 2)):
        model, mark = models[ranks], folder / "mark"
        deck = model.fresh()
        # The launcher and its shells must not receive the signal.
        words = {"EARLY_MOMENT": moment, "EARLY_SIGNAL": str(int(stop)), "EARLY_MARK": str(mark)}
        wrapper = folder / Path(implam).name
        wrapper.write_text(f'#!/bin/sh\nLD_PRELOAD={library} exec {implam} "$@"\n', encoding="utf-8")
        wrapper.chmod(0o755)
        model.implam = wrapper
        code = end_of(model.start(deck, **words))
        model.implam = implam
        require(mark.exists(), f"{stop.name} was never sent at the moment {moment}.")
        mark.unlink()
        saved = bool(list(deck.parent.glob("*_restart.h5")))
        require(code == EXIT_STOPPED and saved, f"{stop.name} ({moment}): code {code}, checkpoint: {saved}.")
        require(end_of(model.start(deck)) == EXIT_DONE, f"{stop.name} ({moment}): it is not continued.")
        model.check_end(deck, f"{stop.name} ({moment})")
        print(f"{stop.name} ({moment}): code {code}, with a checkpoint")


TRIALS = {"kills": check_kills, "signals": check_signals, "early": check_early}


def main(trial, implam, folder, count, *launcher):
    """Run one of the trials; the exit code is 1 if it fails."""
    shutil.rmtree(folder, ignore_errors=True)
    return exit_code_of(TRIALS[trial], os.path.abspath(implam), Path(folder).resolve(), int(count), launcher)


if __name__ == "__main__":
    if len(sys.argv) < 5 or "--help" in sys.argv:
        raise SystemExit(__doc__)
    raise SystemExit(main(*sys.argv[1:]))
