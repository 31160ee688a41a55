"""One page a run (`implam-report NAME_summary.json`): what it says, with curves and maps, in one HTML file."""

import argparse
import json
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from implam_post.errors import EXIT_DONE, CommandParser, FileError, run
from implam_post.fields import read_fields
from implam_post.files import read_text, write_text
from implam_post.history import read_history
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
# Rows of the table at the top: label, member, member with its time.
_FIGURES = (
    ("peak force", "peak_force", "peak_force_at"),
    ("contacts", "contacts", None),
    ("time in contact", "contact_duration", "contact_until"),
    ("rebound velocity", "rebound_velocity", None),
    ("velocity of the impactor at the end", "impactor_velocity", None),
    ("largest deflection", "largest_deflection", "largest_deflection_at"),
    ("impact energy", "energy_impact", None),
    ("absorbed energy", "energy_absorbed", None),
    ("work of the load", "work_external", None),
    ("delaminated area, all interfaces", "delaminated_area", None),
    ("delaminated area, projected", "projected_area", None),
    ("closed form of the force at the starter", "threshold_force_at_starter", None),
    ("fibre failures, plies of elements", "fibre_failures", None),
    ("matrix cracks, plies of elements", "matrix_cracks", None),
    ("matrix crushings, plies of elements", "matrix_crushings", None),
)
_LEDGER = (
    ("kinetic energy of the impactor", "energy_impactor"),
    ("kinetic energy of the plate", "energy_kinetic"),
    ("strain energy", "energy_strain"),
    ("indentation", "energy_indentation"),
    ("delamination", "energy_delamination"),
    ("ply damage", "energy_ply_damage"),
    ("contact of faces", "energy_contact"),
    ("friction", "energy_friction"),
    ("integrators", "energy_algorithmic"),
    ("not accounted for", "energy_error"),
)
_PROVENANCE = ("version", "commit", "compiler", "petsc_version", "ranks", "started")


def number(value: object) -> str:
    """Return a number rounded to four digits; a dash for what is not there."""
    if value is None:
        return "-"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return str(value) if isinstance(value, int) else f"{value:.4g}"


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
    title = summary["title"] or summary["case"]
    parts = [f"<h1>{escape(title)}</h1>", _ending(summary), "<h2>Summary</h2>", _figures(summary)]
    if summary.get("interfaces"):
        parts += ["<h2>Interfaces</h2>", _interfaces(summary)]
    parts += ["<h2>Plate and lay-up</h2>", _plate(summary)]
    parts += ["<h2>Curves</h2>", _curves(base), "<h2>Maps</h2>", _maps(base)]
    parts += ["<h2>Energy ledger at the end</h2>", table((), [(name, summary[key]) for name, key in _LEDGER
                                                           if key in summary])]
    parts += ["<h2>Warnings</h2>", _warnings(summary), "<h2>Provenance</h2>", _provenance(summary)]
    parts += ["<h2>Deck</h2>", f"<pre>{escape(summary['provenance']['deck'])}</pre>"]
    body = "\n".join(parts)
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
            f"<style>{_STYLE}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n")


def _ending(summary: Mapping[str, Any]) -> str:
    """Return how the run ended."""
    ending = summary["exit"]
    reached = f"time {number(summary['time_reached'])}" if "time_reached" in summary else (
        f"load factor {number(summary['load_factor_reached'])}")
    units = f"Units: {summary['units']}." if summary.get("units") else "Units are those of the deck."
    return (f'<p>Case {escape(summary["case"])}: <strong class="{escape(ending["kind"])}">{escape(ending["kind"])}'
            f"</strong> at {reached} after {summary['accepted_steps']} steps. {escape(ending['message'])} "
            f"{escape(units)}</p>")


def _figures(summary: Mapping[str, Any]) -> str:
    """Return the table at the top."""
    rows = []
    for name, key, at in _FIGURES:
        if key in summary and not (key == "work_external" and not summary[key]):
            rows.append((name, summary[key], f"at {number(summary[at])}" if at else ""))
    if summary.get("in_contact"):
        rows.append(("contact at the end", "yes", ""))
    return table((), rows)


def _event(event: Mapping[str, float] | None) -> str:
    """Return when something was first seen, and under what force."""
    if event is None:
        return "none"
    force = f"{number(event['force'])} " if "force" in event else ""
    return f"{force}at {number(event['at'])}"


def _interfaces(summary: Mapping[str, Any]) -> str:
    """Return the table of interfaces."""
    head = ("below ply", "law", "area", "x", "y", "energy", "onset", "first growth", "closed form", "border reached")
    return table(head, [
        (entry["ply_above"], "cohesive" if entry["is_cohesive"] else "front", entry["area"],
         " to ".join(map(number, entry["x"])), " to ".join(map(number, entry["y"])), entry["energy"],
         _event(entry["onset"]), _event(entry["first_growth"]), entry["threshold_force"],
         "yes" if entry["border_reached"] else "no") for entry in summary["interfaces"]])


def _plate(summary: Mapping[str, Any]) -> str:
    """Return size, lay-up and failures of the plies."""
    along, across = summary["plate_size"]
    thickness = sum(ply["thickness"] for ply in summary["plies"])
    areas = [key for key in ("fibre_failure_area", "matrix_crack_area", "matrix_crushing_area")
             if key in summary["plies"][0]]
    head = ("ply", "material", "angle", "thickness", *(key.replace("_", " ") for key in areas))
    rows = [(ply["ply"], ply["made_of"], ply["angle"], ply["thickness"], *(ply[key] for key in areas))
            for ply in summary["plies"]]
    return "\n".join([f"<p>{number(along)} by {number(across)}, {number(thickness)} thick, {len(rows)} plies.</p>",
                      picture(plan_figure(summary), "plate in plan"),
                      picture(layup_figure(summary), "lay-up from the struck face"), table(head, rows)])


def _curves(base: Path) -> str:
    """Return the curves of the history, or why there are none."""
    path = base.with_name(f"{base.name}_history.csv")
    if not path.exists():
        return f"<p>There is no {escape(path.name)}.</p>"
    return "\n".join(picture(figure, text) for text, figure in history_pictures(read_history(path)))


def _maps(base: Path) -> str:
    """Return what the fields show in plan, or why there is nothing."""
    path = base.with_name(f"{base.name}.h5")
    if not path.exists():
        return f"<p>There is no {escape(path.name)}.</p>"
    pictures = [picture(figure, text) for text, figure in map_pictures(read_fields(path))]
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
    base = path.with_name(path.name.removesuffix(_ENDING))
    page = (output or path.parent) / f"{base.name}_report.html"
    summary = read_summary(path)
    try:
        text = report(summary, base)
    except KeyError as error:
        raise FileError(f"the summary {path} lacks {error}: another version of implam wrote it.") from None
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
