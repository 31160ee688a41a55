"""Accept the results of a run as expected values."""

import itertools
import math
import re
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from implam_post.io.errors import FileError
from implam_post.io.files import read_text, write_text
from implam_post.io.history import History
from implam_post.io.quantities import QUANTITIES
from implam_post.regress.compare import Comparison
from implam_post.regress.expectations import Expectation, Expectations, parse_expectations

# Figures of a new file of expectations; those that the history does not have are omitted.
_FIGURES = ("peak_force", "max_deflection", "rebound_velocity", "absorbed_energy", "first_growth_force")
_TIMES = ("peak_force_time", "contact_duration")
_COLUMNS = ("delaminated_area", "fibre_failures", "matrix_cracks", "matrix_crushings")
RELATIVE, OF_A_STEP, MIN_ERROR = 1e-3, 0.1, 1e-6
_HEADER = re.compile(r"\s*\[\[\s*(expect|variant|variant\s*\.\s*expect)\s*\]\]")
_NUMBER = r"(\s*{key}\s*=\s*)([-+\w.]+)(.*)"


def accept(expectations: Expectations, comparisons: Sequence[Sequence[Comparison]]) -> list[str]:
    """Replace expected values that are not met by the values found; return a line for each change.

    `comparisons` are those of each variant. Entries that are met, comments and all other text are kept.
    """
    common = len(expectations.common)
    found: dict[tuple[int, int], list[Comparison]] = {
        (-1, entry): [of_variant[entry] for of_variant in comparisons] for entry in range(common)}
    for variant, of_variant in enumerate(comparisons):
        found |= {(variant, entry): [comparison] for entry, comparison in enumerate(of_variant[common:])}
    changes = {place: _accepted(entries) for place, entries in found.items()
               if not all(comparison.passed for comparison in entries)}
    text = read_text(expectations.path, "the expectations")
    changed = _change(text, {place: (found[place][0].expected, new) for place, new in changes.items()})
    if _all_entries(expectations.path, changed) != {
            place: changes.get(place, entries[0].expected) for place, entries in found.items()}:
        raise FileError("its entries are not [[expect]] tables with each key on its own line.")
    write_text(expectations.path, changed)
    names = [variant.name for variant in expectations.variants]
    return [_change_text(found[place][0].expected, new, names[place[0]] if place[0] >= 0 and len(names) > 1 else "")
            for place, new in changes.items()]


def accept_new(path: Path, history: History, version: str) -> list[str]:
    """Write a file of expectations with the figures of a run; return lines on the entries."""
    entries = []
    step = float(np.mean(np.diff(history.time))) if len(history.time) > 1 else float(history.time[0])
    pushed = np.any(history["force"] > 0)
    for name in (*_FIGURES, *_TIMES) if pushed else ("max_deflection",):
        value = QUANTITIES[name](history)
        if math.isfinite(value) and value:
            tolerance = {"absolute": _short(OF_A_STEP * step, OF_A_STEP * step)} if name in _TIMES else {}
            entries.append(_entry(name, value, tolerance or {"relative": RELATIVE}))
    entries += [_entry("final", float(history[name][-1]), {"relative": RELATIVE}, name) for name in _COLUMNS
                if name in history.columns and history[name][-1]]
    if pushed:
        error = QUANTITIES["energy_error"](history)
        largest = 10.0**math.ceil(math.log10(10 * error)) if error > 0 else 0.0
        entries.append(_entry("energy_error", 0.0, {"absolute": max(largest, MIN_ERROR)}))
    if not entries:
        raise FileError("the run has no figure that can be expected.")
    text = "\n".join(_written(entry) for entry in entries)
    parse_expectations(path, tomllib.loads(text))
    write_text(path, f"# Accepted from a run of Implam {version}.\n\n{text}")
    listed = [f"{entry.label}: {entry.value:g}, tolerance {_tolerance(entry)}" for entry in entries]
    return [f"written with {len(entries)} figures, tolerance {100 * RELATIVE:g} %, for times {OF_A_STEP:g} of the mean "
            f"step of {step:.3g}", *listed]


def _entry(name: str, value: float, tolerance: dict[str, float], column: str = "") -> Expectation:
    """Return an entry with its value rounded according to the tolerance."""
    entry = Expectation(name, value, column=column, **tolerance)
    return replace(entry, value=_short(value, entry.tolerance))


