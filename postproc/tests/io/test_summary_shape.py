"""Summaries with members of the wrong kind are refused with the name of the member, other summaries are not."""

import copy
import json
import tempfile
import unittest
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

from implam_post.io.compression import failed_across_width
from implam_post.io.errors import FileError
from implam_post.io.run import read_summary
from implam_post.io.summary_shape import missing_member
from implam_post.report import command as report

ENERGIES = ("kinetic", "strain", "indentation", "delamination", "ply_damage", "contact", "friction", "layers",
            "damping", "algorithmic", "error", "impact", "absorbed", "impactor")
SUMMARY = {
    "case": "case", "title": "a title", "exit": {"kind": "done", "code": 0, "message": ""}, "time_reached": 1e-3,
    "accepted_steps": 3, "peak_force": 10.5, "peak_force_at": 1e-4, "in_contact": False, "largest_deflection": 1e-3,
    "largest_deflection_at": 2e-4, "rebound_velocity": None, "plate_size": [0.1, 0.1], "work_external": 0.5,
    **{f"energy_{name}": 0.5 for name in ENERGIES}, "delaminated_area": 2e-4, "projected_area": 1e-4,
    "projected_area_failed": 5e-5, "projected_area_softened": 2e-4,
    "interfaces": [{"ply_above": 1, "is_cohesive": True, "area": 2e-4, "energy": 0.1, "x": [-0.01, 0.01],
                    "y": [0, 0.01], "onset": {"at": 1e-4, "force": 5.0, "deflection": 1e-4}, "first_growth": None,
                    "threshold_force": 100.0, "border_reached": False}],
    "plies": [{"ply": place, "made_of": "m", "angle": 45.0, "thickness": 1e-3} for place in (1, 2)],
    "warnings": [{"at": None, "text": "a warning"}], "costs": {"unknowns": 10, "wall_seconds": 1.5},
    "provenance": {"version": "0", "commit": "a", "compiler": "b", "petsc_version": "c", "ranks": "1", "started": "d",
                   "deck": "&case name='case' units='SI' /\n&plate length=0.1, 0.1 /"}}
COMPRESSION = {"residual_strength": 2e8, "shortening_at_strength": 7e-4, "effective_modulus": None, "has_failed": True,
               "failure_code": "LDM", "percent_bending": -4.0, "buckling_strain": 3.9e-3,
               "collapse": {"interfaces": [], "fibres": [{"ply": 2, "failed_across_width": True}]}}
COMPRESSION_COLUMNS = ("far_field_stress", "nominal_strain", "shortening", "work_external")
# Replacements of each kind of value.
JUNK = {str: ([], 3), bool: ("yes", 2), int: ("three", None, [1]), float: ("3", True, {}), list: (5, {}, None),
        dict: ([], "", 7)}
FREE = {"code", "title", "made_of", "deflection", "force", "unknowns", "wall_seconds", "ranks", "started"}


def places(value: object, path: tuple = ()) -> Iterator[tuple[tuple, object]]:
    """Yield every member with its path."""
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
        yield (*path, key), inner
        if isinstance(inner, (dict, list)):
            yield from places(inner, (*path, key))


class SummaryShapeTest(unittest.TestCase):
    """Each member."""

    def setUp(self) -> None:
        """Create a folder."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "case_summary.json"

    def write(self, summary: object) -> None:
        """Write a summary."""
        self.path.write_text(json.dumps(summary), encoding="utf-8")

    def test_whole(self) -> None:
        """A valid summary gives a page."""
        self.write(SUMMARY)
        self.assertEqual(missing_member(read_summary(self.path)), "")
        self.assertTrue(report.write_report(self.path, None).exists())

    def test_each_member_of_another_kind(self) -> None:
        """The message names the member."""
        for place, value in places(SUMMARY):
            for junk in () if place[-1] in FREE or value is None else JUNK[type(value)]:
                summary = copy.deepcopy(SUMMARY)
                inner = summary
                for key in place[:-1]:
                    inner = inner[key]
                if junk is None and place[0] == "interfaces" and place[-1] == "onset":
                    continue
                inner[place[-1]] = junk
                self.write(summary)
                with self.subTest(place=place, junk=junk), self.assertRaises(FileError) as caught:
                    read_summary(self.path)
                if len(place) > 1:
                    self.assertIn(str(place[0]), str(caught.exception))

    def test_earlier_names(self) -> None:
        """A summary of version 0.1.0 has another name for failures across the width."""
        collapse = {"interfaces": [], "fibres": [{"ply": 2, "went_across": True}]}
        self.write(SUMMARY | COMPRESSION | {"collapse": collapse})
        self.assertEqual(failed_across_width(read_summary(self.path)), ([], [2]))

    def test_each_member_left_out(self) -> None:
        """Without optional members there is a page, without required ones a message with the name."""
        columns = ("time", "force", "deflection", "indentation", "impactor_velocity", "impactor_displacement",
                   *(f"energy_{name}" for name in ENERGIES if name not in ("impact", "absorbed")), *COMPRESSION_COLUMNS)
        rows = [",".join([str(1e-4 * place), *["1.0"] * (len(columns) - 1)]) for place in range(4)]
        self.path.with_name("case_history.csv").write_text("\n".join([",".join(columns), *rows, ""]), encoding="utf-8")
        whole = SUMMARY | COMPRESSION
        for name in whole:
            self.write({key: value for key, value in whole.items() if key != name})
            # Figures are not drawn, which takes half a second and reads no further member.
            with self.subTest(name), mock.patch.object(report, "image", return_value=""):
                try:
                    report.write_report(self.path, None)
                except FileError as error:
                    self.assertRegex(str(error), f"lacks '{name}'|is not a summary")

    def test_faults_of_the_program_are_none_of_the_file(self) -> None:
        """An error of the page is not reported as one of the summary."""
        self.write(SUMMARY)
        for fault in (AttributeError, TypeError, KeyError):
            with self.subTest(fault), mock.patch.object(report, "layup_figure", side_effect=fault("within")), \
                    self.assertRaises(fault):
                report.write_report(self.path, None)


if __name__ == "__main__":
    unittest.main()
