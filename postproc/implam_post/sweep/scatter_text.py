"""Statistics of runs with random inputs as text and as rows of tables, in suitable units."""

from collections.abc import Callable, Iterator, Mapping, Sequence

from implam_post.plot.style import PictureStyle
from implam_post.sweep.plan import Plan
from implam_post.sweep.scatter_results import ComparedMean, Group, against_measured, pairs_of
from implam_post.sweep.scatter_statistics import Difference, Spread, spreads

# Figures that are printed; the files contain all figures.
SHOWN = ("peak_force", "peak_force_at", "threshold_force", "largest_displacement", "largest_deflection",
         "contact_duration", "rebound_velocity", "energy_absorbed", "first_growth_force", "delaminated_area",
         "projected_area", "damage_diameter", "damage_length", "damage_width", "residual_strength",
         "shortening_at_strength", "effective_modulus", "buckling_strain", "percent_bending")
# Figures in the table that compares variants.
COMPARED = ("peak_force", "largest_displacement", "contact_duration", "energy_absorbed", "projected_area",
            "damage_diameter", "residual_strength", "effective_modulus")
HEAD = ("", "mean", "standard error", "standard deviation", "5 % point", "95 % point", "runs")
PAIRED = ("", "first", "difference", "smallest significant", "", "pairs")
MEASURED = ("", "measured", "tolerance", "mean", "standard error", "difference", "")


def statistics_text(plan: Plan, groups: Sequence[Group], style: PictureStyle) -> str:
    """Return the text printed at the end of a sweep."""
    parts = []
    for group in groups:
        seconds = sum(run.seconds for run in group.ended)
        parts += [f"\n{group.name or 'Statistics'}: {len(group.ended)} of {len(group.runs)} runs, {seconds:.4g} s of "
                  "the processor", *_lines(HEAD, spread_rows(spreads(group.numbers), group.dimensions, style, SHOWN))]
        if plan.measured is not None and (rows := against_measured(group, plan.measured)):
            parts += ["", *_lines(MEASURED, measured_rows(rows))]
    if len(groups) > 1:
        parts += ["\nMeans ± standard errors; * marks a significant difference from the first variant (5 % level)",
                  markdown(variants_table(groups, style))]
    for group, found in pairs_of(groups):
        parts += [f"\n{group.name} compared with {groups[0].name}, pairs of runs with the same random inputs",
                  *_lines(PAIRED, difference_rows(found, group.dimensions, style, SHOWN))]
    return "\n".join(parts)


def variants_table(groups: Sequence[Group], style: PictureStyle) -> list[tuple[str, ...]]:
    """Return a head, and a row for each variant: means and standard errors of the figures compared.

    A star marks a significant difference from the first variant.
    """
    paired = {id(group): found for group, found in pairs_of(groups)}
    found_of = [(group, spreads(group.numbers)) for group in groups]
    names = [name for name in COMPARED if any(name in found and found[name].number for _, found in found_of)]
    axes = {name: style.axis(words_of(name), _dimension(groups, name), [
        found[name].mean for _, found in found_of if name in found]) for name in names}
    rows = [("", "runs", *(axes[name].label.replace(" [", ", ").rstrip("]") for name in names))]
    for group, found in found_of:
        cells = []
        for name in names:
            if name not in found or not found[name].number:
                cells.append("-")
                continue
            star = " *" if name in paired.get(id(group), {}) and paired[id(group)][name].differs else ""
            mean, error = (axes[name].factor * value for value in (found[name].mean, found[name].error))
            cells.append(f"{_rounded(mean, 4)}{'' if error != error else f' ± {_rounded(error, 2)}'}{star}")
        rows.append((group.name, str(len(group.ended)), *cells))
    return rows


def _dimension(groups: Sequence[Group], name: str) -> str:
    """Return the dimension of a figure, from any group that has it."""
    return next((group.dimensions[name] for group in groups if name in group.dimensions), "")


def markdown(rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    return "\n".join(f"| {' | '.join(row)} |" for row in [rows[0], ["---"] * len(rows[0]), *rows[1:]])


def spread_rows(found: Mapping[str, Spread], dimensions: Mapping[str, str], style: PictureStyle,
                names: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Yield a row for each figure: mean, standard error, standard deviation, 5 and 95 % points, number of runs."""
    for name in names:
        if name in found and found[name].number:
            one = found[name]
            shown = _formatter(style, dimensions.get(name, ""), one.mean, one.high)
            deviation = f"{shown(one.deviation, 3)}{_percent(one.deviation, one.mean)}"
            yield (words_of(name), shown(one.mean), shown(one.error, 2), deviation, shown(one.low), shown(one.high),
                   str(one.number))


def difference_rows(found: Mapping[str, Difference], dimensions: Mapping[str, str], style: PictureStyle,
                    names: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Yield a row for each figure: mean of the first variant, difference, smallest significant one, and verdict."""
    for name in names:
        if name in found and found[name].number:
            one = found[name]
            shown = _formatter(style, dimensions.get(name, ""), one.first, one.mean)
            verdict = "differs" if one.differs else "equal" if one.number > 1 else "not known from one pair"
            yield (words_of(name), shown(one.first), f"{shown(one.mean, 3)}{_percent(one.mean, one.first)}",
                   shown(one.least, 2), verdict, str(one.number))


def measured_rows(rows: Sequence[ComparedMean]) -> Iterator[tuple[str, ...]]:
    """Yield a row for each measured value: value, tolerance, mean, standard error, difference, within or beyond."""
    for row in rows:
        expected, found = row.expected, row.found
        aim = f"{100 * expected.relative:.3g} %" if expected.relative is not None else f"{expected.absolute:.3g}"
        off = f"{100 * (found.mean / expected.value - 1):+.1f} %" if expected.value else f"{found.mean:.3g}"
        yield (expected.label, f"{expected.value:.4g}", aim, _number(found.mean), _number(found.error), off,
               row.verdict)


def words_of(name: str) -> str:
    """Return the name of a figure with spaces."""
    return name.replace("_", " ")


def _formatter(style: PictureStyle, dimension: str, *values: float) -> Callable[..., str]:
    """Return a function that formats values in a unit suitable for the largest of them."""
    axis = style.axis("", dimension, values)
    unit = axis.label.strip(" []") if style.system and dimension else ""
    return lambda value, digits=4: "-" if value != value else f"{_rounded(axis.factor * value, digits)} {unit}".strip()


def _rounded(value: float, digits: int) -> str:
    """Return a number to some digits, large numbers as integers."""
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e+" in text and abs(value) < 1e6 else text


def _percent(part: float, total: float) -> str:
    """Return a part of a total in per cent, in brackets; empty if it is not defined."""
    return "" if part != part or not total else f" ({100 * part / abs(total):.3g} %)"


def _number(value: float) -> str:
    """Return a number to four digits; a dash for NaN."""
    return "-" if value != value else f"{value:.4g}"


def _lines(head: Sequence[str], rows: Iterator[tuple[str, ...]]) -> list[str]:
    """Return a table as lines of text, with the first column left-aligned."""
    table = [tuple(head), *rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    return ["  ".join(cell.ljust(width) if place == 0 else cell.rjust(width)
                      for place, (cell, width) in enumerate(zip(row, widths, strict=True))).rstrip() for row in table]
