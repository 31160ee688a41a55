"""The program and decks for tests that run it: IMPLAM in the environment names it, else build/implam is taken."""

import contextlib
import io
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SMALL = ROOT / "input" / "small"


def implam() -> Path:
    """Return the path of the program; without it a test cannot pass."""
    path = Path(os.environ.get("IMPLAM") or ROOT / "build" / "implam").absolute()
    if not path.is_file():
        raise FileNotFoundError(f"{path} is not there: build implam, or name it by IMPLAM in the environment")
    return path


def surroundings() -> dict[str, str]:
    """Return an environment in which this package and the program are found."""
    return {**os.environ, "IMPLAM": str(implam()), "PYTHONPATH": str(ROOT / "postproc"), "PYTHONDONTWRITEBYTECODE": "1"}


def start(module: str, *arguments: object) -> subprocess.Popen:
    """Start a command of the package as a process of its own."""
    return subprocess.Popen([sys.executable, "-m", f"implam_post.{module}", *map(str, arguments)], env=surroundings(),
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def run(module: str, *arguments: object) -> tuple[int, str]:
    """Run a command of the package as a process of its own; return exit code and text."""
    with start(module, *arguments) as process:
        text, _ = process.communicate(timeout=240)
    return process.returncode, text


def run_quietly(command: Callable[[list[str]], int], *arguments: object) -> tuple[int, str]:
    """Run a command in this process; return exit code and text."""
    text = io.StringIO()
    with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
        try:
            code = command([str(argument) for argument in arguments])
        except SystemExit as end:
            code = end.code
    return code, text.getvalue()
