"""Tests of decks with changed keys."""

import unittest

from implam_post.io.deck_text import KeyPath, deck_value, key_path, number_of, set_keys
from implam_post.io.errors import DeckError
from implam_post.io.namelist import read_namelist
from tests.decks import SUN_CHEN

DECK = """! first & last / of 'all'
&Case name='it''s / &x' /
&delamination below_ply=1, G_c=400 ! G_c=1 /
  zone=30e-3, 20e-3 ! two
/
&delamination below_ply=2  G_c=3*5, zone = 10e-3,
   20e-3 /
"""


class DeckTextTest(unittest.TestCase):
    """Keys are changed, other text is not."""

    def test_paths(self) -> None:
        """A key may be numbered; group%key is the same as group.key; other texts are not keys."""
        self.assertEqual(key_path("delamination[2].G_c"), KeyPath("delamination", 2, "G_c"))
        self.assertEqual(key_path(" Case%title"), KeyPath("case", None, "title"))
        self.assertEqual(str(key_path("material[*].E1")), "material[*].E1")
        for text in ("energy", "a.b.c", "a[0].b", "a[x].b", "a[-1].b", ".b", "a.", "a[1]", "1.5"):
            self.assertIsNone(key_path(text), text)

    def test_values(self) -> None:
        """Values of TOML in the notation of decks; text that is valid in a deck is kept, other text is quoted."""
        for value, text in ((1, "1"), (2.5e-7, "2.5e-07"), (True, ".true."), ("8*90", "8*90"), ("", ""),
                            ("'a', \"b\"", "'a', \"b\""), ("clamped", "'clamped'"), (".false.", ".false."),
                            ("T300/976", "'T300/976'"), ("it's", "'it''s'"), ("1 / &x y=2", "'1 / &x y=2'"),
                            ("1 c=2", "'1 c=2'"), ("1 ! 2", "'1 ! 2'"), ([0, "4*90", 0.5], "0, 4*90, 0.5"),
                            (["a", "b"], "'a', 'b'"), ("[45/0]2s", "'[45/0]2s'")):
            self.assertEqual(deck_value(value), text)
        for value in (float("nan"), float("inf"), None, {"a": 1}):
            with self.assertRaises(DeckError):
                deck_value(value)

    def test_only_the_value_changes(self) -> None:
        """Comments, strings and other groups are kept."""
        changed = set_keys(DECK, {key_path("delamination[1].g_C"): "7"})
        self.assertEqual(changed, DECK.replace("G_c=400", "G_c=7"))
        changed = set_keys(DECK, {key_path("delamination[2].zone"): "1, 2"})
        self.assertEqual(changed, DECK.replace("10e-3,\n   20e-3", "1, 2"))

    def test_keys_that_are_new_all_or_out(self) -> None:
        """New keys and groups are added, all groups of a name changed together, keys removed."""
        settings = {"delamination[*].eta": "2", "delamination[2].G_c": "", "delamination[3].below_ply": "3",
                    "time.end": "1", "case.title": "'a'", "solver.tolerance": ""}
        groups = read_namelist(set_keys(DECK, {key_path(name): value for name, value in settings.items()}))
        first, second, third = groups["delamination"]
        self.assertEqual((first["eta"], first["zone"], second["eta"], third), ([2], [0.03, 0.02], [2],
                                                                               {"below_ply": [3]}))
        self.assertEqual((set(second), groups["time"], groups["case"][0]["title"], "solver" in groups),
                         ({"below_ply", "zone", "eta"}, [{"end": [1]}], ["a"], False))

    def test_what_cannot_be_set(self) -> None:
        """Several groups without a number, a gap, and a deck that cannot be read."""
        for path, deck in (("delamination.G_c", DECK), ("delamination[4].G_c", DECK), ("case.title", "&case name= /")):
            with self.assertRaises(DeckError):
                set_keys(deck, {key_path(path): "1"})

    def test_numbers(self) -> None:
        """A number of the deck, or an error if the value is not a single number."""
        self.assertEqual(number_of(SUN_CHEN, key_path("impactor.mass")), 8.537e-3)
        self.assertEqual(number_of(DECK, key_path("delamination[2].below_ply")), 2)
        for path in ("delamination.G_c", "delamination[2].G_c", "delamination[3].G_c", "case.name", "time.end"):
            with self.assertRaises(DeckError):
                number_of(DECK, key_path(path))
