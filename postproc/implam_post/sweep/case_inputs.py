"""Files that a deck reads, such as the checkpoint of &initial_state: a run with other contents is another case."""

import hashlib
from functools import cache
from pathlib import Path

from implam_post.io.errors import DeckError
from implam_post.io.namelist import read_namelist

_PART = 1 << 20  # bytes read at once


def inputs_of(text: str) -> dict[str, str]:
    """Return a hash of each file that a deck names by one of its values, relative to the current folder."""
    try:
        groups = read_namelist(text)
    except DeckError:
        return {}  # the check reports it
    words = {value for entries in groups.values() for group in entries for values in group.values()
             for value in values if isinstance(value, str)}
    return {word: found for word in sorted(words) if (found := _hash(word))}


def _hash(word: str) -> str:
    """Return the hash of a file; empty if there is none of this name."""
    try:
        path = Path(word)
        state = path.stat() if word.strip() and path.is_file() else None
        return _hash_of(str(path.absolute()), state.st_size, state.st_mtime_ns) if state else ""
    except (OSError, ValueError):
        return ""


@cache
def _hash_of(path: str, size: int, changed: int) -> str:
    """Return the hash of the contents of a file."""
    found = hashlib.sha256()
    with Path(path).open("rb") as file:
        while part := file.read(_PART):
            found.update(part)
    return found.hexdigest()[:16]
