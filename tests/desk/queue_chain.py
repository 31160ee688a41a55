"""Jobs of a real Slurm, started here on one node: an array of a sweep, of which a task is stopped and
requeued, gives the table of the same sweep without a queue; a chain of jobs that reach their time limit ends with the
history of an uninterrupted run, bit for bit.
Usage: queue_chain.py IMPLAM FOLDER     (exit code 77: skipped, with the reason)"""

import csv
import os
import shutil
import signal
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "regress"))
from slurm import MissingError, Slurm
from solver_runs import change_deck, require, run

SKIPPED = 77
PARTS = 3
DECK = HERE.parents[1] / "input/small/damage.nml"


def write_program(path, code):
    """Write a script that is called in place of the program."""
    path.write_text(f"#!/bin/bash\n{code}\n", encoding="utf-8")
    path.chmod(0o755)
    return str(path)


def submit_chain(implam, slurm, folder):
    """Submit a job with a limit of a minute that is requeued until the run has ended; all parts but the last are
    suspended."""
    held = write_program(folder / "held", f"""
if ((${{SLURM_RESTART_COUNT:-0}} >= {PARTS - 1})); then exec {implam} "$@"; fi
exec {HERE}/held.sh {folder}/results/deck_restart.h5 {implam} "$@" """)
    run([implam, "queue", "slurm", "deck.nml", "--chain", "--time", "0:01:00"], folder=folder)
    return slurm.submit(folder, "deck.slurm", "--signal=B:USR1@50", IMPLAM=held)


def check_chain(slurm, folder, number, expected):
    """Wait for the end of the chain and compare its history with the expected one."""
    job = slurm.end_of(number, 800)
    printed = (folder / f"deck.{number}.txt").read_text(encoding="utf-8")
    print(f"chain: {job['JobState']}, requeued {job['Restarts']} times")
    require(job["JobState"] == "COMPLETED", f"The chain has ended with {job['JobState']}:\n{printed}")
    require(int(job["Restarts"]) >= PARTS - 1, f"The chain has {job['Restarts']} requeues only.")
    history = (folder / "results/deck_history.csv").read_bytes()
    require(history == expected, "The history of the chain is not that of the uninterrupted run.")


SWEEP = """deck = "swept.nml"
[grid]
"impactor.velocity" = [1.5, 2.0, 2.5, 3.0]
"time.end" = [1e-3]
"time.step" = [2e-6]
"output.checkpoint_every" = [0.25e-3]
"""


def table_of(folder):
    """Return the rows of a sweep's table without their times."""
    with (folder / "table.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        require(float(row.pop("cpu_time")) > 0, "The time of a case is zero.")
    return rows


def array(implam, slurm, folder):
    """An array over a sweep, one task of which is stopped."""
    folder.mkdir()
    shutil.copy(DECK, folder / "swept.nml")
    (folder / "sweep.toml").write_text(SWEEP, encoding="utf-8")
    sweep = [sys.executable, "-m", "implam_post.sweep", "sweep.toml"]
    run([*sweep, "--output", "plain", "--program", implam], folder=folder)
    # The first task is suspended until it is released; its last argument is the folder of its results.
    held = write_program(folder / "held", f"""
if [[ ${{SLURM_ARRAY_TASK_ID:-}} != 1 || ${{SLURM_RESTART_COUNT:-0}} != 0 ]]; then
  exec {implam} "$@"
fi
exec {HERE}/held.sh "${{!#}}/damage_restart.h5" {implam} "$@" """)
    run([*sweep, "--output", "queued", "--program", held, "--array"], folder=folder)
    run([implam, "queue", "slurm", "queued/array.txt", "--chain", "--time", "0:10:00"], folder=folder)
    number = slurm.submit(folder, "sweep.slurm")
    slurm.wait(lambda: slurm.job(f"{number}_1").get("JobState") == "RUNNING", "the first task", 200)
    slurm.wait(lambda: list(folder.glob("queued/cases/*/damage_history.csv")), "its history", 60)
    slurm.ask("scancel", "--batch", "--signal=USR1", f"{number}_1")
    ended = [slurm.end_of(f"{number}_{task}", 300) for task in (1, 2, 3, 4)]
    states, again = [job["JobState"] for job in ended], [int(job["Restarts"]) for job in ended]
    print(f"array: {', '.join(states)}, requeued {again} times")
    # scancel repeats the signal where Slurm requires it, so the task may be stopped twice.
    require(states == ["COMPLETED"] * 4 and again[0] >= 1 and not any(again[1:]), "Not only the first was requeued.")
    run([*sweep, "--output", "queued", "--program", implam, "--table"], folder=folder)
    require(table_of(folder / "queued") == table_of(folder / "plain"), "The table is not that without a queue.")


def main():
    """Start Slurm, run the jobs, end it."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # with an orderly end of Slurm's daemons
    implam, folder = os.path.abspath(sys.argv[1]), Path(sys.argv[2]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    deck = change_deck(DECK.read_text(encoding="utf-8"), ["output%directory='results'", "case%name='deck'",
                                                          "time%end=2.4e-3", "time%step=2e-6",
                                                          "output%checkpoint_every=0.6e-3"])
    (folder / "deck.nml").write_text(deck, encoding="utf-8")
    run([implam, folder / "deck.nml", "--output", folder / "whole"])
    expected = (folder / "whole/deck_history.csv").read_bytes()
    place = tempfile.mkdtemp(prefix="slurm")  # paths of sockets have to be short
    try:
        with Slurm(place) as slurm:
            # Slurm checks limits every half minute: the array runs between two checks.
            number = submit_chain(implam, slurm, folder)
            array(implam, slurm, folder / "array")
            check_chain(slurm, folder, number, expected)
    except MissingError as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    shutil.rmtree(place)
    return 0


if __name__ == "__main__":
    sys.exit(main())
