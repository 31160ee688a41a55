"""Tests of the page of a run: it is complete and self-contained, and has the figures of the summary."""

import base64
import json
import shutil
import subprocess
import tempfile
import unittest
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path

import h5py
import numpy as np
from matplotlib.image import imread

from implam_post.io.start import run_deck
from implam_post.report import command as report
from tests.program import SMALL, implam, run_quietly
from tests.program import run as run_module

_WITHOUT_END = {"meta", "img", "br"}

PRESSED = """
&case name='pressed' units='SI' /
&plate length=0.04, 0.04 edges='clamped' symmetry='quarter' /
&mesh elements=4, 4 patch=5e-3 /
&material name='i' density=1600 E=50e9 nu=0.3 /
&laminate materials='i' angles=0 thicknesses=2e-3 /
&impactor travel=1e-3 /
&indentation law='hertz' k=1e9 /
&static steps=2 /
"""


class Page(HTMLParser):
    """A parsed page: cells of tables, pictures, references, and text."""

    def __init__(self, text: str) -> None:
        """Read the page."""
        super().__init__()
        self.open: list[str] = []
        self.cells: list[str] = []
        self.pictures: dict[str, bytes] = {}
        self.references: list[str] = []
        self.text = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        """Store the content of a tag."""
        given = dict(attributes)
        if tag not in _WITHOUT_END:
            self.open.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")
        if tag == "img":
            kind, data = given.pop("src").split(",", 1)
            assert kind == "data:image/png;base64", kind
            self.pictures[given["alt"]] = base64.b64decode(data, validate=True)
        self.references += [value for name, value in given.items() if name in ("src", "href", "srcset")]

    def handle_endtag(self, tag: str) -> None:
        """Compare the tag with the open one."""
        assert self.open.pop() == tag, tag

    def handle_data(self, data: str) -> None:
        """Collect the text."""
        self.text += data
        if self.open and self.open[-1] in ("td", "th"):
            self.cells[-1] += data


