"""Tests of the semi-analytic impact against independently computed values and closed forms."""

import unittest

import numpy as np
from scipy.signal import fftconvolve

from implam_post.io.errors import DeckError
from implam_post.io.history import History
from implam_post.io.quantities import contact, peak, rebound_velocity, second_peak
from implam_post.reference.check_impact import notes
from implam_post.reference.decks import indentation_law_of
from implam_post.reference.navier import centre_shape, odd_pairs, patch_shape
from implam_post.reference.semi_analytic import (
    _kernels,
    _static_rest,
    _sum_of_sines,
    impact_case,
    respond,
    semi_analytic,
)
from tests.decks import KARAS, SUN_CHEN, deck

TAN_SUN = ("law='hertz'", "law='tan_sun'")
MICROSECOND = 1e-6


class KarasTest(unittest.TestCase):
    """Steel on steel; tolerances are the rounding of the values, and 0.1 microseconds for contact times."""

    def test_patches(self) -> None:
        """Peak force and its time, end of contact and rebound for three sizes of the patch."""
        for patch, force, time, release, velocity in (("4", 1337.76, 33.30, 75.0, 0.65748),
                                                      ("5", 1343.24, 33.19, 74.7, 0.65694),
                                                      ("10", 1369.20, 32.79, 73.6, 0.65747)):
            history = semi_analytic(deck(KARAS, ("5.0d-3", patch + "d-3")))
            found = peak(history, "force")
            with self.subTest(patch):
                self.assertAlmostEqual(found.value, force, delta=0.011)
                self.assertAlmostEqual(found.time / MICROSECOND, time, delta=0.01)
                self.assertAlmostEqual(contact(history, 0).end / MICROSECOND, release, delta=0.1)
                self.assertAlmostEqual(rebound_velocity(history), velocity, delta=6e-6)

    def test_course_of_the_force(self) -> None:
        """Forces every 10 microseconds with a patch of 0.8 mm; the values differ by 0.3 N from the converged ones."""
        history = semi_analytic(deck(KARAS, ("5.0d-3", "0.8d-3")))
        found = [history.at("force", 10 * MICROSECOND * number) for number in range(1, 9)]
        np.testing.assert_allclose(found, [418.3, 961.9, 1281.2, 1248.3, 927.6, 491.8, 120.6, 0], atol=0.4)


class SunChenTest(unittest.TestCase):
    """The laminate with two contacts."""

    def check(self, history: History, contacts: tuple, second: tuple, deflection: tuple, velocity: float) -> None:
        """Compare with values in newtons, microseconds, millimetres and metres per second, to their rounding."""
        first = peak(history, "force")
        self.assertAlmostEqual(first.value, 298.87, delta=0.006)
        self.assertAlmostEqual(first.time / MICROSECOND, 39.9, delta=0.05)
        found = [time / MICROSECOND for number in (0, 1) for time in contact(history, number)]
        np.testing.assert_allclose(found, contacts, atol=0.15)
        again, lowest = second_peak(history), peak(history, "deflection")
        np.testing.assert_allclose([again.value, again.time / MICROSECOND], second, atol=0.05)
        self.assertAlmostEqual(lowest.value * 1e3, deflection[0], delta=6e-5)
        self.assertAlmostEqual(lowest.time / MICROSECOND, deflection[1], delta=0.5)
        self.assertAlmostEqual(history["impactor_velocity"][-1], velocity, delta=6e-5)

    def test_elastic(self) -> None:
        """Hertz's law in loading and unloading."""
        self.check(semi_analytic(deck(SUN_CHEN)), (0, 220.2, 344.0, 415.0), (83.1, 380.0), (0.4265, 850), -0.5178)

    def test_tan_sun(self) -> None:
        """Unloading with q = 2.5, reloading with 1.5 after separation."""
        history = semi_analytic(deck(SUN_CHEN, TAN_SUN))
        self.check(history, (0, 247.6, 315.0, 412.3), (90.8, 375.3), (0.4312, 852), -0.6134)

    def test_convergence(self) -> None:
        """Half the step length and twice the modes change force, deflection and velocity by less than 1e-5."""
        case = impact_case(deck(SUN_CHEN, TAN_SUN))
        usual = respond(case)
        for other in (respond(case, step=case.default_step() / 2), respond(case, modes=2 * case.default_modes()[0])):
            for column in ("force", "deflection", "impactor_velocity"):
                found = np.interp(usual.time, other.time, other[column])
                self.assertLess(np.max(np.abs(found - usual[column])), 1e-5 * np.max(np.abs(usual[column])), column)


