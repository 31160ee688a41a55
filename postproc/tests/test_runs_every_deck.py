"""Run all commands that draw on decks in input/small, after a run of few steps on coarse cells.

With the environment variable IMPLAM_EVERY_DECK=1 on all decks in input/, in minutes."""

import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

import h5py

from implam_post.plot import command as plot
from implam_post.plot import movie, paraview
from implam_post.report import command as report
from tests.program import ROOT, implam, run_quietly

sys.path.insert(0, str(ROOT / "tests" / "regress"))
from solver_runs import change_deck
from solver_runs import run as run_program

ALL = bool(os.environ.get("IMPLAM_EVERY_DECK"))
DECKS = sorted((ROOT / "input" / ("" if ALL else "small")).rglob("*.nml"), key=lambda deck: deck.stat().st_size)
# Coarse cells and an early end of large decks, by the first matching beginning of their names.
COARSE = {"t700_m21_cai": ["mesh%elements=20,30", "mesh%cell=5e-3", "mesh%patch=5e-3", "time%end=2e-3"],
          "t700_m21_25J": ["mesh%elements=16,18", "mesh%cell=5e-3", "mesh%patch=5e-3", "time%end=1e-3"],
          "t700_m21": ["mesh%elements=16,18", "mesh%cell=5e-3", "mesh%patch=5e-3"],
          "im7_8552": ["mesh%elements=10,12", "mesh%core=36e-3,36e-3", "mesh%cell=9e-3", "mesh%patch=9e-3",
                       "time%end=1e-3"],
          "stiffened_panel": ["mesh%elements=20,32", "mesh%grading=1", "mesh%core=48e-3,48e-3", "mesh%cell=6e-3",
                              "time%end=0.2e-3"],
          "crossply_1.25mm": ["mesh%elements=16,16", "mesh%patch=6.25e-3"]}
STEPS = 3


def short(deck: Path) -> str:
    """Return a deck with coarse cells that ends after few steps and writes fields in each step."""
    text = deck.read_text(encoding="utf-8")
    settings = next((coarse for name, coarse in COARSE.items() if deck.name.startswith(name)), [])
    step = re.search(r"^&time\b[^/]*?\bstep\s*=\s*([0-9.e+-]+)", text, re.MULTILINE)
    if step:
        settings = [*settings, f"time%end={STEPS * float(step[1])!r}", f"output%fields_every={float(step[1])!r}",
                    "output%checkpoint_every=0"]
    return change_deck(text, settings)


class EveryDeckTest(unittest.TestCase):
    """Each deck."""

    def test_every_deck(self) -> None:
        """Pictures, overview, movie, page and ParaView state; a command without data to draw reports it."""
        self.assertGreater(len(DECKS), 40 if ALL else 5)
        for source in DECKS:
            # Decks that begin with the final state of another run are tested by compression.py.
            if "&initial_state" in source.read_text("utf-8"):
                continue
            with self.subTest(source.name), tempfile.TemporaryDirectory() as folder:
                deck = Path(folder) / "deck.nml"
                deck.write_text(short(source), encoding="utf-8")
                run_program([implam(), deck, "--output", folder])
                self.draw(next(path for path in Path(folder).glob("*.h5") if "_restart" not in path.name))
                if ALL:
                    print(source.name, flush=True)

    def draw(self, fields: Path) -> None:
        """Run the commands on a run's fields."""
        with h5py.File(fields) as file:
            mesh = file["meshes/00000001/cells"]
            layered = mesh["first_ply"][()].max() > 1
        history = fields.with_name(f"{fields.stem}_history.csv")
        for command, arguments, needs in ((plot.main, [fields], True),
                                          (plot.main, [fields, "--projected", "time"], True),
                                          (plot.main, [fields, "--save", fields.with_suffix(".png")], layered),
                                          (plot.main, [history], True), (movie.main, [fields], layered),
                                          (report.main, [fields.with_name(f"{fields.stem}_summary.json")], True),
                                          (paraview.main, [fields], True)):
            code, printed = run_quietly(command, *arguments)
            self.assertEqual(code, 0 if needs else 4, f"{command.__module__} {arguments}: {printed}")
            if not needs:
                self.assertIn("no interface", printed)


if __name__ == "__main__":
    unittest.main()
