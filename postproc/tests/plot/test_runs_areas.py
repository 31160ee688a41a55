"""Pictures and page of every quick deck have exactly the areas of its summary.

With the environment variable IMPLAM_EVERY_DECK=1 all decks in input/, large ones on coarse cells, in an hour."""

import json
import re
import tempfile
import unittest
import warnings
from pathlib import Path
from unittest import mock

import h5py
import numpy as np
from matplotlib.figure import Figure

from implam_post.io.contours import WEIGHTS
from implam_post.plot import command as plot
from implam_post.plot.plan import FEW
from implam_post.report import command as report
from tests.program import ROOT, implam, run_quietly
from tests.test_runs_every_deck import ALL, COARSE, DECKS, change_deck, run_program

UNITS = "--units", "SI"
# Other decks of a few seconds: delamination growth in time, a specimen, and 22 interfaces.
QUICK = [ROOT / "input" / f"{name}.nml" for name in (
    "tutorial/delamination", "verify/moment_shear", "experiments/im7_8552_d7136_30J")]


class AreasTest(unittest.TestCase):
    """Each deck."""

    def test_every_deck(self) -> None:
        """The end is not a multiple of fields_every, but fields have the final state of the summary."""
        for source in DECKS if ALL else [*DECKS, *QUICK]:
            text = source.read_text(encoding="utf-8")
            # Decks that begin with the final state of another run are tested by compression.py.
            if "&delamination" not in text or "&initial_state" in text:
                continue
            text = change_deck(text, next((coarse for name, coarse in COARSE.items() if source.name.startswith(name)),
                                          []))
            ends = re.search(r"^&time\b[^/]*?\bend\s*=\s*([0-9.e+-]+)", text, re.MULTILINE)
            settings = [f"output%fields_every={0.4 * float(ends[1])!r}"] if ends else []
            with self.subTest(source.name), tempfile.TemporaryDirectory() as folder:
                deck = Path(folder) / "deck.nml"
                deck.write_text(change_deck(text, settings), encoding="utf-8")
                run_program([implam(), deck, "--output", folder])
                with warnings.catch_warnings():
                    warnings.simplefilter("error", UserWarning)  # Matplotlib warns if a layout does not fit
                    self.hold(next(Path(folder).glob("*_summary.json")))

    def hold(self, path: Path) -> None:
        """Compare titles and cells of the page with the summary."""
        summary, fields = json.loads(path.read_text(encoding="utf-8")), path.with_name(
            path.name.replace("_summary.json", ".h5"))
        titles = self.titles(fields)
        few = len(summary["interfaces"]) <= FEW
        kinds = {True: "dissipated area ", False: "delaminated area "} if few else {True: "", False: ""}
        expected = [f"below ply {entry['ply_above']}: {kinds[entry['is_cohesive']]}{1e6 * entry['area']:.4g} mm²"
                    for entry in summary["interfaces"]]
        expected.append(f"all interfaces: projected area {1e6 * summary['projected_area']:.4g} mm²")
        for title in expected:
            self.assertIn(title, titles)
        with mock.patch.object(Figure, "savefig"):  # only the text of the page is tested: figures are not drawn
            code, printed = run_quietly(report.main, path)
        self.assertEqual(code, 0, printed)
        page = Path(printed.strip()).read_text(encoding="utf-8")
        for area in (summary["delaminated_area"], summary["projected_area"],
                     *(entry["area"] for entry in summary["interfaces"])):
            self.assertIn(f">{1e6 * area:.4g} mm²<", page)
        self.hold_damage(summary, fields)
        if len(summary["interfaces"]) == 1:
            self.assertAlmostEqual(summary["projected_area"] / (summary["delaminated_area"] or 1),
                                   1 if summary["delaminated_area"] else 0, delta=1e-12)

    def hold_damage(self, summary: dict[str, object], path: Path) -> None:
        """Compare the projected areas of failed and of softened points with sums over the field of damage."""
        if not all(entry["is_cohesive"] for entry in summary["interfaces"]):
            return
        with h5py.File(path) as file:
            last = file["times"][max(file["times"])]
            mesh = file[f"meshes/{int(last['mesh'][()]):08d}"]
            points, elements = mesh["coordinates"][:, :2], mesh["connectivity"][()]
            damage = last["points/damage_above"][()]
        _, node = np.unique(np.round(1e8 * points).astype(int), axis=0, return_inverse=True)
        node = node.ravel()
        worst = np.zeros(node.max() + 1)
        np.maximum.at(worst, node, damage)
        _, once = np.unique(node[elements[:, 8]], return_index=True)
        area = np.zeros_like(worst)
        cells = np.prod(np.ptp(points[elements[once, :4]], axis=1), axis=1)
        np.add.at(area, node[elements[once]], cells[:, None] * WEIGHTS)
        for name, least in (("failed", 0.99), ("softened", 0.5)):
            found = np.sum(area[worst >= least]) / np.sum(area) * np.prod(summary["plate_size"])
            self.assertAlmostEqual(summary[f"projected_area_{name}"] / (found or 1), 1 if found else 0, delta=1e-9,
                                   msg=name)

    def titles(self, fields: Path) -> list[str]:
        """Draw the fields and return the first line of each title."""
        found = []

        def note(figure: Figure, path: Path, **_: object) -> None:
            path.touch()
            found.extend(axes.get_title().splitlines()[0] for axes in figure.axes if axes.get_title())

        with mock.patch.object(Figure, "savefig", note):
            code, printed = run_quietly(plot.main, fields, *UNITS)
        self.assertEqual(code, 0, printed)
        return found


if __name__ == "__main__":
    unittest.main()
