"""Tests of the section on compressive strength of a page."""

import unittest
from types import SimpleNamespace

import numpy as np

from implam_post.io.history import History
from implam_post.plot.compression import compression_figure, remark_of
from implam_post.plot.style import PictureStyle
from implam_post.report.compression import compression_rows

_SUMMARY = {"residual_strength": 2e8, "shortening_at_strength": 7e-4, "effective_modulus": None, "has_failed": True,
            "failure_code": "LDM", "percent_bending": -4.0, "buckling_strain": 3.9e-3, "kinetic_share": 0.01,
            "collapse": {"interfaces": [], "fibres": [{"ply": 3, "failed_across_width": True}]}}
_HISTORY = History({"time": np.arange(3.0), "far_field_stress": np.array([0.0, 1e8, 2e8]),
                    "nominal_strain": np.array([0.0, 2e-3, 4e-3]), "shortening": np.array([0.0, 3e-4, 6e-4])})


class CompressionRowsTest(unittest.TestCase):
    """Rows of a run."""

    def _rows(self, summary: dict[str, object], undamaged: float | None = None) -> dict[str, str]:
        """Return the rows by their labels."""
        run = SimpleNamespace(summary=summary, columns=_HISTORY)
        return {label: value for label, value, _ in compression_rows(run, PictureStyle("SI"), undamaged)}

    def test_rows(self) -> None:
        """Strength, retained fraction, and failures."""
        rows = self._rows(_SUMMARY, 4e8)
        self.assertEqual(rows["retained fraction of the undamaged strength"], "0.500")
        self.assertEqual(rows["failure code of ASTM D7137"], "LDM")
        self.assertEqual(rows["plies with fibre failure across the width"], "3")
        self.assertEqual(rows["interfaces delaminated across the width"], "none")
        self.assertEqual(rows["largest kinetic energy over the work of the load"], "1 %")
        self.assertEqual(rows["effective modulus"], "-")

    def test_without_compression_or_failure(self) -> None:
        """No section without a compressive &line, and no failure rows for a plate that has not failed."""
        self.assertEqual(self._rows({}), {})
        self.assertNotIn("largest kinetic energy over the work of the load", self._rows(
            {name: value for name, value in _SUMMARY.items() if name != "kinetic_share"}))
        rows = self._rows(_SUMMARY | {"has_failed": False, "failure_code": None})
        self.assertNotIn("failure code of ASTM D7137", rows)
        self.assertNotIn("retained fraction of the undamaged strength", rows)

    def test_legend(self) -> None:
        """The legend has strength, retained fraction, code and bending, and the strength of the undamaged plate."""
        style = PictureStyle("SI")
        remark = remark_of(_SUMMARY, style, 4e8)
        self.assertEqual(remark, "200 MPa, 50 % of the undamaged plate, LDM, bending -4 %")
        axes = compression_figure({"": _HISTORY}, style, {"": remark}, 4e8).axes[0]
        entries = [text.get_text() for text in axes.get_legend().get_texts()]
        self.assertEqual(entries, [remark, "strength", "undamaged plate"])
        self.assertEqual(remark_of(_SUMMARY | {"has_failed": False}, style), "200 MPa, not failed, bending -4 %")
        self.assertEqual(remark_of({}, style), "")


if __name__ == "__main__":
    unittest.main()
