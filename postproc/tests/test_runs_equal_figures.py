"""Every figure that appears in two outputs of a run is equal in both, to the digits printed.

The summary is compared with the log, the page of the run, the figures in Python, the table of a sweep and its
statistics, on the decks in input/small and input/tutorial; with the environment variable IMPLAM_EVERY_DECK=1 on all
decks in input/, large ones on coarse cells."""

import csv
import html
import json
import math
import os
import re
import shutil
import sys
import tempfile
import unittest
from collections.abc import Iterator, Mapping
from pathlib import Path

from implam_post.io.run import Run, open_run
from implam_post.io.units import SYSTEMS
from implam_post.report import command as report
from implam_post.sweep import command as sweep
from implam_post.sweep.scatter_text import words_of
from implam_post.sweep.table import FIGURES
from tests.program import ROOT, implam, run_quietly
from tests.test_runs_every_deck import short

ALL = bool(os.environ.get("IMPLAM_EVERY_DECK"))
FOLDERS = [ROOT / "input"] if ALL else [ROOT / "input" / "small", ROOT / "input" / "tutorial"]
DECKS = sorted((deck for folder in FOLDERS for deck in folder.rglob("*.nml")), key=lambda deck: deck.stat().st_size)
# Units of printed values in SI.
FORCE, ENERGY, LENGTH, TIME = (1, 1, -2), (2, 1, -2), (1, 0, 0), (0, 0, 1)  # powers of length, mass, time
VELOCITY, AREA, STRESS, NUMBERS = (1, 0, -1), (2, 0, 0), (-1, 1, -2), (0, 0, 0)
UNITS = {"N": (1, FORCE), "kN": (1e3, FORCE), "J": (1, ENERGY), "mJ": (1e-3, ENERGY), "m": (1, LENGTH),
         "mm": (1e-3, LENGTH), "µm": (1e-6, LENGTH), "um": (1e-6, LENGTH), "s": (1, TIME), "ms": (1e-3, TIME),
         "µs": (1e-6, TIME), "us": (1e-6, TIME), "m/s": (1, VELOCITY), "mm²": (1e-6, AREA), "mm2": (1e-6, AREA),
         "Pa": (1, STRESS), "MPa": (1e6, STRESS), "GPa": (1e9, STRESS), "e-6": (1e-6, NUMBERS), "": (1, NUMBERS)}
NUMBER = r"(-?\d[\d.]*(?:e[-+]?\d+)?)(?:(e-6)| (m/s|mm[2²]|k?N|m?J|[mµu]?m|[mµu]?s|[MG]?Pa)\b)?"
AT = rf"{NUMBER}(?: \([^)]*\))? at (?:time |load factor )?{NUMBER}"
EVENT = rf"(?:force {NUMBER}, )?(?:time |load factor )?{NUMBER}"
# Lines of the summary in the log: label, pattern, members.
LINES = (
    ("peak force", AT, ("peak_force", "peak_force_at")),
    ("filtered", AT, ("force_filter/peak_force", "force_filter/peak_force_at")),
    ("time in contact", rf"{NUMBER}(?:.*, until {NUMBER})?", ("contact_duration", "contact_until")),
    ("rebound velocity", NUMBER, ("rebound_velocity",)), ("velocity at the end", NUMBER, ("impactor_velocity",)),
    ("largest deflection", AT, ("largest_deflection", "largest_deflection_at")),
    ("residual strength", rf"{NUMBER} at a shortening of {NUMBER}, (?:time |load factor )?{NUMBER}"
     rf"(?:, effective modulus {NUMBER})?(?:, buckled at a strain of {NUMBER})?",
     ("residual_strength", "shortening_at_strength", "residual_strength_at", "effective_modulus", "buckling_strain")),
    ("dent", rf"{NUMBER} below .* indentation {NUMBER}", ("dent_depth", "dent_indentation")),
    ("dent", rf"{NUMBER}, permanent indentation only", ("dent_indentation",)),
    ("impact energy", rf"{NUMBER}, absorbed {NUMBER}", ("energy_impact", "energy_absorbed")),
    ("work of the load", NUMBER, ("work_external",)),
    ("energies", rf"kinetic {NUMBER}, strain {NUMBER}, indentation {NUMBER}, delamination {NUMBER}, "
     rf"ply damage {NUMBER}",
     ("energy_kinetic", "energy_strain", "energy_indentation", "energy_delamination", "energy_ply_damage")),
    ("", rf"contact {NUMBER}, friction {NUMBER}, layers {NUMBER}(?:, damping {NUMBER})?, "
     rf"algorithmic dissipation {NUMBER}",
     ("energy_contact", "energy_friction", "energy_layers", "energy_damping", "energy_algorithmic")),
    ("delaminated area", rf"{NUMBER} of all interfaces", ("delaminated_area",)),
    ("projected", rf"{NUMBER} by dissipated fractions, as in a C-scan; failed points {NUMBER}, "
     rf"with process zones {NUMBER}",
     ("projected_area", "projected_area_failed", "projected_area_softened")),
    ("failed plies", r"fibres (\d+)()(), matrix cracked (\d+)()(), crushed (\d+)()()",
     ("fibre_failures", "matrix_cracks", "matrix_crushings")))
