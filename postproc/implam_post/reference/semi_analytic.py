"""Impact of a rigid sphere on the centre of a simply supported laminate, by superposition of Navier's modes.

The force is linear between equally spaced instants. The motion of plate and sphere under it is exact, and the only
unknown of an instant is its force. The indentation contains the mean deflection of the patch, which is conjugate to the
load.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq
from scipy.signal import fftconvolve

from implam_post.io.deck import Deck
from implam_post.io.history import History
from implam_post.io.shapes import curvatures_of
from implam_post.laminate.decks import section_of_deck
from implam_post.reference.decks import Impactor, impactor_of, indentation_law_of
from implam_post.reference.indentation import IndentationLaw
from implam_post.reference.navier import Plate, centre_shape, odd_pairs, patch_shape

# Half waves per side of the patch up to which modes have inertia, and up to which they add static compliance.
_DYNAMIC_HALF_WAVES, _STATIC_HALF_WAVES = 2, 20
_STEPS_A_CONTACT, _MIN_STEPS, _MAX_STEPS = 1000, 2000, 40000
_MODES_AT_ONCE = 8192


@dataclass(frozen=True)
class ImpactCase:
    """Plate, sphere and indentation law of one impact, and the end time."""

    plate: Plate
    impactor: Impactor
    law: IndentationLaw
    patch: float
    end: float

    def default_step(self) -> float:
        """Return a step of a thousandth of the contact time on a rigid base, with limits for the number of steps."""
        speed = abs(self.impactor.velocity) or np.finfo(float).tiny**0.25
        max_indentation = (1.25 * self.impactor.mass * speed**2 / self.law.stiffness)**0.4
        contact = 2.943 * max_indentation / speed
        return float(np.clip(contact / _STEPS_A_CONTACT, self.end / _MAX_STEPS, self.end / _MIN_STEPS))

    def default_modes(self) -> list[int]:
        """Return the default number of odd half-wave numbers with inertia along x and y."""
        return [max(10, round(_DYNAMIC_HALF_WAVES * length / (2 * self.patch))) for length in self.plate.lengths]


def impact_case(deck: Deck) -> ImpactCase:
    """Return the impact of a deck; raise DeckError with the reason if there is no semi-analytic solution."""
    impactor = impactor_of(deck)
    if set(deck.edges()) != {"simple"}:
        raise deck.error("plate", "the semi-analytic solution needs edges = 'simple' on all sides.")
    for group in ("pressure", "static", "line", "support", "stringer"):
        if deck.has(group):
            raise deck.error(group, "the semi-analytic solution admits no load but the impactor, no support but the "
                                    "edges, and no stringers.")
    if deck.has("initial_state"):
        raise deck.error("initial_state", "the semi-analytic solution begins with an undamaged plate at rest.")
    if any(deck.numbers("impactor", "at")):
        raise deck.error("impactor", "the semi-analytic solution needs an impact at the plate's centre, at = 0, 0.")
    patch, end = deck.number("mesh", "patch", 0.0), deck.number("time", "end")
    if not 0 < patch <= min(deck.lengths()):
        raise deck.error("mesh", "patch must be greater than zero and no larger than the plate: under a point load the "
                                 "deflection of a shear-deformable plate is infinite.")
    if end <= 0:
        raise deck.error("time", "end must be greater than zero.")
    curvatures = curvatures_of(deck)
    if any(curvatures) and deck.choice("plate", "in_plane", ("fixed", "free", "tangential")) != "tangential":
        raise deck.error("plate", "the semi-analytic solution of a curved plate needs in_plane = 'tangential'.")
    plate = Plate(section_of_deck(deck), deck.lengths(), curvatures)
    return ImpactCase(plate, impactor, indentation_law_of(deck), patch, end)


def semi_analytic(deck: Deck, modes: int | None = None, step: float | None = None) -> History:
    """Return the semi-analytic history of the impact of a deck.

    Its columns are a subset of those of the solver's history, and `patch_deflection`. `modes` is the number of odd
    half-wave numbers with inertia along each side, `step` the time between instants.
    """
    return respond(impact_case(deck), modes, step, deck.name)


def respond(case: ImpactCase, modes: int | None = None, step: float | None = None, name: str = "") -> History:
    """Integrate the coupled motion of plate and sphere; see `semi_analytic`."""
    count = int(np.ceil(case.end / (step or case.default_step())))
    step = case.end / count
    patch_kernel, centre_kernel = _kernels(case, modes, step, count)
    force, displacement, velocity, indentation = _march(case, patch_kernel, step)
    return History({
        "time": step * np.arange(count + 1),
        "force": force,
        "indentation": indentation,
        "impactor_displacement": displacement,
        "impactor_velocity": velocity,
        "deflection": fftconvolve(centre_kernel, force)[:count + 1],
        "patch_deflection": fftconvolve(patch_kernel, force)[:count + 1],
    }, f"semi-analytic {name}".strip())


def _kernels(case: ImpactCase, modes: int | None, step: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the deflections of patch and centre at all instants after a triangular unit force pulse of two steps h.

    A mode of frequency w and coefficient c deflects by c/w**2 (1 - sin(w h)/(w h)) at the peak of the force and by
    4 c sin(w h/2)**2 sin(w t)/(w**3 h) after it.
    """
    plate = case.plate
    dynamic = [modes, modes] if modes else case.default_modes()
    area = plate.lengths[0] * plate.lengths[1]
    m, n = odd_pairs(*dynamic)
    shape = patch_shape(plate, case.patch, m, n)
    frequency, deflection = plate.modes(m, n)
    coefficient = 4 / area * shape[:, None] * deflection**2
    frequency, weights = frequency.ravel(), np.stack([(coefficient * shape[:, None]).ravel(),
                                                      (coefficient * centre_shape(m, n)[:, None]).ravel()])
    amplitude = 4 * weights * np.sin(frequency * step / 2)**2 / (frequency**3 * step)
    kernels = _sum_of_sines(amplitude, frequency, step, count)
    kernels[:, 0] = np.sum(weights / frequency**2 * (1 - np.sinc(frequency * step / np.pi)), axis=1)
    kernels[:, 0] += _static_rest(case, dynamic)
    return kernels[0], kernels[1]


