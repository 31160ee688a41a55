"""The second deck of a sweep, `then`: a run for each case that begins with the final state of its first run."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from implam_post.io.counts import counted
from implam_post.io.deck_text import copy_groups, deck_value, key_path, set_keys
from implam_post.io.errors import EXIT_DONE, DeckError, ImplamError
from implam_post.io.files import read_deck_text
from implam_post.io.program import checkpoint_in
from implam_post.sweep.case_run import read_record
from implam_post.sweep.plan import Case
from implam_post.sweep.runs import Sweep
from implam_post.sweep.table import FIGURES, RUN_COLUMNS, Table, add_columns, figures_in, no_figures

# Groups of the first deck that are copied to the second one, as the damage depends on them.
SHARED = ("material", "laminate", "doubler", "ply_drop", "stringer", "ply_damage", "delamination", "thermal")
# Groups whose swept keys are also set in the second deck, since mesh and plate are those of the first run.
_SET_TOO = ("mesh", "plate")
# Figures of a second run that is another impact, in columns `second_NAME`.
_OF_IMPACTS = ("peak_force", "absorbed_energy", "delaminated_area", "projected_area")
_OWN_KEYS = ("lines_x", "lines_y", "symmetry")


def following(sweep: Sweep) -> Sweep | None:
    """Return the sweep of the second runs, one for each first run with a result; None without a second deck."""
    plan = sweep.plan
    if plan.then is None:
        return None
    text = read_deck_text(plan.then)
    cases = [_second(case, checkpoint_in(sweep.folder(case)), plan.then, text)
             for case in plan.cases if _has_ended(sweep, case)]
    return Sweep(replace(plan, cases=cases, then=None, scatter=None, random=frozenset(), notes=()), sweep.program)


def foreseen(sweep: Sweep, then: Path, cases: Sequence[Case]) -> Sweep:
    """Return the second runs of cases, in a separate folder, to check their decks before the first runs.

    Their checkpoints do not exist yet, so that the program does not check that the decks agree with them.
    """
    text = read_deck_text(then)
    seconds = [_second(case, sweep.folder(case) / "pending_restart.h5", then, text) for case in cases]
    output = sweep.plan.output / "second_decks"
    return Sweep(replace(sweep.plan, output=output, cases=seconds, then=None), sweep.program)


def _has_ended(sweep: Sweep, case: Case) -> bool:
    """Return whether the first run of a case has ended with a checkpoint."""
    record = read_record(sweep.folder(case))
    return record is not None and record.exit_code == EXIT_DONE and checkpoint_in(sweep.folder(case)) is not None


def _second(case: Case, checkpoint: Path, then: Path, text: str) -> Case:
    """Return the second run of a case, which begins from a checkpoint."""
    name = then.name
    text = copy_groups(case.deck, text, SHARED, name)
    paths = {path: value for key, value in case.values.items() if (path := key_path(key))}
    settings = {path: deck_value(value) for path, value in paths.items()
                if path.group in _SET_TOO and path.key.lower() not in _OWN_KEYS}
    begun = key_path("initial_state.from")
    if begun is None:
        raise DeckError(f"{name}: no &initial_state.")
    settings[begun] = deck_value(str(checkpoint.absolute()))
    return Case(case.number, case.values, name, set_keys(text, settings, name), case.repeat)


def add_figures(table: Table, first: Sweep, second: Sweep) -> None:
    """Add the figures of the second runs to the table of the first; cells without a value are NaN or empty.

    The notes name summaries that cannot be read.
    """
    by_number = {case.number: case for case in second.plan.cases}
    rows = [_figures(second, by_number[case.number], table) if case.number in by_number else {}
            for case in first.plan.cases]
    add_columns(table, rows, [name for name, figure in FIGURES.items() if figure.is_of_second])
    if any(FIGURES["peak_force"].member in row for row in rows):
        for name in _OF_IMPACTS:
            values = (row.get(FIGURES[name].member) for row in rows)
            table.columns[f"second_{name}"] = [math.nan if value is None else value for value in values]
    for name in RUN_COLUMNS:  # the last ones
        table.columns[name] = table.columns.pop(name)


def lower_bounds(table: Table) -> np.ndarray:
    """Return for each row whether its strength is a lower bound, as the plate has not failed."""
    return np.array([value == "false" for value in table.columns.get("has_failed", ())])


def remark_of_bounds(table: Table) -> str:
    """Return the warning about runs that end before the plate fails; empty if there are none."""
    count = int(np.count_nonzero(lower_bounds(table)))
    return "" if count == 0 else (
        f"warning: in {counted(count, 'run')} of {len(lower_bounds(table))} the plate has not failed: the "
        "strength is a lower bound, and so are means; give the &line of the second deck a larger displacement.")


def _figures(sweep: Sweep, case: Case, table: Table) -> Mapping[str, object]:
    """Return the figures of a run; empty without a result, with a note if its summary cannot be read."""
    if sweep.failure(case):
        return {}
    try:
        return figures_in(sweep.folder(case))
    except ImplamError as error:
        note, table.is_readable = no_figures(error), False
        if note not in table.notes:
            table.notes.append(note)
        return {}
