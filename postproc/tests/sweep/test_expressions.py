"""Tests of formulas, and that only arithmetic is evaluated."""

import math
import unittest

from implam_post.io.errors import DeckError
from implam_post.sweep.expressions import evaluate

NAMES = {"energy": 2.0, "m": 1, "impactor.mass": 0.5, "material[2].E1": 4e9, "word": "a", "on": True}


def resolve(name: str) -> object:
    """Return the value of a name."""
    if name not in NAMES:
        raise DeckError(f"'{name}' is unknown.")
    return NAMES[name]


class ExpressionsTest(unittest.TestCase):
    """Valid and invalid formulas."""

    def test_values(self) -> None:
        """Arithmetic, functions, names and keys, lists; integers remain integers."""
        for formula, value in (("sqrt(2*energy/impactor.mass)", math.sqrt(8)), ("-m**2 + 2*3", 5.0),
                               ("material[2].E1/1e9", 4.0), (" [0, 45*m, -45] ", [0, 45, -45]), ("round(2.4)", 2),
                               ("min(pi, 4) - pi", 0.0), ("(1, 2)", [1, 2]), ("radians(180)/pi", 1.0)):
            found = evaluate(formula, resolve)
            self.assertEqual(found, value)
            self.assertIs(type(found), type(value), formula)

    def test_refused(self) -> None:
        """Code, unknown names and values that are not finite are refused quickly."""
        for formula in ("__import__('os').system('true')", "().__class__", "energy.real", "open('x')", "lambda: 1",
                        "m == 1",
                        "[x for x in (1,)]", "m if m else 2", "'a'", "word", "on", "nothing", "impactor.speed", "True",
                        "material[m].E1", "a.b.c", "f'{m}'", "m := 2", "sqrt(x=2)", "1/0", "sqrt(-1)", "(-1)**0.5",
                        "10**10**10", "9.**9.**9.", "exp(1e9)", "1e999", "None", "", "1 +", "[[1]]", "1j", "max()",
                        "(" * 500 + ")" * 500, "-" * 999 + "1", "+".join(["1"] * 600), "m % 2", "\0"):
            with self.subTest(formula), self.assertRaisesRegex(DeckError, "^the formula "):
                evaluate(formula, resolve)
