"""One page a run (`implam-report NAME_summary.json`): what it says, with curves and maps, in one HTML file."""

import argparse
import json
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from implam_post.deck import Deck
from implam_post.errors import EXIT_DONE, CommandParser, FileError, ImplamError, run
from implam_post.fields import read_fields
from implam_post.files import read_text, write_text
from implam_post.history import ENERGY_NAMES, UNACCOUNTED, read_history
from implam_post.look import Look, system_of_deck
from implam_post.report_pictures import as_image, history_pictures, layup_figure, map_pictures, plan_figure

_ENDING = "_summary.json"
_STYLE = """
body { font-family: sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; margin: .6em 0; }
td, th { border-bottom: 1px solid #ccc; padding: .2em .8em .2em 0; text-align: left; vertical-align: top; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
img { max-width: 100%; } pre { background: #f4f4f4; padding: .8em; overflow-x: auto; }
.done { color: #176117; } .stopped, .failed, .warning { color: #a01010; }
"""
# Rows of the table at the top: label, member, its dimension, member with its time.
_FIGURES = (
    ("peak force", "peak_force", "force", "peak_force_at"),
    ("contacts", "contacts", "", None),
    ("time in contact", "contact_duration", "time", "contact_until"),
    ("rebound velocity", "rebound_velocity", "velocity", None),
    ("velocity of the impactor at the end", "impactor_velocity", "velocity", None),
    ("largest deflection", "largest_deflection", "length", "largest_deflection_at"),
    ("impact energy", "energy_impact", "energy", None),
    ("absorbed energy", "energy_absorbed", "energy", None),
    ("work of the load", "work_external", "energy", None),
    ("delaminated area, all interfaces", "delaminated_area", "area", None),
    ("delaminated area, projected", "projected_area", "area", None),
    ("closed form of the force at the starter", "threshold_force_at_starter", "force", None),
    ("fibre failures, plies of elements", "fibre_failures", "", None),
    ("matrix cracks, plies of elements", "matrix_cracks", "", None),
    ("matrix crushings, plies of elements", "matrix_crushings", "", None),
)
# Words before a time, and what a missing figure means.
_WHEN = {"contact_duration": "until"}
_UNKNOWN = {"energy_absorbed": "contact has not ended"}
_PROVENANCE = ("version", "commit", "compiler", "petsc_version", "ranks", "started")


def number(value: object) -> str:
    """Return a number rounded to four digits; a dash for what is not there."""
    if value is None:
        return "-"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return str(value) if isinstance(value, int) else f"{value:.4g}"


def said(look: Look, dimension: str, value: object) -> str:
    """Return a figure to four digits, as the summary in the log has them, with its unit where that is known."""
    if value is None or not dimension:
        return number(value)
    return look.said(dimension, value, 4)


