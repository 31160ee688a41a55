"""Tests of the indentation law."""

import unittest

from implam_post.reference.indentation import IndentationLaw


class IndentationTest(unittest.TestCase):
    """Loading, unloading, reversal, separation, reloading and permanent indentation."""

    def test_course_of_tan_suns_law(self) -> None:
        """Each branch has its formula, and the force is continuous."""
        law = IndentationLaw(8.0, slope=0.1, critical=0.5)
        law.commit(1.5)
        self.assertAlmostEqual(law.permanent, 0.1, delta=1e-15)
        top = 8.0 * 1.5**1.5
        law.commit(0.8)
        self.assertAlmostEqual(law.force(0.8), top * 0.5**2.5, delta=1e-13)
        self.assertAlmostEqual(law.force(1.45), top * (1.35 / 1.4)**2.5, delta=1e-12)
        self.assertAlmostEqual(law.force(1.5 - 1e-13), top, delta=1e-10)
        law.commit(0.05)
        self.assertEqual(law.force(0.09), 0.0)
        self.assertAlmostEqual(law.force(0.8), top * 0.5**1.5, delta=1e-13)
        law.commit(2.0)
        self.assertAlmostEqual(law.permanent, 0.15, delta=1e-15)
        self.assertAlmostEqual(law.force(1.0), 8.0 * 2.0**1.5 * (0.85 / 1.85)**2.5, delta=1e-12)

    def test_dents(self) -> None:
        """No permanent indentation below the critical one; Yang and Sun's formula above it."""
        law = IndentationLaw(1.0, critical=0.5, dent="yang_sun")
        law.commit(0.5)
        self.assertEqual(law.permanent, 0.0)
        law.commit(1.0)
        self.assertAlmostEqual(law.permanent, 1 - 0.5**0.4, delta=1e-15)

    def test_hertz_has_no_history(self) -> None:
        """Loading and unloading are equal."""
        law = IndentationLaw(2.0, hertz=True)
        law.commit(4.0)
        self.assertEqual(law.force(1.0), 2.0)
