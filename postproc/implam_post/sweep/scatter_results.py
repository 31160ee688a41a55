"""Results of runs with random inputs: statistics of all figures, comparison of variants, and with measured values.

Files in the folder of the sweep: `statistics.csv`, `differences.csv`, `measured.csv`, `force_band.csv`, the figures of
all runs in `figures.csv`, and all of these in `statistics.json`, which `implam-report` reads.
"""

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from implam_post.io.deck import Deck
from implam_post.io.deck_text import deck_value
from implam_post.io.errors import ImplamError
from implam_post.io.fields import Fields
from implam_post.io.files import read_text, write_table, write_text
from implam_post.io.history import History, read_history
from implam_post.io.quantities import AGAINST_QUANTITIES
from implam_post.io.run import Run, open_run
from implam_post.io.run_figures import Measured
from implam_post.regress.compare import check_expectations
from implam_post.regress.expectations import Expectation, read_expectations
from implam_post.sweep.case_run import read_record
from implam_post.sweep.plan import VARIANT, Case, Plan
from implam_post.sweep.runs import Sweep
from implam_post.sweep.scatter_plan import KINDS
from implam_post.sweep.scatter_statistics import HIGH, LOW, Difference, Spread, differences, spread_of, spreads

STATISTICS = "statistics.json"
_ROWS = 1000  # number of times of the band of the force history


@dataclass
class EndedRun:
    """A run with a result: case, summary and history, figures, processor time in seconds, and the final projected
    delamination as polygons on the full plate; None without an interface. Fields are not stored."""

    case: Case
    results: Run
    figures: dict[str, Measured]
    seconds: float
    region: np.ndarray | None


@dataclass
class Group:
    """Runs that differ only in random inputs: a variant, or a row of swept values.

    `plate` are the fields of the first run with an interface.
    """

    name: str
    runs: list[EndedRun | None] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    plate: Fields | None = None

    @property
    def ended(self) -> list[EndedRun]:
        """Return the runs that have a result."""
        return [run for run in self.runs if run is not None]

    @property
    def numbers(self) -> list[dict[str, float]]:
        """Return the figures of each run; empty for runs without a result."""
        return [{} if run is None else {name: figure.value for name, figure in run.figures.items()}
                for run in self.runs]

    @property
    def dimensions(self) -> dict[str, str]:
        """Return the dimensions of the figures."""
        return {name: figure.dimension for run in self.ended for name, figure in run.figures.items()}

    def band(self) -> dict[str, np.ndarray] | None:
        """Return the mean force at equally spaced times with the 5 and 95 % points; None without a force.

        The force is zero after the end of contact; a run that ends in contact counts until its end.
        """
        histories = [run.results.columns for run in self.ended if run.results.columns is not None]
        if not histories or not all(np.any(history["force"]) for history in histories):
            return None
        time = np.linspace(0, max(history.time[-1] for history in histories), _ROWS)
        forces = np.array([np.interp(time, history.time, history["force"], left=0.0,
                                     right=math.nan if history["force"][-1] > 0 else 0.0) for history in histories])
        known = np.any(np.isfinite(forces), axis=0)
        time, forces = time[known], forces[:, known]
        low, high = np.nanquantile(forces, (LOW, HIGH), axis=0, method="median_unbiased")
        return {"time": time, "mean": np.nanmean(forces, axis=0), "low": low, "high": high}


@dataclass(frozen=True)
class ComparedMean:
    """A measured value and the mean of the runs."""

    expected: Expectation
    found: Spread

    @property
    def passed(self) -> bool:
        """Whether the mean is within the tolerance."""
        return abs(self.found.mean - self.expected.value) <= self.expected.tolerance

    @property
    def verdict(self) -> str:
        """Words for the comparison."""
        return verdict_of(self.found.mean, self.passed)


def verdict_of(mean: float | None, within: bool) -> str:
    """Return the words for a comparison of a mean; a history that ends before the measured one has no difference."""
    if mean is None or math.isnan(mean):
        return "not compared: the runs end before the curve"
    return "within" if within else "beyond"


