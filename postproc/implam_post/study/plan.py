"""The plan of a study: problems, methods, the reference of each problem, and repeated runs."""

import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from implam_post.io.deck_text import deck_value, key_path
from implam_post.io.errors import DeckError
from implam_post.io.files import read_text
from implam_post.io.units import SYSTEMS
from implam_post.sweep.plan import Case, CaseMaker, Plan, check_names, combinations, flat_table

FORMAT = """
The file of a study:

    deck = "sun_chen.nml"                     # the deck of all problems, in the folder of this file; or in [problems]
    output = "results"                        # folder of runs and table; default: the name of this file
    repeats = 3                               # runs of each case, for the least processor time; default 1
    error = "force_history"                   # error of the plot and of the front; default force_history

    [problems]                                  # n-th value: n-th problem; a single value is for all problems
    deck = ["sun_chen.nml", "karas.nml"]
    problem = ["Sun and Chen", "Karas"]         # names; default: those of the decks
    coarse = [8e-6, 4e-6]                     # a name without a group is for formulas of [derived]
    "time.end" = "1e-3"
    reference = "semi-analytic"               # or a history (CSV) in the folder of this file, e.g. a measured one

    [grid]                                    # methods: every combination, as in a sweep
    "mesh.elements" = [[8, 8], [12, 12]]
    part = [1, 2, 4]

    [list]                                    # methods: n-th values together
    method = ["Gear", "trapezoidal rule"]     # names in table and plot, optional
    "impactor.integrator" = ["gear4", "trapezoidal"]

    [derived]                                 # formulas of names, keys of the deck, and numbers, in this order
    "time.step" = "coarse/part"

    [reference]                               # the method of the reference run of problems without another reference
    "mesh.elements" = [32, 32]
    part = 32

    [figures]                                 # further columns of the history: last value
    energy_algorithmic = "final"              # or "max", "min", "max_abs"

Errors: peak_force, peak_force_time, contact_duration, max_deflection, rebound_velocity, force_history (relative L2),
delaminated_area.
"""
SEMI_ANALYTIC = "semi-analytic"
ERRORS = ("peak_force", "peak_force_time", "contact_duration", "max_deflection", "rebound_velocity", "force_history",
          "delaminated_area")
_TABLES = ("problems", "grid", "list", "derived", "reference")
_WAYS = ("final", "max", "min", "max_abs")
_MAX_REPEATS = 100


@dataclass(frozen=True)
class Problem:
    """A problem: its name, and its reference, which is a case, the path of a history, or the word semi-analytic."""

    name: str
    reference: Case | Path | str


@dataclass(frozen=True)
class Trial:
    """A problem computed with a method: the values of the method, and the repeated runs."""

    problem: Problem
    method: dict[str, object]
    runs: list[Case]


@dataclass(frozen=True)
class Study(Plan):
    """The plan of all runs with their problems and methods.

    `methods` are the names that methods set, `shown` those of them that are shown in tables. `figures` are columns of
    the history and how they are evaluated.
    """

    problems: list[Problem]
    trials: list[Trial]
    methods: list[str]
    shown: list[str]
    figures: dict[str, str]
    error: str
    repeats: int


def read_study(path: Path, output: Path | None = None) -> Study:
    """Read the file of a study and create the decks of its runs."""
    text = read_text(path, "the study")
    try:
        content = tomllib.loads(text)
        if "scenes" in content:  # the older name
            content["problems"] = content.pop("scenes")
        tables = {name: flat_table(content.pop(name, {}), name) for name in _TABLES}
        if "scene" in tables["problems"]:
            tables["problems"]["problem"] = tables["problems"].pop("scene")
        figures = content.pop("figures", {})
        words = {name: content.pop(name, default) for name, default in
                 (("deck", ""), ("output", path.stem), ("units", ""), ("error", "force_history"), ("repeats", 1))}
        if content:
            raise DeckError(f"'{next(iter(content))}' is not one of {', '.join((*words, *_TABLES, 'figures'))}.")
        _check_words(words, figures)
        problems, trials, runs = _Maker(path.parent, str(words["deck"]), tables).make(int(words["repeats"]))
    except (tomllib.TOMLDecodeError, DeckError) as error:
        raise DeckError(f"{path}: {error}") from None
    names = list(dict.fromkeys(name for run in runs for name in run.values))
    shown = ["method"] if "method" in tables["list"] else list(tables["list"])
    return Study(path, text, names, list(tables["derived"]), runs, output or path.parent / str(words["output"]),
                 str(words["units"]), problems, trials, [*tables["grid"], *tables["list"]], [*tables["grid"], *shown],
                 figures, str(words["error"]), int(words["repeats"]))


