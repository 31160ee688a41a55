"""Tests of the groups of a deck."""

import unittest
from pathlib import Path

import numpy as np

from implam_post.io.deck import Deck, recorded_deck
from implam_post.io.errors import DeckError
from implam_post.laminate.decks import plies_of, section_of_deck
from implam_post.reference.decks import indentation_law_of
from implam_post.reference.semi_analytic import impact_case
from tests.decks import KARAS, SUN_CHEN, deck


class DeckTest(unittest.TestCase):
    """Defaults, broadcast values and refusals."""

    def test_contact_stiffness_by_suns_formula(self) -> None:
        """Without k: 4/3 sqrt(R) E2 for a rigid sphere, less for an elastic one."""
        rigid = indentation_law_of(deck(SUN_CHEN, ("k=8.112e8", "")))
        self.assertAlmostEqual(rigid.stiffness / (4 / 3 * np.sqrt(6.35e-3) * 7.9e9), 1, delta=1e-14)
        steel = indentation_law_of(deck(SUN_CHEN, ("k=8.112e8", "impactor_E=206.8e9 impactor_nu=0.28")))
        self.assertAlmostEqual(steel.stiffness / (4 / 3 * np.sqrt(6.35e-3) / (0.9216 / 206.8e9 + 1 / 7.9e9)), 1,
                               delta=1e-14)
        elastic = deck(SUN_CHEN, ("&indentation law='hertz' k=8.112e8 alpha_cr=80.3e-6 /", ""))
        self.assertTrue(indentation_law_of(elastic).hertz)

    def test_laminate(self) -> None:
        """A single thickness and material are for all plies, and G13 is G12 if it is not given."""
        section = section_of_deck(deck(SUN_CHEN))
        self.assertAlmostEqual(section.thickness, 2.69e-3, delta=1e-17)
        self.assertAlmostEqual(section.s[0, 0] / (5 / 6 * 5.5e9 * 2.69e-3), 1, delta=1e-14)
        one = section_of_deck(deck(SUN_CHEN, ("10*0.269e-3", "0.269e-3")))
        np.testing.assert_array_equal(one.d, section.d)

    def test_values_of_published_materials(self) -> None:
        """Values of published materials are read from the results of a run; values in the deck have precedence."""
        text = "&material name='a' library='b' E1=2 /"
        adopted = "&material 1 E1 = 130e9 [library b, source a]\n&material 1 nu12 = .30e0 [library b, source a]"
        found = recorded_deck({"deck": text, "library": adopted}, Path("a.nml"))
        self.assertEqual(found.groups["material"][0]["nu12"], [0.3])
        self.assertEqual(found.groups["material"][0]["e1"], [2])
        self.assertNotIn("nu12", recorded_deck({"deck": text}, Path("a.nml")).groups["material"][0])
        text += "\n&laminate materials='a' angles=0 thicknesses=1 /"
        with self.assertRaisesRegex(DeckError, "G12 comes from library = 'b'"):
            plies_of(Deck(text, Path("a.nml")))
        whole = adopted + "\n&material 1 G12 = 5e9 [b]\n&material 1 G23 = 3e9 [b]\n&material 1 E2 = 9e9 [b]"
        material = plies_of(recorded_deck({"deck": text.replace("E1=2", "E1=2e11"), "library": whole}, Path("a.nml")))
        self.assertEqual((material[0].material.e1, material[0].material.g13), (2e11, 5e9))

    def test_deck_in_latin_1(self) -> None:
        """The deck in the results of a run may have letters in Latin 1."""
        provenance = {"deck": {(): "&case title='Prüfung' /\n".encode("latin-1")}}
        self.assertEqual(recorded_deck(provenance, Path("case.h5")).groups["case"][0]["title"], ["Prüfung"])

    def test_names_in_capitals(self) -> None:
        """Groups and keys may be written in any case, as in a deck."""
        self.assertTrue(deck(SUN_CHEN).has("Plate"))
        self.assertEqual(deck(SUN_CHEN).numbers("PLATE", "Length"), deck(SUN_CHEN).numbers("plate", "length"))

    def test_invalid_decks_are_refused(self) -> None:
        """Every deck outside the scope of the method is refused with the reason."""
        ten = "angles=0,90,0,90,0,0,90,0,90,0"
        changes = {
            "simple": ("edges=4*'simple'", "edges=3*'simple','free'"),
            "couples": (ten, "angles=5*0,5*90"),
            "Navier": (ten, "angles=45,-45,45,-45,0,0,-45,45,-45,45"),
            "no &impactor": ("&impactor mass=8.537e-3 velocity=3 radius=6.35e-3 /", ""),
            "patch": ("patch=5e-3", ""),
            "material is named": ("materials='carbon'", "materials='glass'"),
            "1 or 10": ("10*0.269e-3", "9*0.269e-3"),
            "alpha_cr": ("law='hertz' k=8.112e8 alpha_cr=80.3e-6", "k=8.112e8"),
            "reload": ("law='hertz' k=8.112e8", "q=1.2"),
            "not one of tan_sun": ("law='hertz'", "law='plastic'"),
            "no support but the edges": ("&time", "&support window=0.1, 0.1 /\n&time"),
            "free impactor": ("velocity=3", "travel=1e-4"),
            "is not a number": ("velocity=3", "velocity=NaN"),
            "load but the impactor": ("&time", "&pressure value=1 /\n&time"),
        }
        for reason, change in changes.items():
            with self.subTest(reason), self.assertRaisesRegex(DeckError, reason):
                impact_case(deck(SUN_CHEN, change))

    def test_isotropic_material(self) -> None:
        """E and nu give the bending stiffness of a plate."""
        section = section_of_deck(deck(KARAS))
        stiffness = 206.8e9 * 8e-3**3 / (12 * (1 - 0.28**2))
        np.testing.assert_allclose(section.d, stiffness * np.array([[1, 0.28, 0], [0.28, 1, 0], [0, 0, 0.36]]),
                                   rtol=1e-13, atol=1e-13 * stiffness)
