"""The page of a sweep whose runs have random inputs: means with their scatter instead of single runs."""

import json
import math
from collections.abc import Iterable, Mapping
from html import escape
from pathlib import Path
from typing import Any

from implam_post.io.errors import FileError
from implam_post.io.files import read_text, write_text
from implam_post.plot.look import Look
from implam_post.report.html import page, picture_of, table
from implam_post.sweep.scatter_plots import BAND, SHARE
from implam_post.sweep.scatter_results import STATISTICS
from implam_post.sweep.scatter_statistics import Difference, Spread
from implam_post.sweep.scatter_text import HEAD, PAIRED, SHOWN, difference_rows, spread_rows

_READ = ("the points of 5 and 95 % are those of the runs, of fewer than 14 the least and the largest; the standard "
         "error is that of the mean")
_PAIRS = ("Runs of both have the same random inputs. A difference counts as one where it is larger than the scatter of "
          "its mean, the bound that runs of no difference pass once in 20 times; else both are equal as far as these "
          "runs tell.")


def write_page(folder: Path, output: Path | None) -> Path:
    """Write the page of a sweep into its folder or another one, and return its path."""
    path = folder / STATISTICS
    try:
        content = json.loads(read_text(path, "the statistics"))
        text = _page(content, folder)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise FileError(f"{path} isn't written by implam-sweep, or is damaged ({error}).") from None
    except OSError as error:
        raise FileError(f"a picture of {folder} cannot be read ({error}).") from None
    written = (output or folder) / f"{folder.absolute().name}_report.html"
    write_text(written, text)
    return written


def _page(content: Mapping[str, Any], folder: Path) -> str:
    """Return the page."""
    look, title = Look(content["system"]), content["title"] or "Runs with random inputs"
    told = ", ".join(f"{group['ended']} of {group['runs']} runs{_of(group['name'])} in {group['seconds']:.4g} s of the "
                     "processor" for group in content["groups"])
    parts = [f"<h1>{escape(title)}</h1>", f"<p>{escape(told)}; {_READ}.</p>"]
    parts += [f'<p class="warning">{escape(note)}</p>' for note in content["notes"]]
    if content["variants"]:
        head, *rows = content["variants"]
        parts += ["<h2>Side by side</h2>", "<p>Means and standard errors; * differs from the first by more than the "
                  "scatter of the difference.</p>", table(head, rows)]
    for group in content["groups"]:
        rows = [row for row in content["statistics"] if row["group"] == group["name"]]
        parts += [f"<h2>Means{escape(_of(group['name']))}</h2>", _spreads(rows, look, SHOWN),
                  "<details><summary>All figures</summary>", _spreads(rows, look, [row["figure"] for row in rows]),
                  "</details>"]
        measured = [row for row in content.get("measured", []) if row["group"] == group["name"]]
        if measured:
            parts += ["<h3>Beside what was measured, in the deck's units</h3>", _measured(measured)]
    if content.get("differences"):
        first = content["groups"][0]["name"]
        parts += [f"<h2>Differences from {escape(first)}</h2>", f"<p>{_PAIRS}</p>"]
        for group in content["groups"][1:]:
            rows = [row for row in content["differences"] if row["group"] == group["name"]]
            parts += [f"<h3>{escape(group['name'])}</h3>", _differences(rows, content["statistics"], look)]
    for name, text in ((BAND, "Force history"), (SHARE, "Share of the runs in which a place has delaminated")):
        if (folder / name).exists():
            parts += [f"<h2>{text}</h2>", picture_of(folder / name, text)]
    if content["inputs"]:
        parts += ["<h2>Random inputs</h2>", _inputs(content["inputs"])]
    return page(title, [*parts, "<h2>The sweep</h2>", f"<pre>{escape(content['sweep'])}</pre>"])


def _of(name: str) -> str:
    """Return words that name a group."""
    return f" of {name}" if name else ""


def _number(value: float | None) -> float:
    """Return a number, NaN for none."""
    return math.nan if value is None else value


def _spreads(rows: Iterable[Mapping[str, Any]], look: Look, names: Iterable[str]) -> str:
    """Return the table of means."""
    keys = ("mean", "deviation", "low_5", "high_95")
    found = {row["figure"]: Spread(row["runs"], *(_number(row[key]) for key in keys)) for row in rows}
    return table(HEAD, spread_rows(found, {row["figure"]: row["dimension"] for row in rows}, look, list(names)))


def _differences(rows: Iterable[Mapping[str, Any]], statistics: Iterable[Mapping[str, Any]], look: Look) -> str:
    """Return the table of differences."""
    found = {row["figure"]: Difference(row["pairs"], *(_number(row[key]) for key in (
        "first", "difference", "error_of_mean"))) for row in rows}
    return table(PAIRED, difference_rows(found, {row["figure"]: row["dimension"] for row in statistics}, look, SHOWN))


def _measured(rows: Iterable[Mapping[str, Any]]) -> str:
    """Return the table of measured figures."""
    head = ("", "measured", "aimed at, +-", "mean", "standard error", "")
    return table(head, [(row["figure"], row["measured"], row["aim"], row["mean"], row["error_of_mean"],
                         "within" if row["within"] else "beyond") for row in rows])


def _inputs(rows: Iterable[Mapping[str, Any]]) -> str:
    """Return the table of what scatters."""
    def variation(row: Mapping[str, Any]) -> str:
        value = row["variation"]
        return f"{value:.3g} (the deck's units)" if row["kind"] == "place" else f"{100 * value:.3g} %"

    return table(("input", "kind", "coefficient of variation", "where it comes from"),
                 [(row["input"], row["kind"], variation(row), row["source"]) for row in rows])