def groups_of(sweep: Sweep) -> list[Group]:
    """Return the groups of a sweep in order, with the results of the runs that have ended."""
    plan = sweep.plan
    found: dict[str, Group] = {}
    distinctive = _distinctive(plan)
    for case in plan.cases:
        kept = {name: case.values[name] for name in distinctive if name in case.values}
        name = ", ".join(str(value) if key == VARIANT else f"{key}={deck_value(value)}" for key, value in kept.items())
        group = found.setdefault(name, Group(name))
        try:
            group.runs.append(None if sweep.failure(case) else _run(sweep, case, group))
        except ImplamError as error:
            group.runs.append(None)
            group.notes.append(f"case {case.number} is omitted from the statistics: {error}")
    return list(found.values())


def _distinctive(plan: Plan) -> list[str]:
    """Return the names in which groups differ: the variant, and the swept values that differ within a variant."""
    of_variants: dict[object, list[Case]] = {}
    for case in plan.cases:
        of_variants.setdefault(case.values.get(VARIANT), []).append(case)
    return [name for name in plan.names if name not in (*plan.random, *plan.derived) and (
        name == VARIANT or any(len({deck_value(case.values.get(name, "")) for case in cases}) > 1
                               for cases in of_variants.values()))]


def _run(sweep: Sweep, case: Case, group: Group) -> EndedRun:
    """Return a run with its figures."""
    folder = sweep.folder(case)
    record, results = read_record(folder), open_run(folder)
    fields, region = results.fields, None
    if fields is not None and fields.snapshots[-1].mesh.interfaces:
        region = fields.projected(len(fields.snapshots) - 1)
        group.plate = group.plate or fields
    found = dict(results.figures)
    results.close_fields()
    return EndedRun(case, results, found, record.cpu_time if record else math.nan, region)


def against_measured(group: Group, measured: Path) -> list[ComparedMean]:
    """Return means of a group and measured values, from a file of expectations or a measured force history."""
    histories = [run.results.columns for run in group.ended if run.results.columns is not None]
    if not histories:
        return []
    if measured.suffix == ".toml":
        wanted = read_expectations(measured).variant().expectations
    else:
        wanted = [Expectation("l2_force", 0.0, absolute=1.0, against=measured.name)]
    of_runs = [item for item in wanted if item.quantity not in AGAINST_QUANTITIES]
    rows = [[row.found for row in check_expectations(history, of_runs, measured.parent)] for history in histories]
    compared = [ComparedMean(item, spread_of(values))
                for item, values in zip(of_runs, zip(*rows, strict=True), strict=True)]
    # Force histories are compared with the mean history.
    band = group.band()
    curves = [item for item in wanted if item.quantity in AGAINST_QUANTITIES]
    if band is not None and curves:
        mean = History({"time": band["time"], "force": band["mean"]}, "the mean of the runs")
        compared += [ComparedMean(row.expected, Spread(len(histories), row.found, *3 * (math.nan,)))
                 for row in check_expectations(mean, curves, measured.parent)]
    return compared


def curves_of(measured: Path | None) -> list[History]:
    """Return the files with measured force histories."""
    if measured is None:
        return []
    files = read_expectations(measured).curves if measured.suffix == ".toml" else [measured]
    curves = [read_history(file) for file in files if "time" in _head(file)]
    return [curve for curve in curves if "force" in curve.columns]


def _head(path: Path) -> str:
    """Return the line with the names of the columns."""
    lines = read_text(path, "the measured curve").splitlines()
    return next((line for line in lines if line.strip() and line[0] != "#"), "")


def pairs_of(groups: Sequence[Group]) -> list[tuple[Group, dict[str, Difference]]]:
    """Return the differences of each group from the first, over pairs of runs."""
    if len(groups) < 2:
        return []
    first = groups[0]
    return [(group, differences(first.numbers, group.numbers)) for group in groups[1:]
            if len(group.runs) == len(first.runs)]


