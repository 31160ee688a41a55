"""The case control of a Nastran file: the sets that its subcases select, and PARAM,WTMASS."""

import contextlib
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from implam_post.exchange.bulk_cards import with_exponent
from implam_post.io.errors import DeckError

_BLOCK = re.compile(r"\s*(SUBCASE|SYM|SUBCOM|SYMCOM|SUBSEQ|REPCASE|STEP)\s*[=\s]\s*(\d+)", re.I)
# Combinations of preceding subcases, and repeated output; they select no sets of their own.
_COMBINED = ("SUBCOM", "SYMCOM", "SUBSEQ", "REPCASE")
# Commands that select a set. TEMPERATURE without a word in brackets is LOAD and MATERIAL.
_COMMANDS = {"SPC": r"SPC", "TEMPERATURE(INITIAL)": r"TEMP[A-Z]*\s*\(\s*INIT[A-Z]*\s*\)",
             "TEMPERATURE(LOAD)": r"TEMP[A-Z]*\s*(?:\(\s*(?:LOAD|BOTH)\s*\))?"}
_NAMES = {"SPC": "support", "TEMPERATURE(INITIAL)": "initial temperature",
          "TEMPERATURE(LOAD)": "temperature"}
_PATTERNS = {name: re.compile(rf"\s*{pattern}\s*[=\s]\s*(\d+)$", re.I) for name, pattern in _COMMANDS.items()}


@dataclass
class _Block:
    """The commands from a line SUBCASE or STEP to the next one; those above the first subcase have the number 0."""

    word: str
    number: int
    line: int
    sets: dict[str, int] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """Words for messages."""
        return f"{self.word} {self.number} (line {self.line})" if self.number else "the case control"


class CaseControl:
    """The lines above BEGIN BULK. Commands above the first subcase are the defaults of all subcases."""

    def __init__(self, lines: Sequence[str], file: str, subcase: int | None = None) -> None:
        """Read the commands; `subcase` is the one to use, None for all."""
        self.file = file
        self._lines = [line.split("$")[0].rstrip() for line in lines]
        self.mass_factor = self._mass_factor()
        self._used, numbers = self._resolved(subcase)
        self._is_choice = len(numbers) > 1 and subcase is None
        if subcase is not None and subcase not in numbers:
            there = f"subcases {', '.join(map(str, numbers))}" if numbers else "no subcases"
            raise DeckError(f"{file}: there is no SUBCASE {subcase}, which --subcase gives; the file has {there}.")

    def selected(self, command: str) -> int | None:
        """Return the set that a command selects, None if it selects none; all subcases must select the same."""
        first = self._used[0]
        for other in self._used[1:]:
            if other.sets.get(command) != first.sets.get(command):
                one, two = (f"{f'set {each.sets[command]}' if command in each.sets else 'no set'} in {each.title}"
                            for each in (first, other))
                remedy = "choose one with --subcase" if self._is_choice else "give one case control without them"
                raise DeckError(f"{self.file}: {command} selects {one}, but {two}: {remedy}.")
        return first.sets.get(command)

    def _resolved(self, subcase: int | None) -> tuple[list[_Block], list[int]]:
        """Return the subcases, or their steps, with the defaults that apply to them, and all numbers of subcases."""
        common, *blocks = self._blocks()
        leaves: list[_Block] = []
        parent = common
        for block in blocks:
            if block.word in _COMBINED:
                continue
            if block.word != "STEP":
                parent = block
                block.sets = common.sets | block.sets
            elif leaves and leaves[-1] is parent:
                leaves.pop()
            if block.word == "STEP":
                block.sets = parent.sets | block.sets
            if subcase in (None, parent.number):
                leaves.append(block)
        return leaves or [common], [block.number for block in blocks if block.word not in ("STEP", *_COMBINED)]

    def _blocks(self) -> list[_Block]:
        """Return the blocks of the case control with the sets that each selects itself."""
        blocks = [_Block("", 0, 1)]
        for number, line in enumerate(self._lines, 1):
            if re.match(r"\s*INCLUDE\b", line, re.I):
                raise DeckError(f"{self.file}:{number}: INCLUDE in the case control is not supported: put all into one "
                                "file.")
            if match := _BLOCK.match(line):
                blocks.append(_Block(match[1].upper(), int(match[2]), number))
            for command, value in _selections(line):
                if blocks[-1].sets.setdefault(command, value) != value:
                    raise DeckError(f"{self.file}:{number}: {blocks[-1].title} selects the {_NAMES[command]} sets "
                                    f"{sorted((blocks[-1].sets[command], value))}: select one.")
        return blocks

    def _mass_factor(self) -> float:
        """Return WTMASS, 1 if it is not given; its notation is that of bulk data."""
        factor = 1.0
        for number, line in enumerate(self._lines, 1):
            if match := re.match(r"\s*PARAM[\s,]+WTMASS[\s,]*([^,]*)", line, re.I):
                factor = math.nan
                with contextlib.suppress(ValueError):
                    factor = float(with_exponent(match[1].strip()))
                if not (math.isfinite(factor) and factor > 0):
                    raise DeckError(f"{self.file}:{number}: PARAM,WTMASS,{match[1].strip()} in the case control needs "
                                    "a number greater than zero.")
        return factor


def _selections(line: str) -> Iterator[tuple[str, int]]:
    """Return command and set of a line that selects one."""
    for command, pattern in _PATTERNS.items():
        if match := pattern.match(line):
            yield command, int(match[1])
