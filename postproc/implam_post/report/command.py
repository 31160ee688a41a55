"""One page per run (`implam-report NAME_summary.json`): summary, curves and maps in one HTML file."""

import argparse
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from implam_post.io.compression import strength_of
from implam_post.io.counts import counted
from implam_post.io.damage_resistance import DIRECTIONS, Extent, extent, kinds_of_damage
from implam_post.io.errors import EXIT_DONE, CommandParser, FileError, run
from implam_post.io.files import refuse_equal_names, write_text
from implam_post.io.history import ENERGY_ERROR, ENERGY_NAMES
from implam_post.io.results import dimension_of
from implam_post.io.run import FIELDS, SUMMARY, Run, material_of, open_run
from implam_post.io.run_figures import Measured, corner_of, resistance
from implam_post.io.summary_shape import missing_member
from implam_post.plot.compression import remark_of
from implam_post.plot.style import PictureStyle
from implam_post.report.compression import compression_rows
from implam_post.report.impact import impact_rows
from implam_post.report.page import image, render, rounded
from implam_post.report.pictures import history_pictures, layup_figure, map_pictures, plan_figure
from implam_post.report.scatter_report import write_page
from implam_post.report.stiffeners import HEAD, stiffener_rows
from implam_post.sweep.scatter_results import STATISTICS

# Rows of the table at the top: label, member, member with its time.
_FIGURES = (
    ("peak force", "peak_force", "peak_force_at"),
    ("contacts", "contacts", None),
    ("contact duration", "contact_duration", "contact_until"),
    ("rebound velocity", "rebound_velocity", None),
    ("velocity of the impactor at the end", "impactor_velocity", None),
    ("largest deflection", "largest_deflection", "largest_deflection_at"),
    ("impact energy", "energy_impact", None),
    ("absorbed energy", "energy_absorbed", None),
    ("work of the load", "work_external", None),
    ("delaminated area, all interfaces", "delaminated_area", None),
    ("delaminated area, projected (C-scan): by dissipated fractions of the toughness", "projected_area", None),
    ("delaminated area, projected: failed points (d at least 0.99)", "projected_area_failed", None),
    ("delaminated area, projected: with process zones (d at least 0.5)", "projected_area_softened", None),
    ("delamination threshold force, closed form at the starter", "threshold_force_at_starter", None),
    ("fibre failures (number of plies of elements)", "fibre_failures", None),
    ("matrix cracks (number of plies of elements)", "matrix_cracks", None),
    ("matrix crushing (number of plies of elements)", "matrix_crushings", None),
)
# Rows of the dent: label, member, remark.
_DENT = (("dent depth", "dent_depth", "at the end of the run; meaningful for a plate at rest (&time settle)"),
         ("permanent indentation in it, by the indentation law", "dent_indentation", ""))
# Remarks in place of a time.
_REMARKS = {"projected_area": "each point counts with the largest fraction of all interfaces",
            "projected_area_softened": "experts' traces of one C-scan differ by 50 to 80 % below 100 mm², by 7 % at "
                                       "450 mm²"}
# Words before a time, and texts for missing figures.
_WHEN = {"contact_duration": "until"}
_UNKNOWN = {"energy_absorbed": "contact has not ended"}
# Half the range of directions, degrees, from which on the damage is called round.
_ROUND = 45
# Numbers in a deck, and the number of digits from which they are rounded: people write fewer.
_NUMBER = re.compile(r"(?<![\w.])(?:\d+\.?\d*|\.\d+)(?:[de][-+]?\d+)?(?![\w.])", re.IGNORECASE)
_MANY_DIGITS = 10
_PROVENANCE = ("version", "commit", "compiler", "petsc_version", "ranks", "started")


def shown(style: PictureStyle, dimension: str, value: object) -> str:
    """Return a figure to four digits, as in the log, with its unit if it is known."""
    if value is None or not dimension:
        return rounded(value)
    return style.shown(dimension, value, 4)


