"""One case of a sweep: runs its deck, or resumes it from its checkpoint, and records how the run ended.

A separate process supervises each run (`python -m implam_post.sweep.case_run FOLDER --program "implam"`), so that a
killed sweep or job loses no result. It imports few modules, as it is started for each case.
"""

import argparse
import itertools
import json
import os
import select
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from implam_post.io.errors import EXIT_DONE, EXIT_FILES, CommandParser, FileError, run
from implam_post.io.files import read_deck_text, read_text, try_lock, write_text
from implam_post.io.program import (
    EXIT_CONVERGENCE,
    EXIT_STOPPED,
    PROGRAM_HELP,
    checkpoint_in,
    environment,
    find_program,
    history_in,
    last_words,
    shell_code,
)
from implam_post.sweep.case_inputs import inputs_of

MODULE = "implam_post.sweep.case_run"
_RECORD, _LOCK, OUTPUT = "run.json", "lock", "output.txt"
# Exit codes of runs that would end in the same way if repeated.
FINAL = (EXIT_DONE, EXIT_CONVERGENCE)
_STOP_SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU)
_PAUSE = 0.05  # seconds between checks of the run
_STOPPING = f"stopped, continues from a checkpoint if there is one ({EXIT_STOPPED})"


@dataclass(frozen=True)
class Record:
    """Exit code of the last part of a run; times are totals of all parts, in seconds.

    `inputs` are hashes of the files that the deck reads, at the start of the run; None: not known.
    """

    exit_code: int
    cpu_time: float = 0.0
    wall_time: float = 0.0
    parts: int = 0
    inputs: dict[str, str] | None = None

    @property
    def final(self) -> bool:
        """Whether a repeated run would end in the same way."""
        return self.exit_code in FINAL


def read_record(folder: Path) -> Record | None:
    """Return the record of a case; None if no part of its run has ended, or if its results are missing."""
    path = folder / _RECORD
    if not path.exists():
        return None
    try:
        record = Record(**json.loads(read_text(path, "the record")))
        numbers = (record.exit_code, record.cpu_time, record.wall_time, record.parts)
        if not all(isinstance(value, (int, float)) for value in numbers) or not isinstance(
                record.inputs, (dict, type(None))):
            raise ValueError
    except (ValueError, TypeError, RecursionError):
        raise FileError(f"the record {path} is damaged: delete it to run the case again.") from None
    return None if record.exit_code == EXIT_DONE and _is_lost(folder) else record


def _is_lost(folder: Path) -> bool:
    """Return whether the history of a completed run is missing, empty, or has no row."""
    path = history_in(folder)
    if path is None:
        return True
    lines = (line for line in read_text(path, "the history").splitlines() if line.strip() and line[0] != "#")
    return sum(1 for _ in itertools.islice(lines, 2)) < 2


def changed_input(folder: Path, text: str) -> str:
    """Return a file that the deck of a case reads and that has changed since its run; empty if there is none."""
    record = read_record(folder)
    if record is None:
        return ""
    now = inputs_of(text)
    if record.inputs is None:  # by an earlier version
        ended = (folder / _RECORD).stat().st_mtime
        return next((name for name in now if Path(name).stat().st_mtime > ended), "")
    return next((name for name in now.keys() | record.inputs.keys() if now.get(name) != record.inputs.get(name)), "")


def remove_failed(folder: Path) -> None:
    """Remove record and checkpoint of a failed case that is not running, so that it starts again."""
    record = read_record(folder)
    if record is not None and record.exit_code != EXIT_DONE:
        remove_results(folder)


def remove_results(folder: Path) -> None:
    """Remove record and checkpoint of a case that is not running, so that it starts again."""
    lock = try_lock(folder / _LOCK)
    if lock is not None:
        (folder / _RECORD).unlink(missing_ok=True)
        drop_checkpoint(folder)
        os.close(lock)


def drop_checkpoint(folder: Path) -> None:
    """Remove the checkpoint of a case, if there is one."""
    path = checkpoint_in(folder)
    if path is not None:
        path.unlink(missing_ok=True)


def case_command(folder: Path, program: Sequence[str]) -> list[str]:
    """Return the command that runs a case."""
    return [sys.executable, "-m", MODULE, str(folder.absolute()), "--program", shlex.join(program)]


