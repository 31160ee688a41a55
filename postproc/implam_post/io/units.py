"""Units of results: the system of units of a deck, and units for axes and tables."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

# Length, mass and time of the deck's units in SI.
SYSTEMS = {"SI": (1.0, 1.0, 1.0), "mm-t-s": (1e-3, 1e3, 1.0), "mm-kg-ms": (1e-3, 1.0, 1e-3),
           "mm-mN-kg-s": (1e-3, 1.0, 1.0)}
# Powers of length, mass and time in each dimension.
_POWERS = {"length": (1, 0, 0), "area": (2, 0, 0), "mass": (0, 1, 0), "time": (0, 0, 1), "velocity": (1, 0, -1),
           "force": (1, 1, -2), "energy": (2, 1, -2), "stress": (-1, 1, -2), "toughness": (0, 1, -2)}
# Names of units in each system.
_SYMBOLS = {
    "SI": {"length": "m", "area": "m2", "mass": "kg", "time": "s", "velocity": "m/s", "force": "N", "energy": "J",
           "stress": "Pa", "toughness": "J/m2"},
    "mm-t-s": {"length": "mm", "area": "mm2", "mass": "t", "time": "s", "velocity": "mm/s", "force": "N",
               "energy": "mJ", "stress": "MPa", "toughness": "kJ/m2"},
    "mm-kg-ms": {"length": "mm", "area": "mm2", "mass": "kg", "time": "ms", "velocity": "m/s", "force": "kN",
                 "energy": "J", "stress": "GPa", "toughness": "MJ/m2"},
    "mm-mN-kg-s": {"length": "mm", "area": "mm2", "mass": "kg", "time": "s", "velocity": "mm/s", "force": "mN",
                   "energy": "µJ", "stress": "kPa", "toughness": "J/m2"},
}
# Range of densities of solids, from foam to heavy metal, in each system.
_DENSITIES = {"SI": (100.0, 25000.0), "mm-kg-ms": (1e-7, 2.5e-5), "mm-t-s": (1e-10, 2.5e-8)}
# Units of axes, as factors to SI. The largest unit in which the largest value is at least 0.1 is used.
_UNITS = {"force": {"N": 1.0, "kN": 1e3}, "energy": {"mJ": 1e-3, "J": 1.0}, "area": {"mm²": 1e-6},
          "length": {"µm": 1e-6, "mm": 1e-3}, "time": {"µs": 1e-6, "ms": 1e-3}, "velocity": {"m/s": 1.0},
          "mass": {"g": 1e-3, "kg": 1.0}, "stress": {"MPa": 1e6, "GPa": 1e9}, "toughness": {"J/m²": 1.0}}
# Exceptions from 0.1: strengths are in MPa, moduli in GPa.
_FROM = {"GPa": 5.0}


@dataclass(frozen=True)
class Axis:
    """The factor for the values of a quantity on an axis, and the label of the axis."""

    factor: float
    label: str


def system_of(density: float | None) -> str:
    """Return the system of units in which a solid has this density; empty if it is none of those known."""
    for name, (low, high) in _DENSITIES.items():
        if density is not None and low <= density <= high:
            return name
    return ""


def axis_of(label: str, dimension: str, values: Iterable[float], system: str) -> Axis:
    """Return factor and label of an axis; the factor is 1 in an unknown system."""
    if dimension not in _UNITS:
        return Axis(1.0, label)
    if system not in SYSTEMS:
        return Axis(1.0, f"{label} (the deck's units)")
    to_si = _to_si(dimension, system)
    largest = to_si * max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    units = _UNITS[dimension]
    unit = next((name for name in reversed(units) if largest >= _FROM.get(name, 0.1) * units[name]), next(iter(units)))
    return Axis(to_si / units[unit], f"{label} [{unit}]")


def _to_si(dimension: str, system: str) -> float:
    """Return the factor from a system to SI."""
    return math.prod(unit**power for unit, power in zip(SYSTEMS[system], _POWERS[dimension], strict=True))


def unit_of(dimension: str, system: str) -> str:
    """Return the unit of a dimension in a system; empty if either is not known."""
    return _SYMBOLS.get(system, {}).get(dimension, "")
