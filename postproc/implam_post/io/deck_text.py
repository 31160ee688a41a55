"""Change keys in the text of a deck; comments and all other text are kept."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from implam_post.io.counts import counted
from implam_post.io.errors import DeckError
from implam_post.io.namelist import Token, Value, is_key, read_namelist, read_tokens

_GROUP = re.compile(r"([A-Za-z]\w*)(?:\[(\d+|\*)\])?")
_PATH = re.compile(r"([A-Za-z]\w*)(?:\[(\d+|\*)\])?[.%]([A-Za-z]\w*)")


@dataclass(frozen=True)
class KeyPath:
    """A key of a group; `number` counts groups of the same name from 1; 0 is all of them, None the only one."""

    group: str
    number: int | None
    key: str

    def __str__(self) -> str:
        """Return the path in the notation of decks and commands."""
        number = "" if self.number is None else f"[{self.number or '*'}]"
        return f"{self.group}{number}.{self.key}"


@dataclass(frozen=True)
class _Span:
    """Position of a key: its name, and its values from the first to the last."""

    key: Token
    first: Token
    last: Token


@dataclass(frozen=True)
class _Place:
    """Position of a group: its first letter, its closing slash, and its keys by lower-case name."""

    name: str
    start: int
    end: Token
    keys: dict[str, _Span]


def key_path(text: str) -> KeyPath | None:
    """Return the path of a text group.key, group[2].key, group[*].key or group%key; None for any other text."""
    match = _PATH.fullmatch(text.strip())
    if match is None or match[2] == "0":
        return None
    number = None if match[2] is None else 0 if match[2] == "*" else int(match[2])
    return KeyPath(match[1].lower(), number, match[3])


def group_path(text: str) -> tuple[str, int | None] | None:
    """Return group and number of a text group, group[2] or group[*]; None for any other text."""
    match = _GROUP.fullmatch(text.strip())
    if match is None or match[2] == "0":
        return None
    return match[1].lower(), None if match[2] is None else 0 if match[2] == "*" else int(match[2])


def deck_value(value: object) -> str:
    """Return the text of a number, a logical, a text, or a list of them in a deck.

    Text that is already valid in a deck is kept (8*90, 'a', 'b', .true.); other text is put in quotes.
    """
    if isinstance(value, list):
        return ", ".join(deck_value(item) for item in value)
    if isinstance(value, bool):
        return ".true." if value else ".false."
    if isinstance(value, str):
        return value if not value or _reads_as_values(value) else "'" + value.replace("'", "''") + "'"
    if isinstance(value, int) or (isinstance(value, float) and math.isfinite(value)):
        return repr(value)
    raise DeckError(f"{value!r} is not a valid value in a deck.")


def set_keys(text: str, settings: Mapping[KeyPath, str], name: str = "deck") -> str:
    """Return the deck with changed keys; an empty value removes the key. A missing group is added at the end."""
    for path, value in settings.items():
        places = [place for place in _places(text, name) if place.name == path.group]
        if path.number is None and len(places) > 1:
            raise DeckError(f"{name}: there are {len(places)} groups &{path.group}: write {path.group}[1].{path.key}, "
                            f"or {path.group}[*].{path.key} for all.")
        number = 1 if path.number is None else path.number
        if number > len(places) + 1:
            raise DeckError(f"{name}: {path}: the deck has only {counted(len(places), 'group')} &{path.group}.")
        if number == len(places) + 1 or not places:
            text = text if not value else f"{text.rstrip()}\n&{path.group} {path.key}={value} /\n"
            continue
        for place in reversed(places if number == 0 else [places[number - 1]]):
            text = _set_key(text, place, path.key, value)
    return text


def drop_group(text: str, group: str, number: int | None, name: str = "deck") -> str:
    """Return the deck without a group, counted from 1 among those of its name, or without all of them."""
    places = [place for place in _places(text, name) if place.name == group]
    if not places or (number or 1) > len(places):
        raise DeckError(f"{name}: there are {len(places)} groups &{group}.")
    if number is None and len(places) > 1:
        raise DeckError(f"{name}: there are {len(places)} groups &{group}: write {group}[1], or {group}[*] for all.")
    for place in reversed([places[(number or 1) - 1]] if number != 0 else places):
        text = text[:place.start] + text[place.end.end:]
    return text


def copy_groups(source: str, text: str, groups: Sequence[str], name: str = "deck") -> str:
    """Return a deck whose groups of some names are those of another one."""
    for place in reversed([place for place in _places(text, name) if place.name in groups]):
        text = text[:place.start] + text[place.end.end:]
    copied = [source[place.start:place.end.end] for place in _places(source, name) if place.name in groups]
    return "\n".join([text.rstrip(), *copied]) + "\n"


def number_of(text: str, path: KeyPath, name: str = "deck") -> float:
    """Return the value of a key in a deck as a number."""
    groups = read_namelist(text, name).get(path.group, [])
    number = 1 if path.number is None else path.number
    if not 0 < number <= len(groups) or (path.number is None and len(groups) > 1):
        raise DeckError(f"{name}: {path}: there are {len(groups)} groups &{path.group}.")
    values: list[Value] = groups[number - 1].get(path.key.lower(), [])
    if len(values) != 1 or isinstance(values[0], (bool, str)):
        raise DeckError(f"{name}: {path} is not a single number in the deck.")
    return values[0]


def _reads_as_values(text: str) -> bool:
    """Return whether a text is valid in a deck after key=."""
    try:
        groups = read_namelist(f"&a b={text} /")
    except DeckError:
        return False
    return list(groups) == ["a"] and len(groups["a"]) == 1 and list(groups["a"][0]) == ["b"]


def _places(text: str, name: str) -> list[_Place]:
    """Return the positions of the groups of a deck and of their keys."""
    read_namelist(text, name)  # raises an error if the deck is wrong
    tokens, found, position = read_tokens(text, name), [], 0
    while position < len(tokens):
        group, start, keys = tokens[position].text[1:].strip().lower(), tokens[position].start, {}
        position += 1
        while tokens[position].kind != "end":
            first = position + 2
            last = first
            while tokens[last + 1].kind != "end" and not is_key(tokens, last + 1):
                last += 1
            keys[tokens[position].text.lower()] = _Span(tokens[position], tokens[first], tokens[last])
            position = last + 1
        found.append(_Place(group, start, tokens[position], keys))
        position += 1
    return found


def _set_key(text: str, place: _Place, key: str, value: str) -> str:
    """Set or remove a key in one group."""
    span = place.keys.get(key.lower())
    if span is None:
        return text if not value else f"{text[:place.end.start].rstrip(' ')}  {key}={value} {text[place.end.start:]}"
    if value:
        return text[:span.first.start] + value + text[span.last.end:]
    return text[:span.key.start] + re.sub(r"^\s*,", "", text[span.last.end:])
