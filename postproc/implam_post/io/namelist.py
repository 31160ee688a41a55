"""Reader of the part of Fortran namelists that decks use.

It supports comments from `!` to the end of the line, strings in single or double quotes, repeat counts such as 8*90,
subscripts such as edges(2), and several groups of the same name. Names of groups and keys are lower-cased.
"""

import re
from dataclasses import dataclass

from implam_post.io.errors import DeckError

Value = float | bool | str
Group = dict[str, list[Value]]

_TOKEN = re.compile(
    r"""(?P<space>[\s,]+|![^\n]*)
      | (?P<string>'(?:[^'\n]|'')*'|"(?:[^"\n]|"")*")
      | (?P<group>&\s*\w+)
      | (?P<end>/)
      | (?P<equals>=)
      | (?P<repeat>\d+\*)
      | (?P<subscripted>[A-Za-z]\w*\s*\(\s*\d+\s*\))
      | (?P<word>[^\s,=/'"!&*()]+)""",
    re.VERBOSE,
)
_LOGICALS = {".true.": True, ".t.": True, "t": True, "true": True,
             ".false.": False, ".f.": False, "f": False, "false": False}


@dataclass(frozen=True)
class Token:
    """A token of a deck: its kind (a group name of the pattern), text, line and the position of its first letter."""

    kind: str
    text: str
    line: int
    start: int

    @property
    def end(self) -> int:
        """Return the position after its last letter."""
        return self.start + len(self.text)


def read_namelist(text: str, name: str = "deck") -> dict[str, list[Group]]:
    """Return for each name of groups in `text` the list of its groups; `name` is used in messages."""
    groups: dict[str, list[Group]] = {}
    tokens = read_tokens(text, name)
    position = 0
    while position < len(tokens):
        token = tokens[position]
        position += 1
        if token.kind != "group":
            raise DeckError(f"{name}:{token.line}: '{token.text}' is outside of a group.")
        group, position = _read_group(tokens, position, token, name)
        groups.setdefault(token.text[1:].strip().lower(), []).append(group)
    return groups


def read_tokens(text: str, name: str) -> list[Token]:
    """Split `text` into tokens, without blanks, commas and comments."""
    tokens = []
    position = 0
    line = 1
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise DeckError(f"{name}:{line}: cannot read {text[position:].splitlines()[0]!r}.")
        if match.lastgroup not in (None, "space"):
            tokens.append(Token(str(match.lastgroup), match.group(), line, position))
        line += match.group().count("\n")
        position = match.end()
    return tokens


def _read_group(tokens: list[Token], position: int, opening: Token, name: str) -> tuple[Group, int]:
    """Read keys and values up to the closing slash; return them and the position after it."""
    group: Group = {}
    while position < len(tokens):
        token = tokens[position]
        if token.kind == "end":
            return group, position + 1
        if not is_key(tokens, position):
            raise DeckError(f"{name}:{token.line}: {opening.text}: a key and '=' expected, found '{token.text}'.")
        values, position = _read_values(tokens, position + 2, name)
        _assign(group, token, values, name)
    raise DeckError(f"{name}:{opening.line}: {opening.text} has no closing '/'.")


def is_key(tokens: list[Token], position: int) -> bool:
    """Return whether there is a key at `position`: a name followed by an equals sign."""
    return (tokens[position].kind in ("word", "subscripted") and position + 1 < len(tokens)
            and tokens[position + 1].kind == "equals")


def _read_values(tokens: list[Token], position: int, name: str) -> tuple[list[Value], int]:
    """Read the values of one key; return them and the position after the last."""
    values: list[Value] = []
    while position < len(tokens) and not is_key(tokens, position):
        token = tokens[position]
        repeats = 1
        if token.kind == "repeat" and position + 1 < len(tokens):
            repeats = int(token.text[:-1])
            position += 1
            token = tokens[position]
        if token.kind not in ("string", "word"):
            if repeats > 1:
                raise DeckError(f"{name}:{token.line}: a repeat count without a value.")
            break
        values += repeats * [_value(token, name)]
        position += 1
    return values, position


def _value(token: Token, name: str) -> Value:
    """Return the value of a token."""
    if token.kind == "string":
        quote = token.text[0]
        return token.text[1:-1].replace(2 * quote, quote)
    if token.text.lower() in _LOGICALS:
        return _LOGICALS[token.text.lower()]
    try:
        return float(re.sub("[dD]", "e", token.text))
    except ValueError:
        raise DeckError(f"{name}:{token.line}: '{token.text}' is not a number, a logical or a string in quotes."
                        ) from None


def _assign(group: Group, key: Token, values: list[Value], name: str) -> None:
    """Store the values of a key, starting at its subscript if there is one."""
    if not values:
        raise DeckError(f"{name}:{key.line}: {key.text} has no value.")
    stem, _, subscript = key.text.lower().partition("(")
    stored = group.setdefault(stem.strip(), [])
    first = int(subscript.rstrip(") ")) - 1 if subscript else 0
    if first > len(stored) or (stored and not subscript):
        raise DeckError(f"{name}:{key.line}: {key.text} is given twice or leaves a gap.")
    stored[first:first + len(values)] = values