def _accepted(entries: Sequence[Comparison]) -> Expectation:
    """Return the entry with a value that all variants meet, and with its previous tolerance."""
    expected = entries[0].expected
    values = [comparison.found for comparison in entries]
    if not all(map(math.isfinite, values)):
        raise FileError(f"{expected.label} was not found in the history.")
    value = (min(values) + max(values)) / 2
    new = replace(expected, relative=None, absolute=expected.tolerance) if not value and expected.relative else expected
    new = replace(new, value=_short(value, abs(new.relative * value) if new.absolute is None else new.absolute))
    if not all(Comparison(new, found).passed for found in values):
        raise FileError(f"{expected.label} differs between the variants, from {min(values):.6g} to {max(values):.6g}, "
                        "by more than the tolerance: give it for each variant, in [[variant.expect]].")
    return new


def _short(value: float, tolerance: float) -> float:
    """Return a value rounded to the fewest digits with an error below a hundredth of the tolerance."""
    rounded = (float(f"{value:.{digits}g}") for digits in range(3, 17))
    return next((number for number in rounded if abs(number - value) <= 0.01 * tolerance), value)


def _blocks(lines: Sequence[str]) -> dict[tuple[int, int], range]:
    """Return the lines of each entry, by variant (-1: at the top) and number."""
    found: dict[tuple[int, int], range] = {}
    variant, counts = -1, {}
    starts = [number for number, line in enumerate(lines) if line.lstrip().startswith("[")] + [len(lines)]
    for start, end in itertools.pairwise(starts):
        header = _HEADER.match(lines[start])
        kind = re.sub(r"\s", "", header[1]) if header else ""
        variant += kind == "variant"
        if kind in ("expect", "variant.expect"):
            owner = -1 if kind == "expect" else variant
            counts[owner] = counts.get(owner, -1) + 1
            found[owner, counts[owner]] = range(start + 1, end)
    return found


def _change(text: str, changes: dict[tuple[int, int], tuple[Expectation, Expectation]]) -> str:
    """Return the text of a file with new values, and with new tolerances where they differ."""
    lines = text.splitlines()
    blocks = _blocks(lines)
    for place, (old, new) in changes.items():
        for number in blocks.get(place, ()):
            if match := re.fullmatch(_NUMBER.format(key="value"), lines[number]):
                lines[number] = f"{match[1]}{new.value!r}{match[3]}"
            match = re.fullmatch(_NUMBER.format(key="relative"), lines[number])
            if match and old.relative is not None and new.relative is None:
                lines[number] = f"{match[1].replace('relative', 'absolute')}{new.absolute!r}{match[3]}"
    return "\n".join(lines) + "\n"


def _all_entries(path: Path, text: str) -> dict[tuple[int, int], Expectation]:
    """Return the entries of a text by variant (-1: at the top) and number."""
    parsed = parse_expectations(path, tomllib.loads(text))
    entries = {(-1, number): entry for number, entry in enumerate(parsed.common)}
    for variant, content in enumerate(parsed.variants):
        own = content.expectations[len(parsed.common):]
        entries |= {(variant, number): entry for number, entry in enumerate(own)}
    return entries


def _written(entry: Expectation) -> str:
    """Return an entry as text of the file."""
    tolerance = f"relative = {entry.relative!r}" if entry.absolute is None else f"absolute = {entry.absolute!r}"
    column = f'column = "{entry.column}"\n' if entry.column else ""
    return f'[[expect]]\nquantity = "{entry.quantity}"\n{column}value = {entry.value!r}\n{tolerance}\n'


def _change_text(old: Expectation, new: Expectation, variant: str) -> str:
    """Return a line on the change of an entry."""
    kept = "kept" if old.relative == new.relative else "instead of a relative one"
    where = f"{variant}: " if variant else ""
    return f"{where}{new.label}: {old.value:g} -> {new.value:g}, tolerance {_tolerance(new)} {kept}"


def _tolerance(entry: Expectation) -> str:
    """Return the tolerance as text."""
    return f"relative {entry.relative:g}" if entry.absolute is None else f"absolute {entry.absolute:g}"