OF_INTERFACE = (
    (rf"area {NUMBER}, x {NUMBER} to {NUMBER}, y {NUMBER} to {NUMBER}, energy {NUMBER}",
     ("area", "x/0", "x/1", "y/0", "y/1", "energy")),
    (rf"onset at {EVENT}", ("onset/force", "onset/at")),
    (rf"first growth at {EVENT}", ("first_growth/force", "first_growth/at")),
    (rf"threshold force \(closed form\) {NUMBER}", ("threshold_force",)))
# Rows of the page: label, member, member of the third cell.
ROWS = (
    ("peak force", "peak_force", "peak_force_at"), ("contacts", "contacts", ""),
    ("contact duration", "contact_duration", "contact_until"), ("rebound velocity", "rebound_velocity", ""),
    ("velocity of the impactor at the end", "impactor_velocity", ""),
    ("largest deflection", "largest_deflection", "largest_deflection_at"), ("impact energy", "energy_impact", ""),
    ("absorbed energy", "energy_absorbed", ""), ("work of the load", "work_external", ""),
    ("delaminated area, all interfaces", "delaminated_area", ""), ("delaminated area, projected", "projected_area", ""),
    ("residual strength", "residual_strength", ""), ("shortening at the strength", "shortening_at_strength", ""),
    ("effective modulus", "effective_modulus", ""), ("dent depth", "dent_depth", ""),
    ("permanent indentation in it, by the indentation law", "dent_indentation", ""),
    ("energy to the threshold", "energy_to_threshold", ""), ("energy to the peak force", "energy_to_peak", ""),
    ("largest diameter of the projected damage", "damage_diameter", ""))