def _check_words(words: Mapping[str, object], figures: object) -> None:
    """Refuse invalid values of words outside of the tables."""
    if not all(isinstance(words[name], str) for name in ("deck", "output")) or words["units"] not in ("", *SYSTEMS):
        raise DeckError(f"deck and output must be text, and units one of {', '.join(SYSTEMS)}.")
    if words["error"] not in ERRORS:
        raise DeckError(f"error must be one of {', '.join(ERRORS)}.")
    repeats = words["repeats"]
    if not isinstance(repeats, int) or isinstance(repeats, bool) or not 1 <= repeats <= _MAX_REPEATS:
        raise DeckError(f"repeats must be an integer from 1 to {_MAX_REPEATS}.")
    if not isinstance(figures, dict) or not all(way in _WAYS for way in figures.values()):
        raise DeckError(f"[figures] must give for each column of the history one of {', '.join(_WAYS)}.")


class _Maker:
    """Creates problems, trials and runs from the tables."""

    def __init__(self, folder: Path, base: str, tables: dict[str, dict[str, object]]) -> None:
        """Decks and references are in `folder`; `base` is the deck of all problems that do not have their own."""
        self._folder, self._tables = folder, tables
        self._given = {name: tables["problems"].pop(name, "") for name in ("problem", "reference")}
        check_names({name: table for name, table in tables.items() if name != "reference"})
        self._cases = CaseMaker(folder, base, tables["derived"])
        self._base = base

    def make(self, repeats: int) -> tuple[list[Problem], list[Trial], list[Case]]:
        """Return the problems, their trials, and all runs in the order in which they are run."""
        methods = list(combinations({**{name: self._tables[name] for name in ("grid", "list")}, "samples": {}}))
        rows = list(self._problem_rows())
        names = self._names(rows)
        problems = [Problem(name, self._reference(name, place, row)) for place, (name, row) in
                  enumerate(zip(names, rows, strict=True))]
        trials, number = [], 0
        for problem, row in zip(problems, rows, strict=True):
            for method in methods:
                number += 1
                first = replace(self._cases.make(number, row | method), values={"problem": problem.name, **method})
                trials.append(Trial(problem, method, [replace(first, repeat=turn) for turn in range(1, repeats + 1)]))
        self._cases.check_use(name for table in ("problems", "grid", "list", "reference")
                              for name in self._tables[table] if name != "method")
        references = [problem.reference for problem in problems if isinstance(problem.reference, Case)]
        return problems, trials, references + [trial.runs[turn] for turn in range(repeats) for trial in trials]

    def _problem_rows(self) -> Iterator[dict[str, object]]:
        """Yield the values of each problem."""
        table = {**self._tables["problems"], **{name: given for name, given in self._given.items() if given}}
        lengths = {name: len(values) for name, values in table.items() if isinstance(values, list)}
        if len(set(lengths.values())) > 1 or 0 in lengths.values():
            raise DeckError("[problems] needs lists of equal length, or single values, not " +
                            ", ".join(f"{name} with {length}" for name, length in lengths.items()) + ".")
        for place in range(next(iter(lengths.values()), 1)):
            yield {name: values[place] if isinstance(values, list) else values
                   for name, values in self._tables["problems"].items()}

    def _names(self, rows: list[dict[str, object]]) -> list[str]:
        """Return the names of the problems; the default is the name of the deck with the values that differ."""
        if self._given["problem"]:
            names = [str(self._at("problem", place)) for place in range(len(rows))]
        else:
            names = [Path(str(row.get("deck", self._base))).stem for row in rows]
            varied = [name for name in self._tables["problems"] if name != "deck" and
                      len({deck_value(row[name]) for row in rows}) > 1]
            if max(Counter(names).values()) > 1:
                names = [" ".join([name, *(f"{key.rpartition('.')[2]}={deck_value(row[key])}" for key in varied)])
                         for name, row in zip(names, rows, strict=True)]
        twice = [name for name, times in Counter(names).items() if times > 1]
        if twice:
            raise DeckError(f"[problems] several have the name '{twice[0]}'.")
        return names

    def _at(self, name: str, place: int) -> object:
        """Return the name or reference of a problem in [problems]."""
        given = self._given[name]
        return given[place] if isinstance(given, list) else given

    def _reference(self, name: str, place: int, row: dict[str, object]) -> Case | Path | str:
        """Return the reference of a problem."""
        given = self._at("reference", place)
        if given == SEMI_ANALYTIC:
            return SEMI_ANALYTIC
        if given:
            path = self._folder / str(given)
            if not path.is_file():
                raise DeckError(f"[problems] reference: there is no history {path}; it is '{SEMI_ANALYTIC}', or a "
                                "history (CSV) in the folder of this file.")
            return path
        if not self._tables["reference"]:
            raise DeckError("a reference is required: the table [reference], or reference in [problems].")
        for word in self._tables["reference"]:
            names = [name for table in ("problems", "grid", "list") for name in self._tables[table]]
            if key_path(word) is None and word not in names:
                raise DeckError(f"[reference] '{word}' is not a key of the deck, such as group.key, or a name of "
                                "[problems], [grid] or [list].")
        made = self._cases.make(0, row | self._tables["reference"])
        return replace(made, values={"problem": name, "reference": "run"})