def report(run: Run, undamaged: float | None = None) -> str:
    """Return the page of a run; `undamaged` is the strength of the undamaged plate, if known."""
    summary, style = run.summary, PictureStyle(run.system)
    found = resistance(run)
    mark = tuple(found[name].value for name in ("threshold_at", "threshold_force")) if "threshold_at" in found else None
    mark = None if mark is None or math.isnan(mark[0]) else mark
    energies = {name: summary[key] for key, name in (ENERGY_NAMES | {"energy_error": ENERGY_ERROR}).items()
                if key in summary}
    axis = style.axis("energy", "energy", [*energies.values()])
    remark = remark_of(summary, style, undamaged)
    curves = [] if run.columns is None else history_pictures(run.columns, style, mark, (remark, undamaged))
    maps = [] if run.fields is None else map_pictures(run.fields, style, run.columns)
    return render(
        "run.html", title=summary["title"] or summary["case"], summary=summary, base=run.name,
        reached=_reached(summary, style), has_units=bool(style.system),
        no_maps=_no_maps(run), figures=_figures(summary, style),
        resistance=_resistance(run, found, style) if "energy_absorbed" in summary and run.columns is not None else None,
        compression=compression_rows(run, style, undamaged), interfaces=_interfaces(summary, style),
        interfaces_head=_interfaces_head(summary), test=impact_rows(run, style), deck=_rounded_deck(summary),
        plate=_plate(summary, style), plan=image(plan_figure(summary, style)),
        layup=image(layup_figure(summary)), plies_head=_plies_head(summary), plies=_plies(summary, style),
        stiffeners=stiffener_rows(run, style), stiffeners_head=HEAD,
        curves=[(text, image(figure)) for text, figure in curves],
        maps=[(text, image(figure)) for text, figure in maps],
        balance=[(name, axis.factor * value) for name, value in energies.items()], energy_label=axis.label,
        provenance=[*((key.replace("_", " "), str(summary["provenance"][key])) for key in _PROVENANCE),
                    *((key.replace("_", " "), value) for key, value in summary["costs"].items())])


def _no_maps(results: Run) -> str:
    """Return the reason why a page has no maps."""
    if results.fields is not None:
        return "The fields have no interfaces and no ply failures."
    name = f"{results.name}{FIELDS}"
    return f"{name} has no times yet." if results.base.with_name(name).exists() else f"There is no {name}."


def _resistance(results: Run, found: Mapping[str, Measured], style: PictureStyle) -> str:
    """Return the rows of threshold, energies, size and type of the damage."""
    summary = results.summary

    def row(name: str, key: str, missing: str = "-", at: str = "") -> tuple[str, str, str]:
        if key not in found or math.isnan(found[key].value):
            return name, missing, ""
        return name, shown(style, found[key].dimension, found[key].value), at

    corner = corner_of(results)
    behind = f", after a low-pass filter of {_frequency(style, corner)}" if corner else ""
    unknown = "no drop of the force by damage" if corner else "not known without units"
    reached = "threshold_at" in found and not math.isnan(found["threshold_at"].value)
    by_load_steps = _is_by_load_steps(summary)
    when = f"at {_instant(style, found['threshold_at'].value, by_load_steps)}" if reached else ""
    rows = [row(f"threshold force: first drop by damage{behind}", "threshold_force", unknown, when),
            ("peak force", shown(style, "force", summary["peak_force"]),
             f"at {_instant(style, summary['peak_force_at'], by_load_steps)}"),
            row("energy to the threshold", "energy_to_threshold"), row("energy to the peak force", "energy_to_peak"),
            ("absorbed energy", "contact has not ended" if summary["energy_absorbed"] is None
             else shown(style, "energy", summary["energy_absorbed"]), "")]
    rows += [(name, shown(style, "length", summary[key]), remark) for name, key, remark in _DENT if key in summary]
    if results.fields is not None and "damage_diameter" in found:
        rows += _sizes(results, style)
    kinds = kinds_of_damage(summary)
    return rows + [("type of damage" if place == 0 else "", kind, "") for place, kind in enumerate(kinds or ["none"])]


def _frequency(style: PictureStyle, corner: float) -> str:
    """Return a frequency with its unit."""
    return f"{corner / style.seconds / 1e3:.4g} kHz" if style.system else rounded(corner)


