"""The program implam: its path, exit codes and environment."""

import os
import shlex
import shutil
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from implam_post.io.errors import FileError, reason

EXIT_CONVERGENCE, EXIT_STOPPED = 3, 75
PROGRAM_HELP = ("command that starts implam, such as \"mpirun -n 2 build/implam\" (default: environment variable "
                "IMPLAM, else implam on the PATH)")
_WAITING = 60.0  # time limit of a check of a deck, seconds


def find_program(words: str | None) -> list[str]:
    """Return the command that starts the program, with absolute paths; `words` is that of the user, if given."""
    chosen = shlex.split(words or os.environ.get("IMPLAM") or "implam")
    for position in dict.fromkeys((0, len(chosen) - 1)):
        found = shutil.which(chosen[position]) if chosen else None
        if found is None:
            raise FileError(f"the program '{shlex.join(chosen)}' was not found: give it with --program or IMPLAM in "
                            "the environment, or put implam on the PATH.")
        chosen[position] = str(Path(found).absolute())
    return chosen


def environment() -> dict[str, str]:
    """Return the environment for simultaneous runs: one thread each, not bound to cores."""
    return {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
            "PRTE_MCA_hwloc_default_binding_policy": "none", **os.environ}


def processors() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def check_deck(program: Sequence[str], deck: Path) -> tuple[bool, list[str]]:
    """Check a deck with the program; return whether it can be run, and what the program printed."""
    try:
        # Without mpirun: a check needs one process.
        ended = subprocess.run([program[-1], "check", str(deck)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, errors="replace", timeout=_WAITING, check=False,
                               env=environment())
    except (OSError, subprocess.TimeoutExpired) as error:
        raise FileError(f"the program {program[-1]} cannot check a deck ({reason(error)}).") from None
    printed = [line for line in ended.stdout.splitlines() if line.strip() and not line.endswith(": no errors.")]
    return ended.returncode == 0, printed


@cache
def _version_of(program: str) -> str:
    """Return the version of a program and its commit; empty if it does not print them."""
    try:
        ended = subprocess.run([program, "--version"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True, errors="replace", timeout=_WAITING, check=False,
                               env=environment())
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return _version_among(ended.stdout.splitlines()[:1])


def version_of(program: Sequence[str]) -> str:
    """Return version and commit of the program; empty if they are not known."""
    return _version_of(program[-1])


def _version_among(lines: Sequence[str]) -> str:
    """Return the version in the last line that names it; empty if there is none."""
    found = [line for line in lines if line.startswith("Implam ")]
    return found[-1].split(",")[0].removeprefix("Implam ") if found else ""


def shell_code(code: int) -> int:
    """Return an exit code as in a shell: 128 plus the signal number for a process ended by a signal."""
    return 128 - code if code < 0 else code


def last_words(output: str) -> str:
    """Return the final message of a run, or its last line; a warning only if there is no other line."""
    printed = [line.strip() for line in output.splitlines() if line.strip()]
    lines = [line for line in printed if ": warning: " not in line] or printed
    sentences = [line.removeprefix("implam: ") for line in lines if line.startswith("implam: ")]
    return (sentences or lines or ["it printed nothing"])[-1]


def history_in(folder: Path) -> Path | None:
    """Return the history of the run in a folder."""
    return next(iter(sorted(folder.glob("*_history.csv"))), None)


def checkpoint_in(folder: Path) -> Path | None:
    """Return the checkpoint of the run in a folder."""
    return next(iter(sorted(folder.glob("*_restart.h5"))), None)


def version_in(folder: Path) -> str:
    """Return the version that wrote the results, from the last line in the log that names it."""
    for path in sorted(folder.glob("*.log"))[:1]:
        return _version_among(path.read_text(encoding="utf-8", errors="replace").splitlines())
    return ""
