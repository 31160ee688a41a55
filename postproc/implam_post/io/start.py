"""Run a deck with changed keys in another process."""

import signal
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from implam_post.io.deck import read_deck
from implam_post.io.deck_text import KeyPath, deck_value, key_path, set_keys
from implam_post.io.errors import EXIT_DONE, DeckError, FileError, ImplamError, reason
from implam_post.io.files import read_deck_text, write_text
from implam_post.io.program import environment, find_program, last_words, shell_code

if TYPE_CHECKING:
    from implam_post.io.run import Run

OUTPUT = "output.txt"


class RunError(ImplamError):
    """A run ended with another exit code than 0; `exit_code` is that of the program."""


class StartedRun:
    """A run in a separate process; its output is written to output.txt in the folder of the results."""

    def __init__(self, folder: Path, process: subprocess.Popen[bytes], deck: Path) -> None:
        """Store the process, its deck and the folder of its results."""
        self.folder, self.process, self._deck = folder, process, deck

    @property
    def is_running(self) -> bool:
        """Whether the run has not ended yet."""
        return self.process.poll() is None

    def wait(self, timeout: float | None = None) -> "Run":
        """Wait for the end of the run and return its results.

        A run that ends with another exit code than 0 raises RunError. After `timeout` seconds TimeoutError is raised,
        and the run continues.
        """
        from implam_post.io.run import SUMMARY, open_run

        try:
            code = shell_code(self.process.wait(timeout))
        except subprocess.TimeoutExpired:
            raise TimeoutError(f"the run took longer than {timeout:g} s.") from None
        if code != EXIT_DONE:
            printed = (self.folder / OUTPUT).read_text(encoding="utf-8", errors="replace")
            error = RunError(f"the run ended with {code}: {last_words(printed)}")
            error.exit_code = code
            raise error
        # By name, as the folder may contain other runs.
        return open_run(self.folder / f"{read_deck(self._deck).name}{SUMMARY}")

    def stop(self) -> None:
        """Stop the run after the current step, with a checkpoint; `wait` then raises RunError with exit code 75."""
        self.process.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """End the run immediately, without a checkpoint."""
        self.process.kill()
        self.process.wait()


def run_deck(deck: Path | str, changes: Mapping[str | KeyPath, object] | None = None, output: Path | str | None = None,
             program: str | Sequence[str] | None = None, deck_name: str | None = None) -> StartedRun:
    """Start a run of a deck and return at once.

    `changes` has values by key, {"mesh%cell": 1e-3, "delamination[2]%G_c": 400.0, "laminate%angles": [0, 90, 0]};
    None removes a key. The changed deck, under its own name unless `deck_name` gives another, and all results are
    written to the folder `output`, by default one with the name of the deck next to it. `program` is the command that
    starts implam, such as "mpirun -n 2 build/implam"; by default the environment variable IMPLAM, else implam on the
    PATH.
    """
    path = Path(deck)
    folder = Path(output) if output is not None else path.with_suffix("")
    words = find_program(program) if program is None or isinstance(program, str) else list(program)
    settings = {_key(name): "" if value is None else deck_value(_plain(value))
                for name, value in (changes or {}).items()}
    written = folder / (deck_name or path.name)
    text = set_keys(read_deck_text(path), settings, path.name)
    if written.exists() and written.samefile(path):
        raise FileError(f"{folder} is the folder of the deck itself: give another one for the results.")
    write_text(written, text)
    try:
        with (folder / OUTPUT).open("wb") as printed:
            process = subprocess.Popen([*words, "run", str(written), "--output", str(folder)], env=environment(),
                                       stdin=subprocess.DEVNULL, stdout=printed, stderr=subprocess.STDOUT)
    except OSError as error:
        raise FileError(f"the run cannot be started ({reason(error)}).") from None
    return StartedRun(folder, process, written)


def _key(name: str | KeyPath) -> KeyPath:
    """Return the key of a name."""
    path = name if isinstance(name, KeyPath) else key_path(name)
    if path is None:
        raise DeckError(f"'{name}' is not a key of a deck, such as group%key or group[2]%key.")
    return path


def _plain(value: object) -> object:
    """Return a value in built-in types of Python; it may be a number or array of numpy, or a tuple."""
    value = value.tolist() if hasattr(value, "tolist") else value
    return [_plain(item) for item in value] if isinstance(value, (list, tuple)) else value
