"""The page of a sweep with random inputs: means and their scatter instead of single runs."""

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from implam_post.io.errors import FileError, reason
from implam_post.io.files import read_text, write_text
from implam_post.io.summary_shape import OrNull, misshapen
from implam_post.plot.style import PictureStyle
from implam_post.report.page import image_of, render
from implam_post.sweep.scatter_plots import BAND, SHARE
from implam_post.sweep.scatter_results import STATISTICS, verdict_of
from implam_post.sweep.scatter_statistics import Difference, Spread
from implam_post.sweep.scatter_text import HEAD, PAIRED, SHOWN, difference_rows, spread_rows

_FIGURE = OrNull(float)
_STATISTICS = {
    "title": str, "system": str, "sweep": str, "notes": [str],
    "groups": [{"name": str, "ended": int, "runs": int, "seconds": float}],
    "statistics": [{"group": str, "figure": str, "dimension": str, "runs": int, "mean": _FIGURE, "deviation": _FIGURE,
                    "low_5": _FIGURE, "high_95": _FIGURE}],
    "inputs": [{"input": str, "kind": str, "variation": float, "source": str}], "variants": [list]}
_DIFFERENCE = {"group": str, "figure": str, "pairs": int, "first": _FIGURE, "difference": _FIGURE,
               "error_of_mean": _FIGURE, "differs": int}
_MEASURED = {"group": str, "figure": str, "measured": _FIGURE, "aim": _FIGURE, "mean": _FIGURE,
             "error_of_mean": _FIGURE, "within": int}


def write_page(folder: Path, output: Path | None) -> Path:
    """Write the page of a sweep to its folder or another one, and return its path."""
    path = folder / STATISTICS
    try:
        content = json.loads(read_text(path, "the statistics"))
    except ValueError as error:
        raise FileError(f"{path} was not written by implam-sweep, or is damaged ({error}).") from None
    if wrong := misshapen(content, _STATISTICS, "") or _misshapen_tables(content):
        raise FileError(f"{path} was not written by implam-sweep, or is damaged ({wrong.removeprefix('.')}).")
    try:
        text = _page(content, folder)
    except OSError as error:
        raise FileError(f"a picture of {folder} cannot be read ({reason(error)}).") from None
    written = (output or folder) / f"{folder.absolute().name}_report.html"
    write_text(written, text)
    return written


def _misshapen_tables(content: Mapping[str, Any]) -> str:
    """Return an optional table of the wrong kind; empty if there is none."""
    if not content["groups"]:
        return "groups"
    return (misshapen(content.get("differences", []), [_DIFFERENCE], "differences")
            or misshapen(content.get("measured", []), [_MEASURED], "measured"))


def _page(content: Mapping[str, Any], folder: Path) -> str:
    """Return the page."""
    style, statistics = PictureStyle(content["system"]), content["statistics"]
    runs = ", ".join(f"{group['ended']} of {group['runs']} runs{_of(group['name'])} in {group['seconds']:.4g} s of the "
                     "processor" for group in content["groups"])
    pictures = [(text, image_of(folder / name)) for name, text in (
        (BAND, "Force history"), (SHARE, "Fraction of runs with delamination"))
        if (folder / name).exists()]
    differences = [] if not content.get("differences") else [
        (group["name"], _differences(_rows_of(content["differences"], group), statistics, style))
        for group in content["groups"][1:]]
    return render("sweep.html", title=content["title"] or "Runs with random inputs", runs=runs, notes=content["notes"],
                  variants=content["variants"], head=HEAD, paired=PAIRED, first=content["groups"][0]["name"],
                  groups=[_group(group, content, style) for group in content["groups"]], differences=differences,
                  pictures=pictures, inputs=_inputs(content["inputs"]), sweep=content["sweep"])


def _group(group: Mapping[str, Any], content: Mapping[str, Any], style: PictureStyle) -> dict[str, object]:
    """Return the tables of a group: the figures shown, all figures, and measured values."""
    rows = _rows_of(content["statistics"], group)
    measured = [(row["figure"], row["measured"], row["aim"], row["mean"], row["error_of_mean"],
                 verdict_of(row["mean"], row["within"])) for row in _rows_of(content.get("measured", []), group)]
    return {"of": _of(group["name"]), "shown": _spreads(rows, style, SHOWN), "measured": measured,
            "all": _spreads(rows, style, [row["figure"] for row in rows])}


def _rows_of(rows: Iterable[Mapping[str, Any]], group: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the rows of a group."""
    return [row for row in rows if row["group"] == group["name"]]


def _of(name: str) -> str:
    """Return ' of NAME' for a group with a name."""
    return f" of {name}" if name else ""


def _number(value: float | None) -> float:
    """Return a number; NaN for None."""
    return math.nan if value is None else value


def _spreads(rows: Iterable[Mapping[str, Any]], style: PictureStyle, names: Iterable[str]) -> list[tuple[str, ...]]:
    """Return the rows of means."""
    keys = ("mean", "deviation", "low_5", "high_95")
    found = {row["figure"]: Spread(row["runs"], *(_number(row[key]) for key in keys)) for row in rows}
    return [*spread_rows(found, {row["figure"]: row["dimension"] for row in rows}, style, list(names))]


def _differences(rows: Iterable[Mapping[str, Any]], statistics: Iterable[Mapping[str, Any]], style: PictureStyle
                 ) -> list[tuple[str, ...]]:
    """Return the rows of differences."""
    found = {row["figure"]: Difference(row["pairs"], *(_number(row[key]) for key in (
        "first", "difference", "error_of_mean"))) for row in rows}
    return [*difference_rows(found, {row["figure"]: row["dimension"] for row in statistics}, style, SHOWN)]


def _inputs(rows: Iterable[Mapping[str, Any]]) -> list[tuple[str, ...]]:
    """Return the rows of the random inputs."""
    def variation(row: Mapping[str, Any]) -> str:
        value = row["variation"]
        return f"{value:.3g} (the deck's units)" if row["kind"] == "place" else f"{100 * value:.3g} %"

    return [(row["input"], row["kind"], variation(row), row["source"]) for row in rows]
