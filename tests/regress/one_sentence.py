"""Manual: a run that fails ends with the documented exit code and one sentence on the error output.
Usage: one_sentence.py IMPLAM FOLDER"""

import signal
import subprocess
import sys
import time
from pathlib import Path

from solver_runs import EXIT_FILES, require, run, run_deck, write_deck

DECK = "../small/ply_damage.nml"


def say(command, expected):
    """Run a command that is to fail and compare its exit code and its sentence with the expected ones."""
    ended = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                           stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    lines = ended.stderr.splitlines()
    require(ended.returncode == expected, f"{command} ended with {ended.returncode}, not {expected}: {lines}")
    require(len(lines) == 1 and lines[0].startswith("implam: ") and lines[0].endswith((".", "?")),
            f"{command} did not end with one sentence: {lines}")
    print(lines[0])
    return lines[0]


def contents(folder):
    """Return the files of a folder with their contents."""
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def check_reasons(implam, folder):
    """A file that cannot be written, a checkpoint that cannot be read, and an unknown material: the reason is given."""
    deck = write_deck(folder, DECK)
    (folder / "ply_damage.log").mkdir()
    for command, code, words in (
            ([implam, deck, "--output", folder], EXIT_FILES, f"the log {folder / 'ply_damage.log'}: is a directory."),
            ([implam, "restart", folder / "none_restart.h5"], EXIT_FILES, "there is no such file."),
            ([implam, deck, "--output", deck], EXIT_FILES, "a file has this name."),
            ([implam, "explain", "materials", "im9"], 1, "the materials are t700_m21, ")):
        require(words in say(command, code), f"{command} does not give the reason.")
    (folder / "ply_damage.log").rmdir()
    shown = run([implam, "explain", "materials", "IM7"])
    require("im7_8552" in shown and "t700" not in shown and "Camanho" in shown and "Rivallant" not in shown, shown)
    require("check DECK.nml" in run([implam, "help", "check"]), "help check does not explain the command.")


def check_one_writer(implam, folder):
    """A second run of the same case is refused before it changes a file; a killed run leaves no lock behind."""
    deck = write_deck(folder, DECK, ["output%checkpoint_every=10e-6"])
    run_deck(implam, deck)
    checkpoint = folder / "ply_damage_restart.h5"
    settings = ["time%end=1", "time%step=1e-6", "output%history_every=1"]
    long_deck = write_deck(folder.with_name("writer_of_long"), DECK, settings)
    log = folder / "ply_damage.log"
    before = log.read_bytes()
    with subprocess.Popen([implam, str(long_deck), "--output", str(folder)], stdout=subprocess.DEVNULL) as first:
        try:
            deadline = time.monotonic() + 60
            while (log.read_bytes() == before or b"Model: " not in log.read_bytes()) and time.monotonic() < deadline:
                time.sleep(0.05)
            first.send_signal(signal.SIGSTOP)
            held = contents(folder)
            say([implam, deck, "--output", folder], EXIT_FILES)
            say([implam, "restart", checkpoint], EXIT_FILES)
            require(contents(folder) == held, "A refused run has changed the files of the other one.")
        finally:
            first.kill()
    run_deck(implam, deck)


def check_invalid_files(implam, folder):
    """A field file or checkpoint that can be neither written nor closed: exit code and one sentence, no crash."""
    for name, named in (("ply_damage.h5", "ply_damage.h5"), ("ply_damage_restart.h5.tmp", "ply_damage_restart.h5")):
        deck = write_deck(folder, DECK, ["output%checkpoint_every=10e-6"])
        (folder / name).symlink_to("/dev/full")
        summary = folder / "ply_damage_summary.json"
        summary.write_text('"kind": "done"', encoding="utf-8")
        ended = subprocess.run([implam, deck, "--output", folder], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True, timeout=60, check=False)
        require(ended.returncode == EXIT_FILES, f"A full {name} ended with {ended.returncode}: {ended.stderr}")
        printed = [line for line in ended.stderr.splitlines() if line.startswith("implam: ")]
        require(len(printed) == 1 and named in printed[0], f"A full {name} printed {printed}.")
        require((folder / "ply_damage_history.csv").stat().st_size > 0, "The history was lost.")
        require(not summary.exists() or '"kind": "failed"' in summary.read_text(encoding="utf-8"),
                "Beside the new history is the summary of an earlier run.")


def check_removed_history(implam, folder):
    """A history that is removed during a run ends the run at the next checkpoint with a message."""
    deck = write_deck(folder, DECK, ["time%end=1", "time%step=1e-6", "output%history_every=1e-5",
                                     "output%checkpoint_every=1e-5"])
    history = folder / "ply_damage_history.csv"
    with subprocess.Popen([implam, str(deck), "--output", str(folder)], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as process:
        try:
            deadline = time.monotonic() + 60
            while not history.exists() and time.monotonic() < deadline:
                time.sleep(0.05)
            history.unlink()
            printed = process.communicate(timeout=60)[1]
        finally:
            process.kill()
    require(process.returncode == EXIT_FILES and "history" in printed and "removed" in printed,
            f"It ended with {process.returncode}: {printed}")


def check_limit_load(implam, folder):
    """A force beyond that at which an interface separates: the sentence names the key by which its growth can be
    computed."""
    deck = write_deck(folder, "enf.nml", ["mesh%elements=28,2", "static%steps=5"])
    text = deck.read_text(encoding="utf-8").replace("displacement=4e-3", "force=2e3").replace("dissipation=0.2", "")
    deck.write_text(text, encoding="utf-8")
    printed = run([implam, deck, "--output", folder], expected=3)
    require("no equilibrium at this load: use &static dissipation to trace its growth." in printed, printed)


def main(implam, folder):
    """Test all failures."""
    folder = Path(folder)
    deck = write_deck(folder, DECK)
    say([implam], 1)
    say([implam, deck, "--output"], 1)
    say([implam, deck, "--output", ""], 1)
    for seconds in ([], [""], ["0"], ["-5"], ["1h"], ["1e999"], ["nan"]):
        say([implam, deck, "--output", folder, "--wall-limit", *seconds], 1)
    say([implam, deck, "--output", deck], 4)
    blocked = folder / "blocked"
    (blocked / "ply_damage_history.csv").mkdir(parents=True)
    say([implam, deck, "--output", blocked], 4)
    say([implam, "restart", deck], 4)
    deck = write_deck(folder / "hard", DECK, ["solver%max_iterations=1", "solver%tolerance=1e-13"])
    say([implam, deck, "--output", deck.parent], 3)
    error = [line for line in (deck.parent / "ply_damage.log").read_text(encoding="utf-8").splitlines()
             if "error: " in line]
    require(len(error) == 1, f"The log holds the sentence {len(error)} times.")
    check_limit_load(implam, folder / "limit")
    check_reasons(implam, folder / "reasons")
    check_one_writer(implam, folder / "writer")
    check_invalid_files(implam, folder / "invalid")
    check_removed_history(implam, folder / "removed")


if __name__ == "__main__":
    main(*sys.argv[1:])
