"""Jobs of a real Slurm, started here on one node: a chain that is stopped by its limit again and again ends with the
history of an undisturbed run, bit for bit.
Usage: queue_chain.py IMPLAM FOLDER     (exit code 77: skipped, with the reason)"""

import os
import shutil
import signal
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "regress"))
from slurm import MissingError, Slurm
from solver_runs import change_deck, require, run

SKIPPED = 77
PARTS = 4
DECK = HERE.parents[1] / "input/small/damage.nml"
# Slurm looks at limits every half a minute. So that seconds of computing fill some minutes, the program is stopped most
# of the time in all parts but the last; what it computes is the same.
FILLED, AWAKE = 300, 0.02  # seconds


def undisturbed(implam, folder):
    """Run the deck once as it is; return its history and the seconds it has taken, on a machine as busy as it is."""
    begun = time.monotonic()
    run([implam, folder / "deck.nml", "--output", folder / "whole"])
    return (folder / "whole/deck_history.csv").read_bytes(), time.monotonic() - begun


def chain(implam, slurm, folder, expected, taken):
    """A job of a minute's limit that comes again until the run has ended."""
    slow = folder / "slow"
    asleep = FILLED * AWAKE / taken
    slow.write_text(f"""#!/bin/bash
if ((${{SLURM_RESTART_COUNT:-0}} >= {PARTS - 1})); then exec {implam} "$@"; fi
exec {HERE}/slow.sh {AWAKE} {asleep} {implam} "$@"
""", encoding="utf-8")
    slow.chmod(0o755)
    run([implam, "queue", "slurm", "deck.nml", "--chain", "--time", "0:01:00"], folder=folder)
    number = slurm.submit(folder, "deck.slurm", "--signal=B:USR1@50", IMPLAM=str(slow))
    job = slurm.end_of(number, 800)
    told = (folder / f"deck.{number}.txt").read_text(encoding="utf-8")
    print(f"chain: {job['JobState']}, requeued {job['Restarts']} times")
    require(job["JobState"] == "COMPLETED", f"The chain has ended with {job['JobState']}:\n{told}")
    require(int(job["Restarts"]) >= PARTS - 1, f"The chain has {job['Restarts']} requeues only.")
    history = (folder / "results/deck_history.csv").read_bytes()
    require(history == expected, "The history of the chain isn't that of the undisturbed run.")


def main():
    """Start Slurm, run the jobs, end it."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # by way of the end of Slurm's daemons
    implam, folder = os.path.abspath(sys.argv[1]), Path(sys.argv[2]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    deck = change_deck(DECK.read_text(encoding="utf-8"), ["output%directory='results'", "case%name='deck'",
                                                          "time%end=10e-3"])
    (folder / "deck.nml").write_text(deck, encoding="utf-8")
    expected, taken = undisturbed(implam, folder)
    place = tempfile.mkdtemp(prefix="slurm")  # paths of sockets have to be short
    try:
        with Slurm(place) as slurm:
            chain(implam, slurm, folder, expected, taken)
    except MissingError as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    shutil.rmtree(place)
    return 0


if __name__ == "__main__":
    sys.exit(main())