def _direction(size: Extent) -> str:
    """Return the direction of the largest diameter, to the degrees to which it is known."""
    error = math.ceil(size.direction_error)
    if error >= _ROUND:
        return "in no certain direction: the damage is round to within an element"
    return f"along {size.direction:.0f}°" + (f" ± {error}°" if error else "")


def _sizes(results: Run, style: PictureStyle) -> list[tuple[str, str, str]]:
    """Return the rows of the size of the projected damage."""
    size = extent(results.fields)
    if size is None:
        return [("projected damage", "none", "")]
    rows = [("largest diameter of the projected damage", shown(style, "length", size.diameter),
             _direction(size)),
            ("length of the projected damage along 0° (x)", shown(style, "length", size.length), ""),
            ("width of the projected damage along 90° (y)", shown(style, "length", size.width), "")]
    return rows + [(f"length of the projected damage through the struck point, along {angle}°",
                    shown(style, "length", size.through[angle]) if size.through[angle] else "none", "")
                   for angle in DIRECTIONS]


def _is_by_load_steps(summary: Mapping[str, Any]) -> bool:
    """Return whether the times of a run are load factors."""
    return "load_factor_reached" in summary


def _instant(style: PictureStyle, time: float | None, by_load_steps: bool) -> str:
    """Return a time or a load factor to four digits; a dash for a missing one."""
    return rounded(None) if time is None else style.instant(time, by_load_steps, 4)


def _reached(summary: Mapping[str, Any], style: PictureStyle) -> str:
    """Return the time or load factor that the run reached."""
    if _is_by_load_steps(summary):
        return style.instant(summary["load_factor_reached"], True, 4)
    return f"time {shown(style, 'time', summary['time_reached'])}"


def _figures(summary: Mapping[str, Any], style: PictureStyle) -> list[tuple[str, ...]]:
    """Return the rows of the table at the top."""
    rows, by_load_steps = [], _is_by_load_steps(summary)
    for name, key, at in _FIGURES:
        if key in summary and not (key == "work_external" and not summary[key]):
            value = _UNKNOWN.get(key, "-") if summary[key] is None else shown(style, dimension_of(key), summary[key])
            when = f"{_WHEN.get(key, 'at')} {_instant(style, summary[at], by_load_steps)}" if at in summary else (
                _REMARKS.get(key, ""))
            rows.append((name, value, when))
    if summary.get("in_contact"):
        rows.append(("contact at the end", "yes", ""))
    return rows


def _range(style: PictureStyle, ends: Sequence[float]) -> str:
    """Return least and greatest coordinate in the same unit."""
    if not any(ends):
        return "none"
    axis = style.axis("", "length", ends)
    unit = shown(style, "length", max(ends, key=abs)).partition(" ")[2]
    return " to ".join(rounded(axis.factor * end) for end in ends) + f" {unit}".rstrip()


def _event(entry: Mapping[str, Any], name: str, summary: Mapping[str, Any], style: PictureStyle) -> str:
    """Return time and force of an event of an interface."""
    event = entry[name]
    if event is None:
        return "before this run" if entry.get(f"{name}_before_run") else "none"
    force = f"{shown(style, 'force', event['force'])} " if "force" in event else ""
    return f"{force}at {_instant(style, event['at'], _is_by_load_steps(summary))}"


def _interfaces(summary: Mapping[str, Any], style: PictureStyle) -> list[tuple[object, ...]]:
    """Return the rows of the interfaces; the threshold force is that of an impact."""
    return [(entry["ply_above"], "cohesive" if entry["is_cohesive"] else "front", shown(style, "area", entry["area"]),
             _range(style, entry["x"]), _range(style, entry["y"]), shown(style, "energy", entry["energy"]),
             _event(entry, "onset", summary, style), _event(entry, "first_growth", summary, style),
             *([shown(style, "force", entry["threshold_force"])] if "peak_force" in summary else []),
             "yes" if entry["border_reached"] else "no")
            for entry in summary.get("interfaces", [])]


