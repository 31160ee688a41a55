"""What folders, pipes and launchers around a run must not do to it.
Usage: surroundings.py IMPLAM FOLDER LAUNCHER...     (LAUNCHER takes the number of ranks as its last word)"""

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from restart import exit_code, ranks_of, start, wait_until
from solver_runs import EXIT_DONE, EXIT_FILES, read_history, require, run, run_deck, write_deck

DECK = "../small/ply_damage.nml"
ENDINGS = (".log", "_history.csv", ".h5", ".xdmf", "_summary.json", "_restart.h5")
RESULTS = {f"ply_damage{ending}" for ending in ENDINGS} | {"deck.nml"}
OFTEN = ["output%fields_every=10e-6", "output%checkpoint_every=10e-6"]


def strangers(folder):
    """Return the files in a folder that are no results."""
    return {path.name for path in folder.iterdir()} - RESULTS


def check_long_folder(implam, folder):
    """A folder whose path has more letters than Open MPI's names of locks have room for."""
    deep = folder.joinpath(*["long" * 15] * 4)
    deck = write_deck(deep, DECK, [*OFTEN, "time%end=40e-6"])
    run_deck(implam, deck)
    require(not strangers(deep), f"The folder holds {sorted(strangers(deep))}.")
    print(f"{len(str(deep))} letters: done")


def check_kills(implam, folder, launcher):
    """Killed with files open on two ranks: what is left then is gone in the end."""
    deck = write_deck(folder, DECK, [*OFTEN, "mesh%elements=10,10", "time%end=480e-6"])
    words = [deck, "--output", folder]
    seen = set()
    for _ in range(3):
        process = start(*launcher, "2", implam, *words)
        wait_until(lambda: (folder / "ply_damage_restart.h5").exists() and any(
            name.endswith(".lock") or ".data." in name for name in strangers(folder)), process)
        for stop in (signal.SIGSTOP, signal.SIGKILL):
            for rank in ranks_of(process, implam):
                os.kill(rank, stop)
            seen |= strangers(folder)
        exit_code(process)
        words = ["restart", folder / "ply_damage_restart.h5"]
    print(f"Killed with {sorted(seen)}")
    run([*launcher, "2", implam, *words])
    require(not strangers(folder), f"Killed runs have left {sorted(strangers(folder))}.")


def check_pipes(implam, folder):
    """A pipe in the place of a result is refused, since to open it is to wait for a reader."""
    for name in ("ply_damage.log", "ply_damage_history.csv", "ply_damage.h5", "ply_damage.xdmf.tmp",
                 "ply_damage_restart.h5.tmp"):
        deck = write_deck(folder, DECK, OFTEN)
        os.mkfifo(folder / name)
        ended = subprocess.run([implam, deck, "--output", folder], stdin=subprocess.DEVNULL, capture_output=True,
                               text=True, timeout=30, check=False)
        told = ended.stderr.splitlines()
        require(ended.returncode == EXIT_FILES and len(told) == 1 and name in told[0] and "pipe" in told[0],
                f"A pipe {name} ended with {ended.returncode}: {told}")
        print(told[0])
    os.mkfifo(folder / "some_restart.h5")
    print(run([implam, "restart", folder / "some_restart.h5"], EXIT_FILES).strip())


def check_progress(implam, folder, launcher):
    """A launcher gives ranks a terminal of its own; what goes to a file has lines, none overwritten."""
    deck = write_deck(folder, DECK)
    ended = subprocess.run([str(word) for word in (*launcher, "2", implam, deck, "--output", folder)],
                           stdin=subprocess.DEVNULL, capture_output=True, timeout=120, check=False)
    require(ended.returncode == EXIT_DONE, f"The run ended with {ended.returncode}.")
    # The launcher's terminal ends lines with both.
    bars = ended.stdout.replace(b"\r\n", b"\n").count(b"\r")
    require(bars == 0, f"{bars} lines were overwritten.")
    require(len(read_history(folder / "ply_damage_history.csv")["time"]) > 10, "The run was too short for a bar.")


def main(implam, folder, *launcher):
    """Run all of them."""
    implam, folder = os.path.abspath(implam), Path(folder).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    check_long_folder(implam, folder / "deep")
    check_pipes(implam, folder / "pipes")
    check_progress(implam, folder / "progress", launcher)
    check_kills(implam, folder / "killed", launcher)


if __name__ == "__main__":
    main(*sys.argv[1:])