class ClosedFormTest(unittest.TestCase):
    """Parts of the method with known solutions."""

    def test_rigid_plate(self) -> None:
        """On a rigid plate: Hertz's peak force and contact time, rebound with the initial velocity."""
        history = semi_analytic(deck(KARAS, ("E=206.8e9", "E=206.8e17"), ("density=7833", "density=7833e6")))
        expected = 1.49595e10**0.4 * (1.25 * 0.0328108)**0.6
        max_indentation = (expected / 1.49595e10)**(2 / 3)
        self.assertAlmostEqual(peak(history, "force").value / expected, 1, delta=2e-6)
        self.assertAlmostEqual(contact(history, 0).end / (2.9432 * max_indentation), 1, delta=1e-4)
        self.assertAlmostEqual(rebound_velocity(history), 1, delta=1e-5)

    def test_gravity(self) -> None:
        """A sphere with nearly no velocity indents under gravity until plate and contact carry its weight."""
        history = semi_analytic(deck(KARAS, ("velocity=1", "velocity=0 gravity=9.81"), ("120e-6", "20e-3")))
        weight = 0.0328108 * 9.81
        self.assertAlmostEqual(np.mean(history["force"]) / weight, 1, delta=0.05)
        momentum = 0.0328108 * history["impactor_velocity"][-1]
        force = history["force"]
        impulse = np.sum(weight - (force[1:] + force[:-1]) / 2) * history.time[1]
        self.assertAlmostEqual(impulse, momentum, delta=1e-12)

    def test_refused(self) -> None:
        """Eccentric impact, lines, stringers and initial states are refused."""
        for change in ("&impactor at=0.02, 0 ", "&line at=0 displacement=0 /\n&impactor ",
                       "&stringer at=0 EA=1 /\n&impactor ", "&initial_state from='a_restart.h5' /\n&impactor "):
            with self.subTest(change):
                self.assertRaisesRegex(DeckError, "the semi-analytic solution", impact_case,
                                       deck(KARAS, ("&impactor ", change)))
        impact_case(deck(KARAS, ("&impactor ", "&impactor at=0, 0 ")))

    def test_struck_face(self) -> None:
        """Contact stiffness with the modulus E3 of the struck face; that of a laminate has to be given."""
        laws = [indentation_law_of(deck(SUN_CHEN, ("k=8.112e8", change))) for change in ("E3=7.9e9", "E3=15.8e9", "")]
        self.assertAlmostEqual(laws[1].stiffness / laws[0].stiffness, 2, delta=1e-12)
        self.assertAlmostEqual(laws[2].stiffness / laws[0].stiffness, 1, delta=1e-12)
        self.assertRaisesRegex(DeckError, "k or E3", indentation_law_of,
                               deck(SUN_CHEN, ("k=8.112e8", "face='laminate'")))

    def test_isotropic_face(self) -> None:
        """Steel on steel: Hertz's stiffness, 4/3 sqrt(R) E/(2 (1 - nu**2)), which the deck gives."""
        law = indentation_law_of(deck(KARAS, (" k=1.49595e10", " impactor_E=206.8e9 impactor_nu=0.28")))
        self.assertAlmostEqual(law.stiffness / 1.49595e10, 1, delta=1e-6)

    def test_what_it_does_not_model(self) -> None:
        """Notes on large deflection and contact of a sphere."""
        self.assertEqual(notes(deck(KARAS)), [])
        found = notes(deck(KARAS, ("kinematics='linear'", ""), ("&impactor ", "&impactor contact_area='sphere' ")))
        self.assertEqual(len(found), 2)
        self.assertIn("sphere", found[1])

    def test_one_pair_of_half_waves(self) -> None:
        """The response to a linearly growing force is that of three oscillators."""
        case = impact_case(deck(KARAS))
        plate = case.plate
        step, count = 2e-6, 200
        patch, centre = _kernels(case, 1, step, count)
        rest = _static_rest(case, [1, 1])
        time = step * np.arange(count + 1)
        m, n = odd_pairs(1, 1)
        frequency, deflection = (values[0] for values in plate.modes(m, n))
        for kernel, static, shape in ((patch, rest[0], patch_shape(plate, case.patch, m, n)),
                                      (centre, rest[1], centre_shape(m, n))):
            factor = 4 / 0.04 * deflection**2 * patch_shape(plate, case.patch, m, n) * shape
            expected = static * time + sum(
                c * (time / w**2 - np.sin(w * time) / w**3) for c, w in zip(factor, frequency, strict=True))
            np.testing.assert_allclose(fftconvolve(kernel, time)[:len(time)], expected, atol=1e-12 * np.max(expected))

    def test_static_limit(self) -> None:
        """All modes under a slowly applied force: the compliance of the patch by direct summation."""
        case = impact_case(deck(KARAS, ("120e-6", "0.1")))
        patch, _ = _kernels(case, 20, 5e-6, 20000)
        force = np.linspace(0, 1, 20001)**2 * (3 - 2 * np.linspace(0, 1, 20001))
        m, n = odd_pairs(400, 400)
        shape = patch_shape(case.plate, case.patch, m, n)
        expected = 4 / 0.04 * np.sum(shape**2 * case.plate.compliance(m, n))
        self.assertAlmostEqual(fftconvolve(patch, force)[len(force) - 1] / expected, 1, delta=1e-5)

    def test_sum_of_sines(self) -> None:
        """The split into coarse and fine angles is exact to round-off."""
        generator = np.random.default_rng(1)
        amplitude, frequency = generator.random((2, 9000)), 1e6 * generator.random(9000)
        found = _sum_of_sines(amplitude, frequency, 1e-6, 30)
        expected = amplitude @ np.sin(np.outer(frequency, 1e-6 * np.arange(31)))
        np.testing.assert_allclose(found, expected, atol=1e-9)

    def test_balance_of_energy(self) -> None:
        """Elastic indentation dissipates nothing: the energy lost by the sphere is the work on the plate."""
        history = semi_analytic(deck(SUN_CHEN))
        force, deflection = history["force"], history["patch_deflection"]
        work = np.sum((force[1:] + force[:-1]) / 2 * np.diff(deflection))
        lost = 8.537e-3 / 2 * (9 - history["impactor_velocity"][-1]**2)
        self.assertAlmostEqual(work / lost, 1, delta=1e-5)