def _interfaces_head(summary: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the heads of the columns of the interfaces."""
    threshold = ["threshold force (closed form)"] if "peak_force" in summary else []
    return ("below ply", "law", "area", "x", "y", "energy", "onset", "first growth", *threshold, "border reached")


def _rounded_deck(summary: Mapping[str, Any]) -> str:
    """Return the deck, numbers of many digits, as random inputs have them, rounded to six digits."""
    def rounded_to_six(found: re.Match[str]) -> str:
        """Return a number with at most six digits."""
        digits = re.split("[de]", found[0].lower())[0].replace(".", "").lstrip("0")
        return found[0] if len(digits) < _MANY_DIGITS else f"{float(found[0].lower().replace('d', 'e')):.6g}"

    return _NUMBER.sub(rounded_to_six, summary["provenance"]["deck"])


def _plate(summary: Mapping[str, Any], style: PictureStyle) -> str:
    """Return the size of the plate."""
    along, across = (shown(style, "length", length) for length in summary["plate_size"])
    plies = [ply for ply in summary["plies"] if "doubler" not in ply]
    thickness = shown(style, "length", sum(ply["thickness"] for ply in plies))
    added = counted(len(summary["plies"]) - len(plies), "ply", "plies")
    doublers = f", {added} in doublers" if len(plies) < len(summary["plies"]) else ""
    return f"{along} by {across}, {thickness} thick, {counted(len(plies), 'ply', 'plies')}{doublers}."


def _failure_areas(summary: Mapping[str, Any]) -> list[str]:
    """Return the members of plies with areas of failures."""
    return [key for key in ("fibre_failure_area", "matrix_crack_area", "matrix_crushing_area")
            if key in summary["plies"][0]]


def _plies_head(summary: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the heads of the columns of the plies."""
    areas = [key.replace("_", " ") for key in _failure_areas(summary)]
    return ("ply", "material", "angle, degrees", "thickness", *areas)


def _plies(summary: Mapping[str, Any], style: PictureStyle) -> list[tuple[object, ...]]:
    """Return the rows of lay-up and failures of the plies."""
    return [(ply["ply"], ", doubler ".join([material_of(ply), *([ply["doubler"]] if "doubler" in ply else [])]),
             ply["angle"], shown(style, "length", ply["thickness"]),
             *(shown(style, "area", ply[key]) for key in _failure_areas(summary))) for ply in summary["plies"]]


def summaries_at(path: Path) -> list[Path]:
    """Return the summaries of a folder, or the path itself if it is a summary or the folder of a sweep."""
    if not path.is_dir() or (path / STATISTICS).exists():
        return [path]
    found = sorted(path.glob(f"*{SUMMARY}"))
    if not found:
        raise FileError(f"{path} has no summary of a run (NAME{SUMMARY}).")
    return found


def write_report(path: Path, output: Path | None, undamaged: float | None = None) -> Path:
    """Write the page of a summary or of a sweep, and return its path."""
    if path.is_dir():
        return write_page(path, output)
    if not path.name.endswith(SUMMARY):
        raise FileError(f"{path} is not NAME{SUMMARY}; a report needs that file, or its folder.")
    run_shown = open_run(path)
    written = (output or path.parent) / f"{run_shown.name}_report.html"
    if missing := missing_member(run_shown.summary):
        raise FileError(f"the summary {path} lacks {missing!r}: another version of implam wrote it.")
    write_text(written, report(run_shown, undamaged))
    return written


def _command(options: argparse.Namespace) -> int:
    """Write a page for each run."""
    undamaged = None if options.undamaged is None else strength_of(options.undamaged)
    summaries = [path for given in options.results for path in summaries_at(given)]
    refuse_equal_names([path.absolute() for path in summaries], options.output)
    for path in summaries:
        print(write_report(path, options.output, undamaged))
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-report", description="Write NAME_report.html, one self-contained page: "
                           "the summary of a run, its plate and lay-up, curves of NAME_history.csv, maps of NAME.h5, "
                           "energies at the end, warnings, provenance and the deck. The page of a sweep with random "
                           "inputs has means with their standard errors.")
    parser.add_argument("results", nargs="+", type=Path, metavar="RESULT",
                        help="NAME_summary.json, a folder with such files, or the folder of a sweep")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of the pages (default: that of the result)")
    parser.add_argument("--undamaged", type=Path, metavar="SUMMARY", help="NAME_summary.json of the compression "
                        "of the undamaged plate: the page then has the retained fraction of its strength")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