def _static_rest(case: ImpactCase, dynamic: list[int]) -> np.ndarray:
    """Return the static compliance of patch and centre by the modes without inertia."""
    plate = case.plate
    area = plate.lengths[0] * plate.lengths[1]
    farthest = [max(few, round(_STATIC_HALF_WAVES * length / (2 * case.patch)))
                for few, length in zip(dynamic, plate.lengths, strict=True)]
    rest = np.zeros(2)
    for row in range(farthest[0]):
        first = dynamic[1] if row < dynamic[0] else 0
        n = 2 * np.arange(first, farthest[1]) + 1
        m = np.full_like(n, 2 * row + 1)
        shape = patch_shape(plate, case.patch, m, n)
        compliance = 4 / area * shape * plate.compliance(m, n)
        rest += [compliance @ shape, compliance @ centre_shape(m, n)]
    return rest


def _sum_of_sines(amplitude: np.ndarray, frequency: np.ndarray, step: float, count: int) -> np.ndarray:
    """Return the sum of amplitude * sin(frequency * t) at t = 0, step ... count*step, for each row of `amplitude`.

    Angles are split into a coarse and a fine part, so that the sum becomes a product of two small tables.
    """
    block = int(np.ceil(np.sqrt(count + 1)))
    total = np.zeros((len(amplitude), block, block))
    for first in range(0, len(frequency), _MODES_AT_ONCE):
        part = slice(first, first + _MODES_AT_ONCE)
        fine = np.outer(step * np.arange(block), frequency[part])
        coarse = block * fine
        sine, cosine = np.sin(fine).T, np.cos(fine).T
        for row, weight in zip(total, amplitude[:, part], strict=True):
            row += (weight * np.sin(coarse)) @ cosine + (weight * np.cos(coarse)) @ sine
    return total.reshape(len(amplitude), -1)[:, :count + 1]


def _march(case: ImpactCase, kernel: np.ndarray, step: float) -> tuple[np.ndarray, ...]:
    """Integrate in time; return force, displacement and velocity of the sphere, and indentation."""
    instants = len(kernel)
    backwards = kernel[::-1].copy()
    force, displacement, velocity, indentation = (np.zeros(instants) for _ in range(4))
    velocity[0] = case.impactor.velocity
    mass, gravity = case.impactor.mass, case.impactor.gravity
    compliance = kernel[0] + step**2 / (6 * mass)
    law = replace(case.law)
    for now in range(1, instants):
        past = force[now - 1]
        free = displacement[now - 1] + step * velocity[now - 1] + step**2 * (gravity / 2 - past / (3 * mass))
        deflection = backwards[instants - now:instants - 1] @ force[1:now]
        indentation[now] = solve_indentation(law, free - deflection, compliance)
        law.commit(indentation[now])
        force[now] = law.force(indentation[now])
        displacement[now] = free - step**2 / (6 * mass) * force[now]
        velocity[now] = velocity[now - 1] + step * (gravity - (past + force[now]) / (2 * mass))
    return force, displacement, velocity, indentation


def solve_indentation(law: IndentationLaw, free: float, compliance: float) -> float:
    """Solve alpha = free - compliance * F(alpha) for the indentation alpha."""
    if free <= law.permanent:
        return free
    return brentq(lambda alpha: alpha + compliance * law.force(alpha) - free, law.permanent, free,
                  xtol=1e-14 * abs(free))
