"""Job scripts without a queue: their requests, and their calls of replacements for `scontrol` and `qsub`.
Usage: queue_scripts.py IMPLAM FOLDER"""

import os
import re
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "regress"))
from solver_runs import EXIT_STOPPED, change_deck, require, run

EXIT_USAGE, EXIT_DECK, EXIT_FILES = 1, 2, 4
DECK = HERE.parents[1] / "input/small/damage.nml"


def write_deck(folder, *settings):
    """Write the deck to a new folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    text = change_deck(DECK.read_text(encoding="utf-8"), ["case%name='deck'", "output%directory='results'", *settings])
    (folder / "deck.nml").write_text(text, encoding="utf-8")


def check_requests(implam, folder):
    """Ranks, memory and limits; nothing is overwritten; faults are reported."""
    write_deck(folder)
    run([implam, "queue", "slurm", "--time", "1:30:00"], folder=folder)  # the only deck of the folder
    script = (folder / "deck.slurm").read_text(encoding="utf-8")
    for line in ("--ntasks=1", "--time=1:30:00", "--signal=B:USR1@600", "--no-requeue"):
        require(line in script, f"The script does not request {line}.")
    run([implam, "queue", "slurm", "deck.nml"], EXIT_FILES, folder)
    require((folder / "deck.slurm").read_text(encoding="utf-8") == script, "The script was overwritten.")
    run([implam, "queue", "pbs", "deck.nml", "--ranks", "8"], folder=folder)
    script = (folder / "deck.pbs").read_text(encoding="utf-8")
    require("ncpus=8:mpiprocs=8" in script and "mpirun -n 8" in script, "The script does not request eight ranks.")
    for words, code in ((["lsf", "deck.nml"], EXIT_USAGE), (["slurm", "none.nml"], EXIT_FILES), ([], EXIT_USAGE),
                        (["slurm", "deck.nml", "--time", "90"], EXIT_USAGE),
                        (["slurm", "deck.nml", "--ranks", "0"], EXIT_USAGE), (["slurm", "array.txt"], EXIT_FILES)):
        run([implam, "queue", *words], code, folder)
    printed = run([implam, "queue", "slurm", "none.nml"], EXIT_FILES, folder)
    require("none.nml: there is no such file." in printed, printed)
    (folder / "deck.slurm").unlink()
    run([implam, "queue", "slurm", "deck.nml", "--output", "other folder"], folder=folder)
    script = (folder / "deck.slurm").read_text(encoding="utf-8")
    require("checkpoint='other folder/deck_restart.h5'" in script, "The script looks for another checkpoint.")
    require("'deck.nml' --output 'other folder')" in script, "The script has no --output.")
    print("requests: done")


def check_memory(implam, folder):
    """The estimate of memory is at least the peak of a run, and at most twice as large."""
    for settings in ([], ["mesh%elements=40,40"]):
        write_deck(folder, *settings, "time%end=50e-6")
        printed = run([implam, "check", folder / "deck.nml"])
        estimate = int(re.search(r"and (\d+) MB of memory", printed)[1])
        run([implam, folder / "deck.nml", "--output", folder])
        # Maximum over the child processes so far, of which this one is the largest.
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024 / 1e6
        print(f"memory: estimate {estimate} MB, peak {peak:.0f} MB")
        require(0.95 * peak < estimate < 2 * peak, "The estimate of memory is wrong.")


def play(folder, name, code):
    """Write a program that records its calls to folder/bin; return the environment that finds it."""
    (folder / "bin").mkdir(exist_ok=True)
    path = folder / "bin" / name
    path.write_text(f"#!/bin/bash\necho {name} \"$@\" >> {folder}/calls\n{code}\n", encoding="utf-8")
    path.chmod(0o755)
    return dict(os.environ, PATH=f"{folder}/bin:{os.environ['PATH']}")


def check_chain_of_pbs(implam, folder):
    """Each job ends before its limit and submits the next, the last one none; the history is that of an uninterrupted
    run."""
    write_deck(folder, "time%end=2e-3", "time%step=2e-6", "output%checkpoint_every=0.5e-3")
    run([implam, "deck.nml", "--output", "whole"], folder=folder)
    run([implam, "queue", "pbs", "deck.nml", "--chain"], folder=folder)
    # A limit of a few seconds, and a program that is suspended at each checkpoint: the limit is reached before the end.
    script = folder / "deck.pbs"
    script.write_text(re.sub(r"USR1 \d+", "USR1 4", script.read_text(encoding="utf-8")), encoding="utf-8")
    held = folder / "held"
    held.write_text(f'#!/bin/bash\nexec {HERE}/held.sh {folder}/results/deck_restart.h5 {implam} "$@"\n',
                    encoding="utf-8")
    held.chmod(0o755)
    environment = play(folder, "qsub", "true") | {"PBS_O_WORKDIR": str(folder), "IMPLAM": str(held)}
    parts = 0
    while True:
        environment["IMPLAM_PARTS"] = str(parts)
        code = subprocess.run(["bash", script], env=environment, timeout=120, check=False,
                              stdout=subprocess.DEVNULL).returncode
        calls = (folder / "calls").read_text(encoding="utf-8").splitlines() if (folder / "calls").exists() else []
        if code != EXIT_STOPPED:
            break
        parts += 1
        require(calls[-1] == f"qsub -v IMPLAM_PARTS={parts} deck.pbs", f"The job submits {calls[-1:]}.")
        require(parts < 60, "The chain does not end.")
    print(f"chain of PBS: {parts + 1} jobs")
    require(code == 0 and len(calls) == parts >= 1, f"The chain ends with {code} after {parts} jobs.")
    same = (folder / "results/deck_history.csv").read_bytes() == (folder / "whole/deck_history.csv").read_bytes()
    require(same, "The history of the chain is not that of the uninterrupted run.")


def check_signals(implam, folder):
    """A single job that is stopped forwards the signal and ends with 75; `restart` continues the run."""
    write_deck(folder, "time%end=20e-3")
    run([implam, "queue", "slurm", "deck.nml"], folder=folder)
    script = folder / "deck.slurm"
    job = subprocess.Popen(["bash", script], cwd=folder, stdout=subprocess.PIPE, text=True)
    while not (folder / "results/deck_history.csv").exists():
        require(job.poll() is None, "The job ended before its signal.")
        time.sleep(0.05)
    job.send_signal(10)
    said = job.communicate(timeout=60)[0]
    require(job.returncode == EXIT_STOPPED and "sbatch deck.slurm restart" in said,
            f"The job ends with {job.returncode}: {said}")
    rows = len((folder / "results/deck_history.csv").read_text(encoding="utf-8").splitlines())
    again = subprocess.run(["bash", script, "restart"], cwd=folder, stdout=subprocess.DEVNULL, timeout=120, check=False)
    ended = len((folder / "results/deck_history.csv").read_text(encoding="utf-8").splitlines())
    print(f"signals: {rows} rows, then {ended}")
    require(again.returncode == 0 and ended > rows, "The job does not continue.")


def main():
    """Check everything."""
    implam, folder = os.path.abspath(sys.argv[1]), Path(sys.argv[2]).resolve()
    check_memory(implam, folder / "memory")
    check_requests(implam, folder / "requests")
    check_signals(implam, folder / "signals")
    check_chain_of_pbs(implam, folder / "pbs")


if __name__ == "__main__":
    main()
