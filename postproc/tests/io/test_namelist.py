"""Tests of the namelist reader."""

import unittest

from implam_post.io.errors import DeckError
from implam_post.io.namelist import read_namelist


class NamelistTest(unittest.TestCase):
    """Valid and invalid decks."""

    def test_values_of_every_kind(self) -> None:
        """Numbers, logicals, strings, comments, repeat counts and subscripts are read."""
        groups = read_namelist("""! & a comment / with 'signs
            &One A=1, -2.5d-3 3*.5 ! and = here
               title='it''s a / ! text', other = "x" on=.TRUE. off=f /
            &two edges(1)='free' edges(2)=3*'simple' / &two c=1/""")
        self.assertEqual(groups["one"], [{"a": [1.0, -2.5e-3, 0.5, 0.5, 0.5], "title": ["it's a / ! text"],
                                          "other": ["x"], "on": [True], "off": [False]}])
        self.assertEqual(groups["two"], [{"edges": ["free", "simple", "simple", "simple"]}, {"c": [1.0]}])

    def test_faults_are_reported_with_their_line(self) -> None:
        """Each error is one sentence with the line number."""
        faults = {"\n&a b=1": 2, "&a\nb= c=1 /": 2, "&a b='x\n' /": 1, "&a b=1\nb=2 /": 2, "&a b=xyz /": 1,
                  "&a\n\n b(3)=1 /": 3, "a=1": 1, "&a 1 /": 1, "&a b=3* /": 1, "&a b=1 &c d=1 /": 1}
        for text, line in faults.items():
            with self.subTest(text), self.assertRaisesRegex(DeckError, f"^deck:{line}: "):
                read_namelist(text)