def look_of_summary(summary: Mapping[str, Any]) -> Look:
    """Return the units of a run, those that its deck tells."""
    try:
        return Look(system_of_deck(Deck(summary["provenance"]["deck"], Path(f"{summary['case']}.nml"))))
    except ImplamError:
        return Look()


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table; numbers stand on the right."""
    def cell(tag: str, value: object) -> str:
        kind = ' class="number"' if isinstance(value, (int, float)) else ""
        return f"<{tag}{kind}>{escape(number(value))}</{tag}>"

    lines = ["<table>"]
    if head:
        lines.append("<tr>" + "".join(cell("th", name) for name in head) + "</tr>")
    lines += ["<tr>" + "".join(cell("td", value) for value in row) + "</tr>" for row in rows]
    return "\n".join([*lines, "</table>"])


def picture(figure: Figure, text: str) -> str:
    """Return a figure as an image within the page."""
    return f'<p><img alt="{escape(text)}" src="data:image/png;base64,{as_image(figure)}"></p>'


def read_summary(path: Path) -> dict[str, Any]:
    """Read what a run says."""
    try:
        summary = json.loads(read_text(path, "the summary"))
    except ValueError as error:
        raise FileError(f"{path} isn't a summary written by implam ({error}).") from None
    if not isinstance(summary, dict) or not {"case", "exit", "plies", "provenance"} <= summary.keys():
        raise FileError(f"{path} isn't a summary written by implam.")
    return summary


def report(summary: Mapping[str, Any], base: Path) -> str:
    """Return the page of a run whose history and fields have a path that begins with `base`."""
    title, look = summary["title"] or summary["case"], look_of_summary(summary)
    parts = [f"<h1>{escape(title)}</h1>", _ending(summary, look), "<h2>Summary</h2>", _figures(summary, look)]
    if summary.get("interfaces"):
        parts += ["<h2>Interfaces</h2>", _interfaces(summary, look)]
    parts += ["<h2>Plate and lay-up</h2>", _plate(summary, look)]
    parts += ["<h2>Curves</h2>", _curves(base, look), "<h2>Maps</h2>", _maps(base, look)]
    parts += ["<h2>Energy ledger at the end</h2>", _ledger(summary, look)]
    parts += ["<h2>Warnings</h2>", _warnings(summary), "<h2>Provenance</h2>", _provenance(summary)]
    parts += ["<h2>Deck</h2>", f"<pre>{escape(summary['provenance']['deck'])}</pre>"]
    body = "\n".join(parts)
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
            f"<style>{_STYLE}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n")


def _ledger(summary: Mapping[str, Any], look: Look) -> str:
    """Return the energies at the end in one unit, under the names that summary and legends have."""
    energies = {name: summary[key] for key, name in (ENERGY_NAMES | {"energy_error": UNACCOUNTED}).items()
                if key in summary}
    axis = look.axis("energy", "energy", [*energies.values()])
    return table(("", axis.label), [(name, axis.factor * value) for name, value in energies.items()])


def _time(summary: Mapping[str, Any]) -> str:
    """Return the dimension of the times of a run, none if they are load factors."""
    return "time" if "time_reached" in summary else ""


def _ending(summary: Mapping[str, Any], look: Look) -> str:
    """Return how the run ended."""
    ending = summary["exit"]
    reached = f"time {said(look, 'time', summary['time_reached'])}" if "time_reached" in summary else (
        f"load factor {number(summary['load_factor_reached'])}")
    units = "" if look.system else "Units are those of the deck."
    return (f'<p>Case {escape(summary["case"])}: <strong class="{escape(ending["kind"])}">{escape(ending["kind"])}'
            f"</strong> at {escape(reached)} after {summary['accepted_steps']} steps. {escape(ending['message'])} "
            f"{units}</p>")


def _figures(summary: Mapping[str, Any], look: Look) -> str:
    """Return the table at the top."""
    rows = []
    for name, key, dimension, at in _FIGURES:
        if key in summary and not (key == "work_external" and not summary[key]):
            value = _UNKNOWN.get(key, "-") if summary[key] is None else said(look, dimension, summary[key])
            when = f"{_WHEN.get(key, 'at')} {said(look, _time(summary), summary[at])}" if at else ""
            rows.append((name, value, when))
    if summary.get("in_contact"):
        rows.append(("contact at the end", "yes", ""))
    return table((), rows)


def _range(look: Look, ends: Sequence[float]) -> str:
    """Return least and greatest coordinate in one unit."""
    if not any(ends):
        return "none"
    axis = look.axis("", "length", ends)
    unit = said(look, "length", max(ends, key=abs)).partition(" ")[2]
    return " to ".join(number(axis.factor * end) for end in ends) + f" {unit}".rstrip()


def _event(event: Mapping[str, float] | None, look: Look, time: str) -> str:
    """Return when something was first seen, and under what force."""
    if event is None:
        return "none"
    force = f"{said(look, 'force', event['force'])} " if "force" in event else ""
    return f"{force}at {said(look, time, event['at'])}"


def _interfaces(summary: Mapping[str, Any], look: Look) -> str:
    """Return the table of interfaces."""
    head = ("below ply", "law", "area", "x", "y", "energy", "onset", "first growth", "closed form", "border reached")
    time = _time(summary)
    return table(head, [
        (entry["ply_above"], "cohesive" if entry["is_cohesive"] else "front", said(look, "area", entry["area"]),
         _range(look, entry["x"]), _range(look, entry["y"]), said(look, "energy", entry["energy"]),
         _event(entry["onset"], look, time), _event(entry["first_growth"], look, time),
         said(look, "force", entry["threshold_force"]),
         "yes" if entry["border_reached"] else "no") for entry in summary["interfaces"]])


def _plate(summary: Mapping[str, Any], look: Look) -> str:
    """Return size, lay-up and failures of the plies."""
    along, across = (said(look, "length", length) for length in summary["plate_size"])
    thickness = said(look, "length", sum(ply["thickness"] for ply in summary["plies"]))
    areas = [key for key in ("fibre_failure_area", "matrix_crack_area", "matrix_crushing_area")
             if key in summary["plies"][0]]
    head = ("ply", "material", "angle, degrees", "thickness", *(key.replace("_", " ") for key in areas))
    rows = [(ply["ply"], ply["made_of"], ply["angle"], said(look, "length", ply["thickness"]),
             *(said(look, "area", ply[key]) for key in areas)) for ply in summary["plies"]]
    return "\n".join([f"<p>{along} by {across}, {thickness} thick, {len(rows)} plies.</p>",
                      picture(plan_figure(summary, look), "plate in plan"),
                      picture(layup_figure(summary), "lay-up from the struck face"), table(head, rows)])


def _curves(base: Path, look: Look) -> str:
    """Return the curves of the history, or why there are none."""
    path = base.with_name(f"{base.name}_history.csv")
    if not path.exists():
        return f"<p>There is no {escape(path.name)}.</p>"
    return "\n".join(picture(figure, text) for text, figure in history_pictures(read_history(path), look))


def _maps(base: Path, look: Look) -> str:
    """Return what the fields show in plan, or why there is nothing."""
    path = base.with_name(f"{base.name}.h5")
    if not path.exists():
        return f"<p>There is no {escape(path.name)}.</p>"
    pictures = [picture(figure, text) for text, figure in map_pictures(read_fields(path), look)]
    return "\n".join(pictures) or "<p>The fields hold neither interfaces nor failures of plies.</p>"


def _warnings(summary: Mapping[str, Any]) -> str:
    """Return the warnings."""
    if not summary["warnings"]:
        return "<p>None.</p>"
    items = "\n".join(f'<li class="warning">{escape(warning["text"])}</li>' for warning in summary["warnings"])
    return f"<ul>\n{items}\n</ul>"


def _provenance(summary: Mapping[str, Any]) -> str:
    """Return where the result comes from and what it took."""
    rows = [(key.replace("_", " "), str(summary["provenance"][key])) for key in _PROVENANCE]
    return table((), rows + [(key.replace("_", " "), value) for key, value in summary["costs"].items()])


def summaries_at(path: Path) -> list[Path]:
    """Return the summaries of a folder, or the one that a path names."""
    if not path.is_dir():
        return [path]
    found = sorted(path.glob(f"*{_ENDING}"))
    if not found:
        raise FileError(f"{path} holds no summary of a run ({_ENDING.removeprefix('_')}).")
    return found


def write_report(path: Path, output: Path | None) -> Path:
    """Write the page of a summary and return its path."""
    if not path.name.endswith(_ENDING):
        raise FileError(f"{path} isn't NAME{_ENDING}; a report is made of that file, or of the folder that holds it.")
    base = path.with_name(path.name.removesuffix(_ENDING))
    page = (output or path.parent) / f"{base.name}_report.html"
    summary = read_summary(path)
    try:
        text = report(summary, base)
    except KeyError as error:
        raise FileError(f"the summary {path} lacks {error}: another version of implam wrote it.") from None
    except (TypeError, ValueError, IndexError, AttributeError) as error:
        raise FileError(f"{path} isn't a summary written by implam, or it is damaged ({error}).") from None
    write_text(page, text)
    return page


def _command(options: argparse.Namespace) -> int:
    """Write a page for each run."""
    for given in options.results:
        for path in summaries_at(given):
            print(write_report(path, options.output))
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-report", description="Write NAME_report.html, one page that needs no other file: "
                           "the summary of a run, its plate and lay-up, curves of NAME_history.csv, maps of NAME.h5, "
                           "the ledger, warnings, provenance and the deck.")
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT",
                        help="NAME_summary.json, or a folder with such files")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of the pages (default: beside each summary)")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
