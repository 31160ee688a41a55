"""What a sweep is made of: the cases that its file asks for, each with its deck."""

import hashlib
import itertools
import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from implam_post.deck_text import KeyPath, deck_value, key_path, number_of, set_keys
from implam_post.errors import DeckError
from implam_post.expressions import CONSTANTS, FUNCTIONS, evaluate
from implam_post.files import read_text
from implam_post.samples import METHODS, draw
from implam_post.units import SYSTEMS

FORMAT = """
The file of a sweep:

    deck = "peanut.nml"                       # the deck all cases start from, beside this file
    output = "results"                        # folder of the cases and the table; default: the name of this file
    units = "SI"                              # of the plots: SI, mm-t-s, mm-kg-ms, mm-mN-kg-s; default: the deck's

    [grid]                                    # every combination, the last key changes fastest
    "laminate.angles" = [[0, 90, 0], "3*0"]   # a list in the list, or text as it stands in a deck
    energy = [1.0, 2.0]                       # a name without a group is there for [derived]

    [list]                                    # side by side: first with first, second with second
    "material[1].E1" = [120e9, 139e9]         # [1] counts the groups of one name, [*] means all of them
    "delamination[*].G_c" = [400, ""]         # "" leaves the key out

    [samples]                                 # at random
    number = 20
    seed = 1                                  # default 1
    method = "random"                         # or "latin_hypercube"
    "material[*].E2" = { distribution = "normal", mean = 9.4e9, deviation = 0.3e9 }
    "impactor.mass" = { distribution = "uniform", low = 0.9, high = 1.1 }
    "delamination[*].G_IIc" = { distribution = "lognormal", mean = 790, deviation = 80 }

    [derived]                                 # in this order, from names, keys of the case's deck, and numbers
    "impactor.velocity" = "sqrt(2*energy/impactor.mass)"

Several tables together are combined: each row of [grid] with each of [list] with each of [samples]. `deck` may be swept
too. Text that reads as values of a deck stands there as it is; any other is put in quotes.
"""
MOST_CASES = 100_000
COLUMNS = ("case", "impact_energy", "peak_force", "peak_force_time", "contact_duration", "max_deflection",
           "rebound_velocity", "absorbed_energy", "delaminated_area", "first_growth_force", "first_growth_time",
           "exit_code", "cpu_time", "version", "folder")
_TABLES = ("grid", "list", "samples", "derived")
_SAMPLES = {"number": None, "seed": 1, "method": "random"}


@dataclass(frozen=True)
class Case:
    """One case: its number from 1, the values that tell it from others, its deck, and which of several runs of it."""

    number: int
    values: dict[str, object]
    deck_name: str
    deck: str
    repeat: int = 1

    @cached_property
    def key(self) -> str:
        """Return a name of the deck's content: cases of the same deck have the same, but where one is repeated."""
        name = hashlib.sha256(f"{self.deck_name}\n{self.deck}".encode()).hexdigest()[:12]
        return name if self.repeat == 1 else f"{name}_{self.repeat}"

    @property
    def label(self) -> str:
        """Return the values in one line, to six digits."""
        return "  ".join(f"{name}={value:.6g}" if isinstance(value, float) else f"{name}={deck_value(value)}"
                         for name, value in self.values.items())


@dataclass(frozen=True)
class Plan:
    """All cases of a sweep, the text of its file, the names of what is set and derived, and where results go."""

    path: Path
    text: str
    names: list[str]
    derived: list[str]
    cases: list[Case]
    output: Path
    units: str


def read_plan(path: Path, output: Path | None = None) -> Plan:
    """Read the file of a sweep and make the decks of its cases."""
    text = read_text(path, "the sweep")
    try:
        content = tomllib.loads(text)
        tables = {name: flat_table(content.pop(name, {}), name) for name in _TABLES}
        base, folder, units = content.pop("deck", ""), content.pop("output", path.stem), content.pop("units", "")
        if content:
            raise DeckError(f"'{next(iter(content))}' is none of deck, output, units, {', '.join(_TABLES)}.")
        if not all(isinstance(word, str) for word in (base, folder, units)) or units not in ("", *SYSTEMS):
            raise DeckError(f"deck and output are text, and units one of {', '.join(SYSTEMS)}.")
        check_names(tables)
        cases = CaseMaker(path.parent, base, tables["derived"])
        made = [cases.make(number, values) for number, values in enumerate(combinations(tables), start=1)]
        cases.check_use(name for table in ("grid", "list", "samples") for name in tables[table])
    except (tomllib.TOMLDecodeError, DeckError) as error:
        raise DeckError(f"{path}: {error}") from None
    return Plan(path, text, list(made[0].values), list(tables["derived"]), made, output or path.parent / folder, units)


def flat_table(table: object, name: str) -> dict[str, object]:
    """Return a table with dotted names, whether or not they were written in quotes."""
    if not isinstance(table, dict):
        raise DeckError(f"{name} is a table: [{name}].")
    flat = {}
    for key, value in table.items():
        if isinstance(value, dict) and "distribution" not in value:
            flat |= {f"{key}.{rest}": item for rest, item in flat_table(value, name).items()}
        else:
            flat[key] = value
    return flat


