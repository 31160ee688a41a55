"""Program and decks for tests that run it: the environment variable IMPLAM, by default build/implam."""

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
    """Return the path of the program; raise an error if it does not exist."""
    path = Path(os.environ.get("IMPLAM") or ROOT / "build" / "implam").absolute()
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist: build implam, or set the environment variable IMPLAM")
    return path


def surroundings() -> dict[str, str]:
    """Return an environment with this package and the program."""
    return {**os.environ, "IMPLAM": str(implam()), "PYTHONPATH": str(ROOT / "postproc"), "PYTHONDONTWRITEBYTECODE": "1"}


def start(module: str, *arguments: object) -> subprocess.Popen:
    """Start a command of the package in another process."""
    return subprocess.Popen([sys.executable, "-m", f"implam_post.{module}", *map(str, arguments)], env=surroundings(),
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def run(module: str, *arguments: object) -> tuple[int, str]:
    """Run a command of the package in another process; return exit code and text."""
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
