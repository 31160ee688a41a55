"""Tests of the figures of plates under compression."""

import json
import tempfile
import unittest
from pathlib import Path

import numpy as np

from implam_post.io.compression import failed_across_width, row_of_strength, strength_of
from implam_post.io.errors import FileError
from implam_post.io.history import History
from tests.io.test_summary_shape import SUMMARY


class CompressionTest(unittest.TestCase):
    """Strength and failures."""

    def test_strength_before_the_failure(self) -> None:
        """The load of the halves of a failed plate is not a strength; a drop at small strains is not a failure."""
        stress = np.array([10.0, 2, 90, 100, 65, 120])
        history = History({"far_field_stress": stress, "nominal_strain": np.array([0.1, 0.2, 2, 3, 4, 5]) * 1e-3})
        self.assertEqual(row_of_strength(history), 3)
        history = History({"far_field_stress": stress[:4], "nominal_strain": np.array([0.1, 0.2, 2, 3]) * 1e-3})
        self.assertEqual(row_of_strength(history), 3)

    def test_strength_of_another_run(self) -> None:
        """A summary without a strength is refused."""
        summary = SUMMARY | {"case": "a"}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a_summary.json"
            path.write_text(json.dumps(summary), encoding="utf-8")
            self.assertRaisesRegex(FileError, "no residual_strength", strength_of, path)
            path.write_text(json.dumps(summary | {"residual_strength": 3.5e8}), encoding="utf-8")
            self.assertEqual(strength_of(path), 3.5e8)

    def test_failed_across_width(self) -> None:
        """Only failures across the width are listed."""
        summary = {"collapse": {"interfaces": [{"ply_above": 2, "failed_across_width": False},
                                               {"ply_above": 4, "failed_across_width": True}],
                                "fibres": [{"ply": 1, "failed_across_width": True}]}}
        self.assertEqual(failed_across_width(summary), ([4], [1]))
        self.assertEqual(failed_across_width({}), ([], []))


if __name__ == "__main__":
    unittest.main()