def check_names(tables: dict[str, dict[str, object]]) -> None:
    """Refuse names that are neither keys nor plain names, and those given twice."""
    seen: dict[str, str] = {}
    for table, entries in tables.items():
        for name in entries:
            if table == "samples" and name in _SAMPLES:
                continue
            path = key_path(name)
            if path is None and (not name.isidentifier() or name in FUNCTIONS or name in CONSTANTS):
                raise DeckError(f"[{table}] '{name}' is neither a key of the deck, as group.key or group[2].key, "
                                "nor a free name.")
            if name in COLUMNS:
                raise DeckError(f"[{table}] '{name}' is the name of another column of the table.")
            same = str(path).lower() if path else name
            if same in seen:
                raise DeckError(f"'{name}' stands in both [{seen[same]}] and [{table}]." if seen[same] != table
                                else f"'{name}' stands in [{table}] twice.")
            seen[same] = table


def combinations(tables: dict[str, dict[str, object]]) -> Iterator[dict[str, object]]:
    """Yield the swept values of every case, in order."""
    for table in ("grid", "list"):
        for name, values in tables[table].items():
            if not isinstance(values, list) or not values:
                raise DeckError(f"[{table}] {name} needs a list of values, one at least.")
    grid, side_by_side, samples = tables["grid"], tables["list"], _samples(tables["samples"])
    lengths = {name: len(values) for name, values in side_by_side.items()}
    if len(set(lengths.values())) > 1:
        raise DeckError("[list] needs lists of one length, not " +
                        ", ".join(f"{name} with {length}" for name, length in lengths.items()) + ".")
    if not grid and not side_by_side and not samples:
        raise DeckError("nothing is swept: [grid], [list] or [samples] is needed.")
    rows = [list(itertools.islice(zip(*table.values(), strict=True), MOST_CASES)) if table else [()]
            for table in (side_by_side, samples)]
    count = math.prod(len(values) for values in grid.values()) * len(rows[0]) * len(rows[1])
    if count > MOST_CASES:
        raise DeckError(f"the sweep has {count} cases; {MOST_CASES} are the most.")
    names = [*grid, *side_by_side, *samples]
    for parts in itertools.product(itertools.product(*grid.values()), *rows):
        yield dict(zip(names, itertools.chain(*parts), strict=True))


def _samples(table: Mapping[str, object]) -> dict[str, list[float]]:
    """Return the samples of each name."""
    quantities = {name: value for name, value in table.items() if name not in _SAMPLES}
    if not table:
        return {}
    number, seed, method = (table.get(name, default) for name, default in _SAMPLES.items())
    whole = all(isinstance(value, int) and not isinstance(value, bool) for value in (number, seed))
    if not whole or not 1 <= number <= MOST_CASES or method not in METHODS or not quantities:
        raise DeckError(f"[samples] needs a number from 1 to {MOST_CASES}, a whole seed, a method out of "
                        f"{', '.join(METHODS)}, and a quantity at least.")
    return {name: draw(name, value, number, seed, method) for name, value in quantities.items()}


class CaseMaker:
    """Makes the cases from the base decks, and keeps in mind which free names a formula uses."""

    def __init__(self, folder: Path, base: str, derived: dict[str, object]) -> None:
        """Decks lie in `folder`; `base` is the deck where none is swept."""
        self._folder, self._base, self._derived = folder, base, derived
        self._texts: dict[str, str] = {}
        self._used: set[str] = set()

    def make(self, number: int, swept: dict[str, object]) -> Case:
        """Return the case of these swept values."""
        values = dict(swept)
        base = values.get("deck", self._base)
        if not isinstance(base, str) or not base:
            raise DeckError("deck, the deck that all cases start from, is needed.")
        settings = {path: deck_value(value) for name, value in values.items() if (path := key_path(name))}
        name = f"{Path(base).stem}.nml"
        text = set_keys(self._text(base), settings, name)
        for target, formula in self._derived.items():
            if not isinstance(formula, str):
                raise DeckError(f"[derived] {target} needs a formula, as text.")
            values[target] = evaluate(formula, lambda word, text=text: self._look_up(word, values, text, name))
            if path := key_path(target):
                text = set_keys(text, {path: deck_value(values[target])}, name)
        return Case(number, values, name, text)

    def check_use(self, names: Iterator[str]) -> None:
        """Refuse free names that no formula uses: they would make no difference."""
        for name in names:
            if name not in (*_SAMPLES, "deck", *self._used) and key_path(name) is None:
                raise DeckError(f"no formula of [derived] uses '{name}'; a key of the deck is written group.key.")

    def _text(self, base: str) -> str:
        """Return the text of a base deck."""
        if base not in self._texts:
            self._texts[base] = read_text(self._folder / base, "the deck")
        return self._texts[base]

    def _look_up(self, word: str, values: dict[str, object], text: str, name: str) -> object:
        """Return what a word of a formula stands for: a free name, or a key as the case's deck has it."""
        path: KeyPath | None = key_path(word)
        if path is not None:
            return number_of(text, path, name)
        if word not in values:
            raise DeckError(f"'{word}' is neither swept nor derived before.")
        self._used.add(word)
        return values[word]
