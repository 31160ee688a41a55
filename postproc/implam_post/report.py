"""One page a run (`implam-report NAME_summary.json`): what it says, with curves and maps, in one HTML file."""

import argparse
import math
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from implam_post.damage_resistance import DIRECTIONS, extent, kinds_of_damage
from implam_post.errors import EXIT_DONE, CommandParser, FileError, run
from implam_post.files import write_text
from implam_post.history import ENERGY_NAMES, UNACCOUNTED
from implam_post.look import Look
from implam_post.report_html import number, page, picture, table
from implam_post.report_pictures import history_pictures, layup_figure, map_pictures, plan_figure
from implam_post.run_figures import SUMMARY, Measured, Results, corner_of, read_results, resistance
from implam_post.scatter_report import write_page
from implam_post.scatter_results import STATISTICS

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
# Rows of the dent: label, member, remark.
_DENT = (("depth of the dent", "dent_depth", "as the run ends; meant for a plate at rest (&time settle)"),
         ("part of it that the indentation law keeps", "dent_indentation", ""))
# Words before a time, and what a missing figure means.
_WHEN = {"contact_duration": "until"}
_UNKNOWN = {"energy_absorbed": "contact has not ended"}
_PROVENANCE = ("version", "commit", "compiler", "petsc_version", "ranks", "started")


def said(look: Look, dimension: str, value: object) -> str:
    """Return a figure to four digits, as the summary in the log has them, with its unit where that is known."""
    if value is None or not dimension:
        return number(value)
    return look.said(dimension, value, 4)


def report(results: Results, base: Path) -> str:
    """Return the page of a run; `base` is what the names of its results begin with."""
    summary, look = results.summary, Look(results.system)
    title = summary["title"] or summary["case"]
    found = resistance(results)
    parts = [f"<h1>{escape(title)}</h1>", _ending(summary, look), "<h2>Summary</h2>", _figures(summary, look)]
    if "energy_absorbed" in summary and results.history is not None:
        parts += ["<h2>Damage resistance, as ASTM D7136 asks for it</h2>", _resistance(results, found, look)]
    if summary.get("interfaces"):
        parts += ["<h2>Interfaces</h2>", _interfaces(summary, look)]
    parts += ["<h2>Plate and lay-up</h2>", _plate(summary, look)]
    parts += ["<h2>Curves</h2>", _curves(results, found, base, look), "<h2>Maps</h2>", _maps(results, base, look)]
    parts += ["<h2>Energy ledger at the end</h2>", _ledger(summary, look)]
    parts += ["<h2>Warnings</h2>", _warnings(summary), "<h2>Provenance</h2>", _provenance(summary)]
    parts += ["<h2>Deck</h2>", f"<pre>{escape(summary['provenance']['deck'])}</pre>"]
    return page(title, parts)


def _resistance(results: Results, found: Mapping[str, Measured], look: Look) -> str:
    """Return threshold, energies, size and type of the damage."""
    summary = results.summary

    def row(name: str, key: str, missing: str = "-", at: str = "") -> tuple[str, str, str]:
        if key not in found or math.isnan(found[key].value):
            return name, missing, ""
        return name, said(look, found[key].dimension, found[key].value), at

    corner = corner_of(results)
    behind = f", behind a low pass of {_frequency(look, corner)}" if corner else ""
    unknown = "the force never drops by damage" if corner else "not known without units"
    reached = "threshold_at" in found and not math.isnan(found["threshold_at"].value)
    when = f"at {said(look, 'time', found['threshold_at'].value)}" if reached else ""
    rows = [row(f"threshold: force where its curve first drops by damage{behind}", "threshold_force", unknown, when),
            ("peak force", said(look, "force", summary["peak_force"]),
             f"at {said(look, 'time', summary['peak_force_at'])}"),
            row("energy to the threshold", "energy_to_threshold"), row("energy to the peak force", "energy_to_peak"),
            ("absorbed energy", "contact has not ended" if summary["energy_absorbed"] is None
             else said(look, "energy", summary["energy_absorbed"]), "")]
    rows += [(name, said(look, "length", summary[key]), behind) for name, key, behind in _DENT if key in summary]
    if results.fields is not None and "damage_diameter" in found:
        rows += _sizes(results, look)
    kinds = kinds_of_damage(summary)
    rows += [("type of damage" if place == 0 else "", kind, "") for place, kind in enumerate(kinds or ["none"])]
    return table((), rows)


def _frequency(look: Look, corner: float) -> str:
    """Return a frequency with its unit."""
    return f"{corner / look.seconds / 1e3:.4g} kHz" if look.system else number(corner)


def _sizes(results: Results, look: Look) -> list[tuple[str, str, str]]:
    """Return the rows that tell the size of the projected damage."""
    size = extent(results.fields)
    if size is None:
        return [("projected damage", "none", "")]
    rows = [("largest diameter of the projected damage", said(look, "length", size.diameter),
             f"along {size.direction:.0f}°"),
            ("its length along 0°, x", said(look, "length", size.length), ""),
            ("its width along 90°, y", said(look, "length", size.width), "")]
    return rows + [(f"between its outermost points through the struck point, along {angle}°",
                    said(look, "length", size.through[angle]) if size.through[angle] else "none there", "")
                   for angle in DIRECTIONS]


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


def _curves(results: Results, found: Mapping[str, Measured], base: Path, look: Look) -> str:
    """Return the curves of the history, or why there are none."""
    if results.history is None:
        return f"<p>There is no {escape(base.name)}_history.csv.</p>"
    mark = tuple(found[name].value for name in ("threshold_at", "threshold_force")) if "threshold_at" in found else None
    pictures = history_pictures(results.history, look, mark if mark and not math.isnan(mark[0]) else None)
    return "\n".join(picture(figure, text) for text, figure in pictures)


def _maps(results: Results, base: Path, look: Look) -> str:
    """Return what the fields show in plan, or why there is nothing."""
    if results.fields is None:
        return f"<p>There is no {escape(base.name)}.h5.</p>"
    pictures = [picture(figure, text) for text, figure in map_pictures(results.fields, look)]
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
    """Return the summaries of a folder, or the one that a path names; the folder of a sweep stands for itself."""
    if not path.is_dir() or (path / STATISTICS).exists():
        return [path]
    found = sorted(path.glob(f"*{SUMMARY}"))
    if not found:
        raise FileError(f"{path} holds no summary of a run ({SUMMARY.removeprefix('_')}).")
    return found


def write_report(path: Path, output: Path | None) -> Path:
    """Write the page of a summary, or that of a sweep, and return its path."""
    if path.is_dir():
        return write_page(path, output)
    if not path.name.endswith(SUMMARY):
        raise FileError(f"{path} isn't NAME{SUMMARY}; a report is made of that file, or of the folder that holds it.")
    base = path.with_name(path.name.removesuffix(SUMMARY))
    written = (output or path.parent) / f"{base.name}_report.html"
    results = read_results(path)
    try:
        text = report(results, base)
    except KeyError as error:
        raise FileError(f"the summary {path} lacks {error}: another version of implam wrote it.") from None
    except (TypeError, ValueError, IndexError, AttributeError) as error:
        raise FileError(f"{path} isn't a summary written by implam, or it is damaged ({error}).") from None
    write_text(written, text)
    return written


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
                           "the ledger, warnings, provenance and the deck. Of a sweep with random inputs the page has "
                           "means with their scatter instead.")
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT",
                        help="NAME_summary.json, a folder with such files, or the folder of a sweep")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of the pages (default: beside each summary)")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
