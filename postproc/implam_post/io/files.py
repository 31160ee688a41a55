"""Atomic replacement of files: a reader, or a stopped process, finds the old file or the new one."""

import fcntl
import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from implam_post.io.errors import FileError, reason

if TYPE_CHECKING:
    import pandas as pd

_NOT_IN_DECKS = re.compile(r"[\0-\b\v\f\x0e-\x1f\x7f]")


@contextmanager
def replaced(path: Path) -> Iterator[Path]:
    """Yield the path of a draft with the same suffix, which replaces `path` when it is complete.

    A device or a pipe is written itself.
    """
    if path.exists() and not path.is_file():
        try:
            yield path
        except OSError as error:
            raise FileError(f"{path} cannot be written ({reason(error)}).") from None
        return
    draft = path.with_name(f".draft_{path.name}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield draft
        with draft.open("rb") as file:
            os.fsync(file.fileno())
        draft.replace(path)
    except OSError as error:
        raise FileError(f"{path} cannot be written ({reason(error)}).") from None
    finally:
        with suppress(OSError):
            draft.unlink()  # of a failure; a complete one has its name


def write_text(path: Path, text: str) -> None:
    """Replace a file by one with this text."""
    with replaced(path) as draft:
        draft.write_text(text, encoding="utf-8")


def write_table(path: Path, table: "pd.DataFrame", float_format: str | None = None) -> None:
    """Replace a file by a table as CSV; numbers have all digits by default, missing values are empty cells."""
    write_text(path, table.to_csv(index=False, float_format=float_format, lineterminator="\n"))


def read_text(path: Path, what: str) -> str:
    """Return the text of a file; `what` names its kind in the error message."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise FileError(f"{what} {path} cannot be read ({reason(error)}).") from None
    except UnicodeDecodeError:
        raise FileError(f"{what} {path} cannot be read: it is not a text file.") from None


def text_of(data: bytes) -> str:
    """Return the text of a deck; one that is not UTF-8 is taken for Latin 1, as in the summary of its run."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def read_deck_text(path: Path) -> str:
    """Return the text of a deck, in the characters that the program reads."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise FileError(f"the deck {path} cannot be read ({reason(error)}).") from None
    text = text_of(data)
    if _NOT_IN_DECKS.search(text):
        raise FileError(f"the deck {path} cannot be read: it is not a text file.")
    return text.replace("\r\n", "\n")


def printable(name: str) -> str:
    """Return a file name for a line of text, with line ends and bytes that are not text replaced."""
    return "".join(letter if letter.isprintable() else "?" for letter in name)


def refuse_equal_names(paths: Sequence[Path], folder: Path | None) -> None:
    """Refuse results of equal names if their output goes into one folder, where one would overwrite the other."""
    first: dict[str, Path] = {}
    for path in paths if folder is not None else ():
        if (other := first.setdefault(path.name, path)) != path:
            raise FileError(f"{other} and {path} have the same name, so that the files of one would overwrite those of "
                            f"the other in {folder}: omit --output, or give it for each separately.")


def try_lock(path: Path) -> int | None:
    """Lock a file, which is created if missing; return its descriptor, or None if another process has locked it.

    All processes that inherit the descriptor share the lock; it ends with the last of them.
    """
    try:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError as error:
        raise FileError(f"{path} cannot be opened ({reason(error)}).") from None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        return None
    except OSError as error:
        os.close(descriptor)
        raise FileError(f"{path} cannot be locked ({reason(error)}).") from None
    return descriptor