def members(value: object, path: str = "") -> Iterator[tuple[str, float | None]]:
    """Yield the numbers of a summary by their paths; null is None."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for name, part in inner:
        yield from members(part, f"{path}/{name}" if path else str(name))
    if value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)):
        yield path, value


def is_round_off(name: str, summary: Mapping[str, float | None]) -> bool:
    """Return whether an energy of layers is round-off of the energies of the run, which the log prints as 0."""
    energies = summary.get("energy_impact") or 0.0, summary["energy_strain"] or 0.0
    return name == "energy_layers" and abs(summary[name] or 0.0) <= sys.float_info.epsilon * max(energies)


class Printed:
    """A number as printed, to four digits, with its unit."""

    def __init__(self, digits: str, unit: str | None, system: str) -> None:
        """Convert it to the units of the deck."""
        factor, powers = UNITS[unit or ""]
        self.text = f"{digits} {unit or ''}".strip()
        scales = SYSTEMS.get(system, (1.0, 1.0, 1.0))
        self.value = float(digits) * factor / math.prod(
            scale**power for scale, power in zip(scales, powers, strict=True))

    def shows(self, value: float) -> bool:
        """Return whether a value is printed so: rounded to four digits."""
        place = 10.0**(math.floor(math.log10(abs(value))) - 3) if value else 0.0
        return abs(value - self.value) <= 0.5001 * place + 1e-15 * abs(value)


class EqualFiguresTest(unittest.TestCase):
    """Each deck, run as a case of a sweep."""

    def setUp(self) -> None:
        """Make a folder to work in, with the decks."""
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.addCleanup(os.chdir, Path.cwd())
        os.chdir(folder)
        self.compared = 0

    def test_all_outputs(self) -> None:
        """Log, page, Python, table and statistics have the figures of the summary."""
        self.assertGreater(len(DECKS), 60 if ALL else 12)
        for source in DECKS:
            text = source.read_text(encoding="utf-8")
            if "&initial_state" in text:
                continue
            with self.subTest(source.name):
                Path(source.name).write_text(short(source) if ALL else text, encoding="utf-8")
                self.run_sweep(source.stem, "[scatter]\nnumber = 1\nplace = 0\n")
        self.assertGreater(self.compared, 100 * (len(DECKS) - 2), "Figures are not found where they are printed.")

    def test_second_runs(self) -> None:
        """The table of a sweep of impacts and compressions has the figures of both."""
        for name in ("cai_impact", "cai_compression"):
            shutil.copy(ROOT / "input" / "small" / f"{name}.nml", ".")
        self.run_sweep("cai_impact", 'then = "cai_compression.nml"\n[grid]\n"impactor.velocity" = [4.0]\n')
        with Path("cai_impact/table.csv").open(newline="") as file:
            row, = csv.DictReader(file)
        second, = Path("cai_impact").rglob("cai_compression_summary.json")
        summary = json.loads(second.read_text())
        for name in (name for name, figure in FIGURES.items() if figure.is_of_second):
            value = summary[FIGURES[name].member]
            self.assertEqual(row[name], str(value).lower() if isinstance(value, bool) else "" if value is None
                             else str(value), name)
        self.check_run(open_run(second))
        self.assertGreater(self.compared, 100)

    def run_sweep(self, name: str, tables: str) -> None:
        """Run a deck as the only case of a sweep, and compare all outputs."""
        Path(f"{name}.toml").write_text(f'deck = "{name}.nml"\n{tables}', encoding="utf-8")
        code, printed = run_quietly(sweep.main, f"{name}.toml", "--program", implam())
        self.assertEqual(code, 0, printed)
        with Path(name, "table.csv").open(newline="") as file:
            row, = csv.DictReader(file)
        found = open_run(next((Path(name) / row["folder"]).glob("*_summary.json")))
        for column, figure in FIGURES.items():
            if not ("then" in tables and figure.is_of_second):
                self.assertEqual(column in row, figure.member in found.summary, column)
            value = found.summary.get(figure.member)
            if column in row and row[column] and not figure.is_of_second:
                self.equal(float(row[column]), value, f"table {column}")
        self.check_run(found)
        if "[scatter]" in tables:
            self.check_statistics(Path(name), found)

    def check_run(self, found: Run) -> None:
        """Compare figures, log and page of a run with its summary."""
        summary = dict(members({name: value for name, value in found.summary.items() if name not in (
            "costs", "provenance", "profile")}))
        of_all = summary | {name: figure.value for name, figure in found.figures.items() if name not in summary}
        for name, figure in found.figures.items():
            if name in summary and not math.isnan(figure.value):
                self.equal(figure.value, summary[name], f"Python {name}")
            elif name in summary:
                self.assertTrue(summary[name] is None or found.summary["in_contact"], name)
        self.check_log(found, summary)
        self.check_page(found, of_all)

    def check_log(self, found: Run, summary: Mapping[str, float | None]) -> None:
        """Compare the log."""
        log, = found.base.parent.glob("*.log")
        block = re.split(r"^Summary", log.read_text(encoding="utf-8"), flags=re.MULTILINE)[-1].splitlines()[1:]
        system, prefix, entries = found.system, "", {str(entry["ply_above"]): place for place, entry in enumerate(
            found.summary.get("interfaces", []))}
        printed_in_units = not re.search(r"at time ", "\n".join(block))
        for line in block:
            label, content = line[2:22].strip(), line[22:]
            if label.startswith("below ply "):
                prefix = f"interfaces/{entries[label.removeprefix('below ply ')]}/"
            patterns = [(pattern, [prefix + name for name in names]) for pattern, names in OF_INTERFACE] if prefix and (
                label == "" or label.startswith("below")) else [
                (pattern, names) for named, pattern, names in LINES if named == label]
            for pattern, names in patterns:
                if match := re.match(pattern, content):
                    groups = match.groups()
                    for name, digits, *units in zip(names, groups[::3], groups[1::3], groups[2::3], strict=True):
                        if digits is not None:
                            self.shown(Printed(digits, units[0] or units[1], system if printed_in_units else ""),
                                       0 if is_round_off(name, summary) else summary[name], f"log {name}")

    def check_page(self, found: Run, known: Mapping[str, float | None]) -> None:
        """Compare the page."""
        code, printed = run_quietly(report.main, f"{found.base}_summary.json")
        self.assertEqual(code, 0, printed)
        page = html.unescape(Path(f"{found.base}_report.html").read_text(encoding="utf-8"))
        cells = re.compile(r"<t[dh][^>]*>(.*?)</t[dh]>", re.DOTALL)
        rows = [[re.sub(r"<[^>]*>", "", cell).strip() for cell in cells.findall(row)]
                for row in re.findall(r"<tr>(.*?)</tr>", page, re.DOTALL)]
        for label, value, *more in (row for row in rows if len(row) > 1):
            for name, at in ((name, at) for named, name, at in ROWS if named == label):
                for cell, member in ((value, name), (more[0] if more else "", at)):
                    match = re.search(NUMBER, cell) if member else None
                    if match and "load factor" not in cell:
                        self.shown(Printed(match[1], match[2] or match[3], found.system), known[member],
                                   f"page {member}")

    def check_statistics(self, folder: Path, found: Run) -> None:
        """Compare the statistics of the only run, in all files."""
        with (folder / "figures.csv").open(newline="") as file:
            row, = csv.DictReader(file)
        with (folder / "statistics.csv").open(newline="") as file:
            means = {line["figure"]: line["mean"] for line in csv.DictReader(file)}
        text = (folder / "statistics.txt").read_text(encoding="utf-8")
        for name, figure in found.figures.items():
            if math.isnan(figure.value):
                self.assertEqual((row[name], means[name]), ("", ""), name)
                continue
            self.equal(float(row[name]), figure.value, f"figures.csv {name}")
            self.equal(float(means[name]), figure.value, f"statistics.csv {name}")
            if match := re.search(rf"^{words_of(name)}  +{NUMBER}  ", text, re.MULTILINE):
                self.shown(Printed(match[1], match[2] or match[3], found.system), figure.value,
                           f"statistics.txt {name}")

    def equal(self, value: float, reference: float | None, what: str) -> None:
        """Fail unless both numbers are the same."""
        self.assertEqual(value, reference, what)
        self.compared += 1

    def shown(self, printed: Printed, value: float | None, what: str) -> None:
        """Fail unless a printed number is a value rounded."""
        self.assertIsNotNone(value, what)
        self.assertTrue(printed.shows(value), f"{what}: {printed.text} is printed for {value}")
        self.compared += 1


if __name__ == "__main__":
    unittest.main()
