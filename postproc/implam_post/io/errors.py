"""Errors reported to the user in one sentence, and the exit codes they lead to (those of the solver)."""

import argparse
import io
import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Never

EXIT_DONE, EXIT_USAGE, EXIT_DECK, EXIT_FILES, EXIT_INTERRUPTED = 0, 1, 2, 4, 130


class ImplamError(Exception):
    """An error whose text is one sentence."""

    exit_code = EXIT_USAGE


class DeckError(ImplamError):
    """The deck cannot be read, or is outside the scope of the semi-analytic solution."""

    exit_code = EXIT_DECK


class FileError(ImplamError):
    """A file is missing, damaged or of another kind."""

    exit_code = EXIT_FILES


def reason(error: Exception) -> str:
    """Return the reason of an error; errors of the operating system without number and path."""
    return error.strerror.lower() if isinstance(error, OSError) and error.strerror else str(error)


class CommandParser(argparse.ArgumentParser):
    """Parser of a command line; wrong usage ends with the same exit code as in the solver."""

    def error(self, message: str) -> Never:
        """Print the message and exit."""
        self.print_usage(sys.stderr)
        self.exit(EXIT_USAGE, f"{self.prog}: {message}\n")


def count(text: str) -> int:
    """Return an argument as an integer greater than zero."""
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} is not greater than zero")
    return number


def finite(text: str) -> float:
    """Return an argument as a finite number."""
    number = float(text)
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"{text} is not a finite number")
    return number


def positive(text: str) -> float:
    """Return an argument as a finite number greater than zero."""
    number = float(text)
    if not (math.isfinite(number) and number > 0):
        raise argparse.ArgumentTypeError(f"{text} is not a number greater than zero")
    return number


def _named(value: object) -> object:
    """Return a path such as `.` with the name of its folder, so that names of files beside it can be formed."""
    if isinstance(value, list):
        return [_named(item) for item in value]
    return value.resolve() if isinstance(value, Path) and not value.name else value


def run(command: Callable[[argparse.Namespace], int], parser: CommandParser, arguments: Sequence[str] | None) -> int:
    """Run `command` with the parsed `arguments` and return the exit code; errors are printed as one sentence."""
    options = parser.parse_args(arguments)
    vars(options).update({name: _named(value) for name, value in vars(options).items()})
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # file names with bytes that are not text
    try:
        return command(options)
    except ImplamError as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED
