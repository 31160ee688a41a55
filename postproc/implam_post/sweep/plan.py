"""The plan of a sweep: its cases with their decks."""

import hashlib
import itertools
import math
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from pathlib import Path

from implam_post.io.deck import Deck
from implam_post.io.deck_text import KeyPath, deck_value, drop_group, group_path, key_path, number_of, set_keys
from implam_post.io.errors import DeckError
from implam_post.io.files import read_deck_text, read_text
from implam_post.io.units import SYSTEMS
from implam_post.sweep.expressions import CONSTANTS, FUNCTIONS, evaluate
from implam_post.sweep.library_values import Library, adopt, asking
from implam_post.sweep.samples import METHODS, draw
from implam_post.sweep.scatter_plan import Scatter, read_scatter

FORMAT = """
The file of a sweep:

    deck = "peanut.nml"                       # the base deck of all cases, in the folder of this file
    output = "results"                        # folder of the cases and the table; default: the name of this file
    then = "compression.nml"                  # a second deck for each case, which begins with its final state
    units = "SI"                              # or mm-t-s, mm-kg-ms, mm-mN-kg-s; default: system of units of the deck

    [grid]                                    # all combinations, the last key changes fastest
    "laminate.angles" = [[0, 90, 0], "3*0"]   # a list in the list, or text as in a deck
    energy = [1.0, 2.0]                       # a name without a group is for formulas of [derived]

    [list]                                    # n-th values together: first with first, second with second
    "material[1].E1" = [120e9, 139e9]         # [1] is the first group of that name, [*] are all of them
    "delamination[*].G_c" = [400, ""]         # "" removes the key

    [samples]                                 # random values
    number = 20
    seed = 1                                  # default 1
    method = "random"                         # or "latin_hypercube"
    "material[*].E2" = { distribution = "normal", mean = 9.4e9, deviation = 0.3e9 }
    "impactor.mass" = { distribution = "uniform", low = 0.9, high = 1.1 }
    "delamination[*].G_IIc" = { distribution = "lognormal", mean = 790, deviation = 80 }

    [derived]                                 # formulas of names, keys of the deck, and numbers, in this order
    "impactor.velocity" = "sqrt(2*energy/impactor.mass)"

    [scatter]                                 # runs with random inputs, by default with their usual tolerances
    number = 10
    seed = 1                                  # default 1; method as above
    strengths = 0.08                          # coefficients of variation other than the defaults, 0: as in the deck
    "delamination.G_IIc" = 0.1                # of a single key

    [variants]                                # decks to be compared, with the same random inputs
    "as it is" = {}
    "no friction" = { "delamination[*].friction" = 0 }
    "no clamps" = { drop = ["support[2]"] }   # without a group

Several tables are combined: each row of [grid] with each of [list] and each of [samples]. `deck` may be swept, too.
Text that is valid as values of a deck is used as it is; other text is put in quotes.
"""
MAX_CASES = 100_000
COLUMNS = ("case", "impact_energy", "peak_force", "peak_force_time", "contact_duration", "max_deflection",
           "rebound_velocity", "absorbed_energy", "delaminated_area", "first_growth_force", "first_growth_time",
           "dent_depth", "projected_area", "residual_strength", "shortening_at_strength", "failure_load",
           "skin_stress_at_strength", "effective_modulus", "has_failed", "failure_code", "exit_code", "cpu_time",
           "version", "folder")
_TABLES = ("grid", "list", "samples", "derived")
VARIANT = "variant"
_SAMPLES = {"number": None, "seed": 1, "method": "random"}


@dataclass(frozen=True)
class Case:
    """One case: number from 1, swept values, deck, and the number of the run if the same deck is repeated."""

    number: int
    values: dict[str, object]
    deck_name: str
    deck: str
    repeat: int = 1

    @cached_property
    def key(self) -> str:
        """Return a hash of the deck, equal for cases of the same deck that are not repeated runs."""
        name = hashlib.sha256(f"{self.deck_name}\n{self.deck}".encode()).hexdigest()[:12]
        return name if self.repeat == 1 else f"{name}_{self.repeat}"

    @property
    def label(self) -> str:
        """Return the values in one line, to six digits, without the random ones of [scatter]."""
        shown = [f"{name}={value:.6g}" if isinstance(value, float) else f"{name}={deck_value(value)}"
                for name, value in self.values.items() if " " not in name]
        return "  ".join([*shown, *["random inputs"] * (len(shown) < len(self.values))])


@dataclass(frozen=True)
class Variant:
    """A variant of the deck: its name, changed keys, and removed groups."""

    name: str
    settings: dict[str, object]
    dropped: list[str]


@dataclass(frozen=True)
class Plan:
    """All cases of a sweep, the text of its file, the names of swept and derived values, and the folder of the results.

    `random` are the names of random values. `scatter` is the table [scatter], `measured` a measured curve for the
    pictures, and `notes` are about inputs that do not scatter. `then` is the deck of second runs, which begin with the
    final states of the cases.
    """

    path: Path
    text: str
    names: list[str]
    derived: list[str]
    cases: list[Case]
    output: Path
    units: str
    random: frozenset[str] = field(default=frozenset(), kw_only=True)
    scatter: Scatter | None = field(default=None, kw_only=True)
    measured: Path | None = field(default=None, kw_only=True)
    then: Path | None = field(default=None, kw_only=True)
    notes: tuple[str, ...] = field(default=(), kw_only=True)


def read_plan(path: Path, output: Path | None = None, program: Sequence[str] | None = None) -> Plan:
    """Read the file of a sweep and create the decks of its cases; the program lists published materials."""
    text = read_text(path, "the sweep")
    try:
        content = tomllib.loads(text)
        tables = {name: flat_table(content.pop(name, {}), name) for name in _TABLES}
        scatter, variants = read_scatter(content.pop("scatter", None)), read_variants(content.pop("variants", {}))
        words = {"deck": "", "output": path.stem, "units": "", "measured": "", "then": ""}
        base, folder, units, measured, then = (content.pop(name, default) for name, default in words.items())
        if content:
            raise DeckError(f"'{next(iter(content))}' is not one of {', '.join(words)}, {', '.join(_TABLES)}, scatter, "
                            "variants.")
        given = (base, folder, units, measured, then)
        if not all(isinstance(word, str) for word in given) or units not in ("", *SYSTEMS):
            raise DeckError(f"deck, output, measured and then must be text, and units one of {', '.join(SYSTEMS)}.")
        check_names(tables)
        cases = CaseMaker(path.parent, base, tables["derived"], scatter, cache(asking(program)))
        made = _cases(cases, tables, variants)
        cases.check_use(name for table in ("grid", "list", "samples") for name in tables[table])
    except (tomllib.TOMLDecodeError, DeckError) as error:
        raise DeckError(f"{path}: {error}") from None
    names = list(dict.fromkeys(name for case in made for name in case.values))
    drawn = frozenset(name for name in names if name in tables["samples"]) | cases.drawn
    return Plan(path, text, names, list(tables["derived"]), made, output or path.parent / folder, units, random=drawn,
                scatter=scatter, measured=path.parent / measured if measured else None,
                then=path.parent / then if then else None, notes=tuple(cases.notes))


def _cases(maker: "CaseMaker", tables: dict[str, dict[str, object]], variants: Sequence["Variant"]) -> list[Case]:
    """Return the cases: all combinations of variants, rows of swept values and runs."""
    runs = maker.scatter.number if maker.scatter else 1
    swept = any(tables[name] for name in ("grid", "list", "samples"))
    rows = list(combinations(tables)) if swept or not (maker.scatter or variants) else [{}]
    if (count := max(len(variants), 1) * len(rows) * runs) > MAX_CASES:
        raise DeckError(f"the sweep has {count} cases; at most {MAX_CASES} are allowed.")
    chosen = itertools.product(variants or [None], rows, range(runs))
    return [maker.make(number, row, variant, run) for number, (variant, row, run) in enumerate(chosen, start=1)]


def read_variants(table: object) -> list[Variant]:
    """Return the variants of a sweep, in order."""
    if not isinstance(table, dict) or not all(isinstance(value, dict) for value in table.values()):
        raise DeckError('variants must be a table of tables: [variants] "name" = { "group.key" = value }.')
    return [_variant(name, dict(value)) for name, value in table.items()]


def _variant(name: str, table: dict[str, object]) -> Variant:
    """Return one variant."""
    dropped = table.pop("drop", [])
    if not isinstance(dropped, list) or not all(isinstance(word, str) and group_path(word) for word in dropped):
        raise DeckError(f"[variants] {name}: drop must be a list of groups, such as [\"support[2]\"].")
    settings = flat_table(table, f"variants.{name}")
    for key in settings:
        if key != "deck" and key_path(key) is None:
            raise DeckError(f"[variants] {name}: '{key}' is not a key of the deck, such as group.key or group[2].key.")
    return Variant(name, settings, dropped)


def only(plan: Plan, variants: Sequence[str]) -> Plan:
    """Return the plan with only its first variant and these others."""
    names = list(dict.fromkeys(str(case.values[VARIANT]) for case in plan.cases if VARIANT in case.values))
    for name in variants:
        if name not in names:
            raise DeckError(f"{plan.path}: '{name}' is not one of the variants {', '.join(names) or '(none)'}.")
    kept = {names[0], *variants}
    return replace(plan, cases=[case for case in plan.cases if case.values[VARIANT] in kept])


def is_random(plan: Plan) -> bool:
    """Return whether a sweep has runs that differ in random inputs."""
    return bool(plan.random) or plan.scatter is not None


def flat_table(table: object, name: str) -> dict[str, object]:
    """Return a table with dotted names, which may have been given with or without quotes."""
    if not isinstance(table, dict):
        raise DeckError(f"{name} must be a table: [{name}].")
    flat: dict[str, object] = {}
    for key, value in table.items():
        is_nested = isinstance(value, dict) and "distribution" not in value
        found = {f"{key}.{rest}": item for rest, item in flat_table(value, name).items()} if is_nested else {key: value}
        for twice in flat.keys() & found:
            raise DeckError(f"'{twice}' is given twice in [{name}].")
        flat |= found
    return flat


def check_names(tables: dict[str, dict[str, object]]) -> None:
    """Refuse names that are not keys or plain names, and names given twice."""
    table_of: dict[str, str] = {}
    for table, entries in tables.items():
        for name in entries:
            if table == "samples" and name in _SAMPLES:
                continue
            path = key_path(name)
            if path is None and (not name.isidentifier() or name in FUNCTIONS or name in CONSTANTS):
                raise DeckError(f"[{table}] '{name}' is not a key of the deck, such as group.key or group[2].key, "
                                "or a free name.")
            if name in (*COLUMNS, VARIANT):
                raise DeckError(f"[{table}] '{name}' is the name of another column of the table.")
            same = str(replace(path, number=1 if path.number is None else path.number)).lower() if path else name
            if same in table_of:
                raise DeckError(f"'{name}' is given in [{table_of[same]}] and [{table}]." if table_of[same] != table
                                else f"'{name}' is given twice in [{table}].")
            table_of[same] = table


def combinations(tables: dict[str, dict[str, object]]) -> Iterator[dict[str, object]]:
    """Yield the swept values of every case, in order."""
    for table in ("grid", "list"):
        for name, values in tables[table].items():
            if not isinstance(values, list) or not values:
                raise DeckError(f"[{table}] {name} needs a list of at least one value.")
    grid, side_by_side, samples = tables["grid"], tables["list"], _samples(tables["samples"])
    lengths = {name: len(values) for name, values in side_by_side.items()}
    if len(set(lengths.values())) > 1:
        raise DeckError("[list] needs lists of equal length, not " +
                        ", ".join(f"{name} with {length}" for name, length in lengths.items()) + ".")
    if not grid and not side_by_side and not samples:
        raise DeckError("the sweep has no values: [grid], [list], [samples], [scatter] or [variants] is required.")
    rows = [list(itertools.islice(zip(*table.values(), strict=True), MAX_CASES)) if table else [()]
            for table in (side_by_side, samples)]
    count = math.prod(len(values) for values in grid.values()) * len(rows[0]) * len(rows[1])
    if count > MAX_CASES:
        raise DeckError(f"the sweep has {count} cases; at most {MAX_CASES} are allowed.")
    names = [*grid, *side_by_side, *samples]
    for parts in itertools.product(itertools.product(*grid.values()), *rows):
        yield dict(zip(names, itertools.chain(*parts), strict=True))


def _samples(table: Mapping[str, object]) -> dict[str, list[float]]:
    """Return the samples of each name."""
    quantities = {name: value for name, value in table.items() if name not in _SAMPLES}
    if not table:
        return {}
    number, seed, method = (table.get(name, default) for name, default in _SAMPLES.items())
    are_integers = all(isinstance(value, int) and not isinstance(value, bool) for value in (number, seed))
    if not are_integers or not 1 <= number <= MAX_CASES or method not in METHODS or not quantities:
        raise DeckError(f"[samples] needs a number from 1 to {MAX_CASES}, an integer seed, a method, one of "
                        f"{', '.join(METHODS)}, and at least one quantity.")
    return {name: draw(name, value, number, seed, method) for name, value in quantities.items()}


class CaseMaker:
    """Creates cases from the base decks; records free names that formulas use, and names of random inputs."""

    def __init__(self, folder: Path, base: str, derived: dict[str, object], scatter: Scatter | None = None,
                 request: Callable[[], Library] = dict) -> None:
        """Decks are in `folder`; `base` is the deck if `deck` is not swept; `request` returns published materials."""
        self._folder, self._base, self._derived, self.scatter, self._request = folder, base, derived, scatter, request
        self._texts: dict[str, str] = {}
        self._used: set[str] = set()
        self.drawn: frozenset[str] = frozenset()
        self.notes: list[str] = []

    def make(self, number: int, swept: dict[str, object], variant: Variant | None = None, run: int = 0) -> Case:
        """Return the case of swept values, a variant and a run with its random inputs."""
        set_too = variant.settings if variant else {}
        values = ({VARIANT: variant.name} if variant else {}) | {
            name: set_too.get(name, value) for name, value in swept.items()}
        base = set_too.get("deck", values.get("deck", self._base))
        if not isinstance(base, str) or not base:
            raise DeckError("deck, the base deck of all cases, is required.")
        settings = {path: deck_value(value) for name, value in (swept | set_too).items() if (path := key_path(name))}
        name = f"{Path(base).stem}.nml"
        text = self._text(base)
        # Numbers of groups refer to the base deck, so that groups are removed first, from the last to the first.
        dropped = sorted(map(group_path, variant.dropped if variant else ()), key=lambda found: -(found[1] or 0))
        for group, place in dropped:
            text = drop_group(text, group, place, name)
        text = set_keys(text, settings, name)
        for target, formula in self._derived.items():
            if not isinstance(formula, str):
                raise DeckError(f"[derived] {target} needs a formula, as text.")
            values[target] = evaluate(formula, lambda word, text=text: self._resolve(word, values, text, name))
            if path := key_path(target):
                text = set_keys(text, {path: deck_value(values[target])}, name)
        return Case(number, *self._scattered(values, text, name, run))

    def _scattered(self, values: dict[str, object], text: str, name: str, run: int) -> tuple[dict, str, str]:
        """Return values, name and text of a deck with its random inputs, if there are any."""
        if self.scatter is None:
            return values, name, text
        text = adopt(text, name, self._request)
        note = self.scatter.note(Deck(text, Path(name)))
        if note and note not in self.notes:
            self.notes.append(note)
        text, drawn = self.scatter.set(text, name, run)
        self.drawn |= drawn.keys()
        return values | drawn, name, text

    def check_use(self, names: Iterator[str]) -> None:
        """Refuse free names that no formula uses, as they would have no effect."""
        for name in names:
            if name not in (*_SAMPLES, "deck", *self._used) and key_path(name) is None:
                raise DeckError(f"no formula of [derived] uses '{name}'; a key of the deck is given as group.key.")

    def _text(self, base: str) -> str:
        """Return the text of a base deck."""
        if base not in self._texts:
            self._texts[base] = read_deck_text(self._folder / base)
        return self._texts[base]

    def _resolve(self, word: str, values: dict[str, object], text: str, name: str) -> object:
        """Return the value of a name in a formula: a free name, or a key of the deck."""
        path: KeyPath | None = key_path(word)
        if path is not None:
            return number_of(text, path, name)
        if word not in values:
            raise DeckError(f"'{word}' is not swept, and not derived by a preceding formula.")
        self._used.add(word)
        return values[word]
