"""The figures of an impact that ASTM D7136 requires: threshold force, energies, size and type of the damage."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from implam_post.io.contours import outline
from implam_post.io.counts import listed
from implam_post.io.fields import Fields, struck_point
from implam_post.io.history import History
from implam_post.io.quantities import impact_energy, peak

# Corner frequency, Hz, of the low-pass filter of the force: the lowest natural frequency of load cell and impactor that
# ASTM D7136 permits. The force_filter of a deck replaces it.
CORNER = 6e3
# Thresholds for a drop by damage: the drop over the force, and the energy dissipated by plies and interfaces over the
# energy F w/2 that a drop F releases at fixed displacement w. In panels impacted with 6.5, 10 and 25 J the latter ratio
# is up to .04 for drops by vibration and at least .18 for drops in which plies and interfaces fail.
_MIN_FORCE_DROP, _MIN_ENERGY_RATIO = 0.02, 0.1
# Delay of the filter, in radians at the corner frequency.
_DELAY = 2.6
# Time steps of the filter per period of the corner frequency, and the required rows of the history per period.
_STEPS, _FEWEST_ROWS = 20, 4
_DISSIPATED = ("energy_delamination", "energy_ply_damage")
# Directions in which the extent of the damage is measured, degrees.
DIRECTIONS = (0, 45, 90, -45)


@dataclass(frozen=True)
class Threshold:
    """First drop of the force by damage: filtered force, time, energy transferred until then, corner frequency.

    The time is that of the force before the filter, which delays it.
    """

    force: float
    time: float
    energy: float
    corner: float


@dataclass(frozen=True)
class Extent:
    """Size of the projected damage: largest diameter, lengths along x and y, and the distance of its outermost points
    on lines through the struck point, by direction.

    The largest diameter is in `direction`, to `direction_error`, both in degrees: in these directions the damage is
    shorter by less than the diagonal of an element, to which its outline is known.
    """

    diameter: float
    direction: float
    direction_error: float
    length: float
    width: float
    through: dict[int, float]


def low_pass(time: np.ndarray, values: np.ndarray, corner: float) -> tuple[np.ndarray, np.ndarray]:
    """Return equally spaced times and values after a causal 4th-order Butterworth low-pass filter, from zero on."""
    from scipy.signal import butter, sosfilt

    step = min(1 / (_STEPS * corner), float(np.min(np.diff(time), initial=np.inf)))
    step = max(step, 1 / (50 * _STEPS * corner))
    even = np.arange(0.0, time[-1] + step / 2, step)
    return even, sosfilt(butter(4, corner, fs=1 / step, output="sos"), np.interp(even, time, values, left=0.0))


def threshold(history: History, corner: float) -> Threshold | None:
    """Return the first drop of the force by damage while the impactor moves towards the plate; None if there is none.

    The force is low-pass filtered with this corner frequency. A drop by damage is at least 2 % of the force, and plies
    and interfaces dissipate at least a tenth of F w/2 in it, where F is the drop and w the displacement. A loss of
    stiffness releases F w/2 at fixed displacement; in a drop by vibration little is dissipated.
    """
    time, w = history.time, history["impactor_displacement"]
    if not np.any(w) or not np.any(history["force"]) or len(time) < _FEWEST_ROWS * time[-1] * corner:
        return None
    even, force = low_pass(time, history["force"], corner)
    delay = _DELAY / (2 * math.pi * corner)
    dissipated = np.interp(even - delay, time, sum(history[name] for name in _DISSIPATED))
    displacement = np.interp(even - delay, time, w)
    last = int(np.searchsorted(even, time[np.argmax(w)] + delay))
    place = 0
    while place < last:
        ahead = np.flatnonzero(force[place + 1:last + 1] >= force[place])
        after = place + 1 + int(ahead[0]) if len(ahead) else last
        lowest = place + int(np.argmin(force[place:after + 1]))
        drop = force[place] - force[lowest]
        if drop >= _MIN_FORCE_DROP * force[place] > 0 and (
                dissipated[lowest] - dissipated[place] >= _MIN_ENERGY_RATIO * drop * displacement[place] / 2):
            at = max(0.0, float(even[place]) - delay)
            return Threshold(float(force[place]), at, energy_transferred(history, at), corner)
        place = after
    return None


def energy_transferred(history: History, time: float) -> float:
    """Return the energy transferred from the impactor to the plate until a time."""
    return impact_energy(history) - history.at("energy_impactor", max(time, float(history.time[0])))


def energy_to_peak(history: History) -> float:
    """Return the energy transferred from the impactor to the plate until the peak force."""
    return energy_transferred(history, peak(history, "force").time)


def extent(fields: Fields) -> Extent | None:
    """Return the size of the projected (C-scan) damage at the last time; None without damage."""
    cells = fields.projected(len(fields.snapshots) - 1)
    if not len(cells):
        return None
    edges = outline(cells)
    points = np.unique(edges.reshape(-1, 2), axis=0)
    (diameter, direction, error), (length, width) = _widest(points, _grain(fields)), np.ptp(points, axis=0)
    middle = struck_point(fields)
    through = {angle: _between_outermost(edges - middle, math.radians(angle)) for angle in DIRECTIONS}
    return Extent(diameter, direction, error, float(length), float(width), through)


def _grain(fields: Fields) -> float:
    """Return the mean diagonal of the elements with damage at the last time; corners of a stair of elements protrude by
    half of it.
    """
    corners, shares = fields.snapshots[-1].projected()
    damaged = corners[shares.max(axis=1, initial=0) > 0]
    return float(np.mean(np.linalg.norm(damaged[:, 2] - damaged[:, 0], axis=-1)))


def _widest(points: np.ndarray, grain: float) -> tuple[float, float, float]:
    """Return the largest distance of two points, the middle of the directions, -90 < degrees <= 90, in which distances
    are smaller by less than `grain`, and half their range, up to 90.
    """
    from scipy.spatial import ConvexHull

    hull = points[ConvexHull(points).vertices]
    # Ends of diameters lie on the convex hull, here no further apart than an element.
    counts = np.ceil(np.linalg.norm(np.roll(hull, -1, axis=0) - hull, axis=1) / grain).astype(int)
    ends = np.concatenate([first + np.arange(count)[:, None] / count * (second - first) for first, second, count
                           in zip(hull, np.roll(hull, -1, axis=0), counts, strict=True)])
    distances = ends[:, None] - ends[None]
    lengths = np.hypot(*np.moveaxis(distances, -1, 0))
    x, y = distances[lengths >= lengths.max() - grain].T
    degrees = np.unique(np.degrees(np.arctan2(y, x)) % 180)
    # All are within the smallest range around the half circle: that which leaves out the widest gap.
    gaps = np.diff(degrees, append=degrees[0] + 180)
    first = degrees[(np.argmax(gaps) + 1) % len(degrees)]
    half = (180 - gaps.max()) / 2
    middle = (first + half) % 180
    return float(lengths.max()), float(middle - 180 if middle > 90 else middle), float(half)


def _between_outermost(edges: np.ndarray, angle: float) -> float:
    """Return the distance of the outermost intersections of edges with a line through the origin; 0 without any."""
    along, across = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
    heights, places = edges @ across, edges @ along
    met = (heights[:, 0] >= 0) != (heights[:, 1] >= 0)
    if not np.any(met):
        return 0.0
    (first, second), (from_, to) = heights[met].T, places[met].T
    crossings = from_ + first / (first - second) * (to - from_)
    return float(np.ptp(crossings))


def has_grown(entry: Mapping[str, Any]) -> bool:
    """Return whether the interface of an entry of a summary has delaminated, in the run or in the one before it."""
    return bool(entry["first_growth"] or entry.get("first_growth_before_run"))


def kinds_of_damage(summary: Mapping[str, Any]) -> list[str]:
    """Return the kinds of damage at the end of a run, each with its interfaces or plies."""
    kinds = []
    grown = [entry["ply_above"] for entry in summary.get("interfaces", []) if has_grown(entry)]
    if grown:
        kinds.append(f"delamination below {listed(grown)}")
    for name, key in (("matrix cracks", "matrix_crack_area"), ("matrix crushing", "matrix_crushing_area"),
                      ("fibre failure", "fibre_failure_area")):
        plies = [ply["ply"] for ply in summary["plies"] if ply.get(key, 0) > 0]
        if plies:
            kinds.append(f"{name} in {listed(plies)}")
    return kinds
