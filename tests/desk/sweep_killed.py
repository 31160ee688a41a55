"""A sweep of 24 decks, six of each kind with random inputs, that is killed twice, once alone and once with all its
child processes, gives the table and the statistics of the same sweep without interruption.
Usage: sweep_killed.py IMPLAM FOLDER"""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "regress"))
from queue_chain import table_of
from solver_runs import require, run

DECK = HERE.parents[1] / "input/small/damage.nml"
CASES = 24
SWEEP = """deck = "swept.nml"
[scatter]
number = 6
[grid]
"delamination.G_c" = [300, 400]
"laminate.angles" = [[0, 90, 0], [90, 0, 90]]
"output.checkpoint_every" = [20e-6]
"""


def processes(folder):
    """Return the processes with the folder on their command lines."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = path.read_bytes()
        except OSError:
            continue
        if bytes(folder) in words and int(path.parent.name) != os.getpid():
            found.append(int(path.parent.name))
    return found


def kill(numbers):
    """Kill processes, suspended first so that none reacts to the end of another."""
    for stop in (signal.SIGSTOP, signal.SIGKILL):
        for number in numbers:
            try:
                os.kill(number, stop)
            except ProcessLookupError:
                continue


def ended(output):
    """Return the number of cases with a record."""
    return len(list(output.glob("cases/*/run.json")))


def main():
    """Run the sweep without interruption, then with kills."""
    implam, folder = os.path.abspath(sys.argv[1]), Path(sys.argv[2]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy(DECK, folder / "swept.nml")
    (folder / "sweep.toml").write_text(SWEEP, encoding="utf-8")
    words = [sys.executable, "-m", "implam_post.sweep", str(folder / "sweep.toml"), "--program", implam, "--jobs", "2"]
    run([*words, "--output", folder / "alone"])
    killed, moments = folder / "killed", random.Random(1)
    for smallest, everything in ((3, False), (12, True)):
        process = subprocess.Popen([*words, "--output", str(killed)], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while ended(killed) < smallest:
            require(process.poll() is None, "The sweep ended before it was killed.")
            time.sleep(0.01)
        time.sleep(moments.uniform(0, 0.2))
        kill(processes(killed) if everything else [process.pid])
        process.wait()
        print(f"killed {'with its runs' if everything else 'alone'} after {ended(killed)} of {CASES} cases")
        require(ended(killed) < CASES, "It was killed too late.")
    run([*words, "--output", killed])
    rows, expected = table_of(killed), table_of(folder / "alone")
    require(len(rows) == CASES and rows == expected, "The table is not that of the uninterrupted sweep.")
    printed = [(output / "statistics.csv").read_text(encoding="utf-8") for output in (killed, folder / "alone")]
    require(printed[0] == printed[1], "The statistics are not those of the uninterrupted sweep.")
    print(f"{CASES} cases: the same table and statistics")


if __name__ == "__main__":
    main()