class ReportTest(unittest.TestCase):
    """Pages of small runs."""

    def setUp(self) -> None:
        """Make a folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def solve(self, deck: str, addition: str = "") -> Path:
        """Run a small deck; return the path of its summary."""
        path = self.folder / f"{deck}.nml"
        path.write_text((SMALL / f"{deck}.nml").read_text(encoding="utf-8") + addition, encoding="utf-8")
        subprocess.run([implam(), path, "--output", self.folder], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        return self.folder / f"{deck}_summary.json"

    def page(self, summary: Path) -> Page:
        """Write and parse the page of a summary."""
        code, text = run_quietly(report.main, summary)
        self.assertEqual(code, 0, text)
        page = Page(Path(text.strip()).read_text(encoding="utf-8"))
        self.assertEqual(page.open, [])
        self.assertEqual(page.references, [])
        self.assertNotIn("http", page.text)
        for name, data in page.pictures.items():
            self.assertGreater(np.std(imread(BytesIO(data))), 0.01, name)
        return page

    def test_the_page_says_what_the_summary_says(self) -> None:
        """A run with a front and ply failures, with fields: all figures, curves and maps."""
        path = self.solve("damage", "&output fields_every=40e-6 /\n! <b> & \"quotes\"\n")
        summary, page = json.loads(path.read_text(encoding="utf-8")), self.page(path)
        for key, shown in (("peak_force", "{:.4g} kN"), ("largest_deflection", "{:.4g} mm"),
                           ("delaminated_area", "{:.4g} mm²"), ("projected_area", "{:.4g} mm²"),
                           ("projected_area_failed", "{:.4g} mm²"), ("projected_area_softened", "{:.4g} mm²"),
                           ("dent_depth", "{:.4g} µm"), ("dent_indentation", "{:.4g} µm"),
                           ("energy_strain", "{:.4g}"), ("energy_error", "{:.4g}")):
            factor = {"kN": 1e-3, "mm": 1e3, "µm": 1e6, "mm²": 1e6}.get(shown[7:], 1)
            self.assertIn(shown.format(factor * summary[key]), page.cells, key)
        self.assertIn(str(summary["matrix_cracks"]), page.cells)
        self.assertIsNone(summary["energy_absorbed"])
        self.assertIn("contact has not ended", page.cells)
        self.assertIn("algorithmic dissipation", page.cells)
        self.assertIn("threshold force: first drop by damage, after a low-pass filter of 6 kHz", page.cells)
        self.assertIn("largest diameter of the projected damage", page.cells)
        self.assertIn("dent depth", page.cells)
        self.assertIn("delamination below ply 2", page.cells)
        growth = summary["interfaces"][0]["first_growth"]
        self.assertIn(f"{growth['force'] / 1e3:.4g} kN at {1e3 * growth['at']:.4g} ms", page.cells)
        self.assertIn(summary["provenance"]["commit"], page.cells)
        self.assertIn(summary["provenance"]["deck"], page.text)
        self.assertEqual(set(page.pictures), {
            "plate in plan", "lay-up from the struck face", "contact force against time",
            "contact force against displacement of the impactor", "contact force against deflection",
            "deflection against time", "delaminated area against time", "energies against time",
            "sections through the plate", "delamination of each interface", "projected delamination of all interfaces",
            "failures of each ply"})
        self.assertEqual([cell for cell in page.cells if cell in ("90.0", "90")], ["90"])

    def test_warnings_and_static_runs(self) -> None:
        """Warnings are listed; without an impactor there is no force, without fields no map."""
        path = self.solve("cohesive")
        warnings = json.loads(path.read_text(encoding="utf-8"))["warnings"]
        page = self.page(path)
        self.assertGreater(len(warnings), 1)
        for warning in warnings:
            self.assertIn(warning["text"], page.text)
        (self.folder / "cohesive.h5").unlink()
        (self.folder / "cohesive_history.csv").unlink()
        page = self.page(path)
        self.assertEqual(set(page.pictures), {"plate in plan", "lay-up from the struck face"})
        self.assertIn("There is no cohesive.h5.", page.text)
        with h5py.File(self.folder / "cohesive.h5", "w") as file:
            file["part"] = np.bytes_("whole")
            file.create_group("meshes"), file.create_group("times")
        self.assertIn("cohesive.h5 has no times yet.", self.page(path).text)
        page = self.page(self.solve("static_damage"))
        self.assertIn("load factor 1", page.text)
        self.assertNotIn("peak force", page.cells)
        self.assertNotIn("contact force", " ".join(page.pictures))
        self.assertIn("energies against load factor", page.pictures)

    def test_impactor_of_given_travel(self) -> None:
        """For load steps the time of the peak force is a load factor without unit."""
        (self.folder / "pressed.nml").write_text(PRESSED, encoding="utf-8")
        run = run_deck(self.folder / "pressed.nml", output=self.folder / "pressed", program=str(implam())).wait(100)
        self.assertEqual(run.summary["peak_force_at"], 1)
        page = self.page(self.folder / "pressed" / "pressed_summary.json")
        for row in ("peak force", "largest deflection"):
            self.assertEqual("at load factor 1", page.cells[page.cells.index(row) + 2])
        self.assertIn("contact force against load factor", page.pictures)

    def test_folders_and_faults(self) -> None:
        """All summaries of a folder; other files are refused."""
        self.solve("damage")
        self.solve("static_damage")
        output = self.folder / "pages"
        code, text = run_module("report", self.folder, "--output", output)
        self.assertEqual(code, 0, text)
        self.assertEqual({path.name for path in output.iterdir()}, {"damage_report.html", "static_damage_report.html"})
        shutil.copy(SMALL / "damage.nml", self.folder / "no_summary.json")
        older = json.loads((self.folder / "damage_summary.json").read_text(encoding="utf-8"))
        del older["plate_size"]
        (self.folder / "older_summary.json").write_text(json.dumps(older), encoding="utf-8")
        for path, sentence in ((self.folder / "older_summary.json", "lacks 'plate_size'"),
                               (self.folder / "no_summary.json", "is not a summary"),
                               (self.folder / "damage.h5", "is not NAME_summary.json"),
                               (self.folder / "missing_summary.json", "cannot be read"), (output, "has no summary")):
            code, text = run_quietly(report.main, path)
            self.assertEqual((code, len(text.splitlines())), (4, 1), text)
            self.assertIn(sentence, text)


if __name__ == "__main__":
    unittest.main()