class _Stop:
    """True once the run is to stop: by a signal, or because the sweep that started it has ended."""

    def __init__(self, lifeline: int | None) -> None:
        """Catch the signals; `lifeline` is a pipe that closes when the sweep ends."""
        self._lifeline, self._caught = lifeline, False
        for number in _STOP_SIGNALS:
            signal.signal(number, self._catch)

    def __bool__(self) -> bool:
        """Return whether to stop."""
        if self._lifeline is not None and select.select([self._lifeline], [], [], 0)[0]:
            self._caught = True
        return self._caught

    def _catch(self, *_: object) -> None:
        self._caught = True


def run_case(folder: Path, deck: Path, program: Sequence[str], stop: _Stop) -> int:
    """Run a case to its end, unless it has already ended; return the exit code of the program."""
    while (lock := try_lock(folder / _LOCK)) is None:
        if stop:
            return EXIT_STOPPED
        time.sleep(_PAUSE)
    try:
        record = read_record(folder)
        if record is None and (folder / _RECORD).exists():
            drop_checkpoint(folder)  # the history of the run is missing: it has to begin at the start
        record = record or Record(EXIT_STOPPED, inputs=inputs_of(read_deck_text(deck)))
        while not record.final and not stop:
            checkpoint = checkpoint_in(folder)
            record = _run_part(folder, deck if checkpoint is None else checkpoint, program, stop, lock, record)
            write_text(folder / _RECORD, json.dumps(asdict(record)) + "\n")
            if checkpoint is None or record.exit_code != EXIT_FILES or not _is_useless(checkpoint, folder):
                break
            checkpoint.unlink(missing_ok=True)  # the run starts again
        return record.exit_code
    finally:
        os.close(lock)


def _run_part(folder: Path, start: Path, program: Sequence[str], stop: _Stop, lock: int, before: Record) -> Record:
    """Run from a deck or a checkpoint until the program ends; return the record of all parts."""
    from_deck = start.suffix == ".nml"
    words = ["run", str(start), "--output", str(folder)] if from_deck else ["restart", str(start)]
    began, cpu_before = time.monotonic(), _children_time()
    with (folder / OUTPUT).open("wb" if from_deck else "ab") as output:
        # The program inherits the lock: as long as it is running, no other process runs this case.
        process = subprocess.Popen([*program, *words], stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=subprocess.STDOUT, pass_fds=[lock], env=environment())
        signalled = False
        while (code := process.poll()) is None:
            if stop and not signalled:
                process.send_signal(signal.SIGUSR1)  # mpirun forwards this signal, and ends at others
                signalled = True
            time.sleep(_PAUSE)
    if signalled and code == -signal.SIGUSR1:  # while it was being loaded: the program itself holds the signal back
        code = EXIT_STOPPED
    return Record(shell_code(code), before.cpu_time + _children_time() - cpu_before,
                  before.wall_time + time.monotonic() - began, before.parts + 1, before.inputs)


def _is_useless(checkpoint: Path, folder: Path) -> bool:
    """Return whether a restart failed because its checkpoint cannot be read, not because a file cannot be written."""
    printed = last_words(read_text(folder / OUTPUT, "the output"))
    return checkpoint.name in printed and not printed.startswith(("Cannot write", "Cannot complete"))


def _children_time() -> float:
    """Return the processor time of all children that have ended."""
    times = os.times()
    return times.children_user + times.children_system


def _command(options: argparse.Namespace) -> int:
    """Run the case."""
    decks = sorted(options.folder.glob("*.nml"))
    if len(decks) != 1:
        raise FileError(f"{options.folder} is not the folder of a case with one deck.")
    stop = _Stop(options.lifeline)
    code = run_case(options.folder, decks[0], find_program(options.program), stop)
    print(f"{decks[0]}: {_STOPPING if code == EXIT_STOPPED else f'ended with {code}'}")
    return code


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; its exit code is that of the program."""
    parser = CommandParser(f"python -m {MODULE}", description="Run one case of a sweep, unless its run has already "
                           "ended, or continue from its checkpoint.")
    parser.add_argument("folder", type=Path, metavar="FOLDER", help="folder of the case, with its deck")
    parser.add_argument("--program", metavar="WORDS", help=PROGRAM_HELP)
    parser.add_argument("--lifeline", type=int, help=argparse.SUPPRESS)
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