def write_statistics(sweep: Sweep, groups: Sequence[Group], system: str,
                     variants: Sequence[Sequence[str]] = ()) -> list[Path]:
    """Write statistics, differences, measured values, the force band and the figures of all runs.

    `variants` is the table that compares the groups, for the report.
    """
    output, plan = sweep.plan.output, sweep.plan
    found_of = [(group, spreads(group.numbers)) for group in groups]
    head = ("group", "figure", "dimension", "runs", "mean", "deviation", "error_of_mean", "low_5", "high_95")
    statistics = [(group.name, name, group.dimensions.get(name, ""), one.number, one.mean, one.deviation, one.error,
                   one.low, one.high) for group, found in found_of for name, one in found.items()]
    different = [(group.name, name, one.number, one.first, one.mean, one.error, one.least, int(one.differs))
             for group, found in pairs_of(groups) for name, one in found.items()]
    measured = [(group.name, row.expected.label, row.expected.value, row.expected.tolerance, row.found.number,
                 row.found.mean, row.found.deviation, row.found.error, int(row.passed))
                for group in groups for row in (against_measured(group, plan.measured) if plan.measured else ())]
    bands = [(group.name, *row) for group in groups if (band := group.band()) is not None
             for row in zip(*band.values(), strict=True)]
    names = dict.fromkeys(name for group in groups for numbers in group.numbers for name in numbers)
    single = [(run.case.number, group.name, run.seconds,
               *(run.figures[name].value if name in run.figures else math.nan for name in names))
              for group in groups for run in group.ended]
    tables = {"statistics.csv": (head, statistics), "figures.csv": (("case", "group", "cpu_time", *names), single)}
    if different:
        tables["differences.csv"] = (("group", "figure", "pairs", "first", "difference", "error_of_mean",
                                      "least_significant", "differs"), different)
    if measured:
        tables["measured.csv"] = (("group", "figure", "measured", "aim", "runs", "mean", "deviation", "error_of_mean",
                                   "within"), measured)
    if bands:
        tables["force_band.csv"] = (("group", "time", "mean", "low_5", "high_95"), bands)
    frames = {name: pd.DataFrame(rows, columns=[*columns]) for name, (columns, rows) in tables.items()}
    for name, frame in frames.items():
        write_table(output / name, frame)
    notes = [*plan.notes, *(note for group in groups for note in group.notes)]
    content = {"sweep": plan.text, "title": _title(groups), "system": system, "notes": notes,
               "groups": [{"name": group.name, "runs": len(group.runs), "ended": len(group.ended),
                           "seconds": sum(run.seconds for run in group.ended)} for group in groups],
               "inputs": inputs_of(plan), "variants": list(variants)}
    content |= {name.removesuffix(".csv"): frame.astype(object).where(frame.notna(), None).to_dict("records")
                for name, frame in frames.items() if name not in ("figures.csv", "force_band.csv")}
    write_text(output / STATISTICS, json.dumps(content, indent=1) + "\n")
    return [output / name for name in (*tables, STATISTICS)]


def inputs_of(plan: Plan) -> list[dict[str, object]]:
    """Return the random inputs of the first deck, each with its coefficient of variation and its source."""
    if plan.scatter is None:
        return []
    kinds = {kind.name: kind for kind in KINDS}
    rows = []
    for found in plan.scatter.inputs(Deck(plan.cases[0].deck, Path(plan.cases[0].deck_name))):
        kind = kinds[found.kind]
        is_given = found.kind in plan.scatter.variations or any(
            path.group == found.path.group and path.key.lower() == found.path.key.lower() for path in plan.scatter.keys)
        rows.append({"input": found.column.removesuffix(" factor"), "kind": found.kind, "variation": found.variation,
                     "source": "the file of the sweep" if is_given else kind.source})
    return rows


def _title(groups: Sequence[Group]) -> str:
    """Return the title in the deck."""
    for group in groups:
        for run in group.ended:
            return run.results.summary["title"] or run.results.summary["case"]
    return ""
