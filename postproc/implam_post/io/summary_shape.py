"""The kind of each member of a summary, which is checked when the file is read.

A kind is a type, a mapping of members, a list [kind], a pair (kind, length) for a list of that length, or
OrNull(kind)."""

import math
from collections.abc import Mapping
from typing import Any

from implam_post.io.results import TABLES


class OrNull:
    """A member that may be null, such as a figure that a run does not have."""

    def __init__(self, kind: object) -> None:
        """Store the kind of values other than null."""
        self.kind = kind


_FIGURE = OrNull(float)
_EVENT = OrNull({"at": float})
_INTERFACE = {"ply_above": int, "is_cohesive": bool, "area": float, "energy": float, "x": (float, 2), "y": (float, 2),
              "onset": _EVENT, "first_growth": _EVENT, "threshold_force": _FIGURE, "border_reached": bool}
_REQUIRED = {
    "case": str, "title": str, "exit": {"kind": str, "message": str}, "accepted_steps": int, "plate_size": (float, 2),
    "plies": [{"ply": int, "angle": float, "thickness": float}], "warnings": [{"text": str}], "costs": {},
    "provenance": dict.fromkeys(("version", "commit", "compiler", "petsc_version", "deck"), str)
    | {"ranks": object, "started": object}}
# Members that functions of this package compute with, so that they are never null.
_NEVER_NULL = ("energy_kinetic", "energy_strain", "energy_indentation", "energy_delamination", "energy_ply_damage",
               "energy_contact", "energy_friction", "residual_strength", "residual_strength_at",
               "shortening_at_strength", "failure_load", "skin_stress_at_strength", "percent_bending")
_KINDS = {"real": OrNull(float), "integer": OrNull(int), "logical": bool}
ACROSS = "failed_across_width"
_ACROSS_BEFORE = "went_across"  # the name in summaries of version 0.1.0
_COLLAPSE = {"interfaces": [{"ply_above": int, ACROSS: bool}], "fibres": [{"ply": int, ACROSS: bool}]}
_POSSIBLE = {name: _KINDS[result.type] for name, result in TABLES["summary"].items()} | dict.fromkeys(
    _NEVER_NULL, float) | {
    "failure_code": OrNull(str), "collapse": _COLLAPSE, "interfaces": [_INTERFACE],
    "force_filter": {"frequency": float, "peak_force": float}}
_POSSIBLE_OF_PLIES = dict.fromkeys(("fibre_failure_area", "matrix_crack_area", "matrix_crushing_area"), float) | \
    dict.fromkeys(("stressed_volume", "fibre_strength"), OrNull(float))


def missing_member(summary: Mapping[str, Any]) -> str:
    """Return a required member that is missing; empty if none is."""
    for name in _REQUIRED:
        if name not in summary:
            return name
    ends = {"time_reached", "load_factor_reached"}
    return "" if ends & summary.keys() else "time_reached"


def take_earlier_names(summary: Mapping[str, Any]) -> None:
    """Rename members of earlier versions to their present names."""
    collapse = summary.get("collapse")
    for entries in collapse.values() if isinstance(collapse, dict) else ():
        for entry in entries if isinstance(entries, list) else ():
            if isinstance(entry, dict) and _ACROSS_BEFORE in entry:
                entry[ACROSS] = entry.pop(_ACROSS_BEFORE)


def misshapen_member(summary: Mapping[str, Any]) -> str:
    """Return a member of the wrong kind; empty if there is none."""
    for name, kind in (_POSSIBLE | _REQUIRED).items():
        if name in summary and (wrong := misshapen(summary[name], kind, name)):
            return wrong
    if not summary.get("plies", [1]):
        return "plies"
    first = summary.get("plies", [{}])[0]
    for place, ply in enumerate(summary.get("plies", [])):
        for name, kind in _POSSIBLE_OF_PLIES.items():
            if (name in ply) != (name in first) or (name in ply and misshapen(ply[name], kind, name)):
                return f"plies[{place}].{name}"
    return ""


def misshapen(value: object, kind: Any, where: str) -> str:
    """Return the member that is not of its kind; empty if there is none. Numbers must be finite and not logicals."""
    if isinstance(kind, OrNull):
        return "" if value is None else misshapen(value, kind.kind, where)
    if isinstance(kind, dict):
        if not isinstance(value, dict):
            return where
        return next((wrong for name, inner in kind.items()
                     if (wrong := misshapen(value[name], inner, f"{where}.{name}")
                         if name in value else f"{where}.{name}")), "")
    if isinstance(kind, (list, tuple)):
        if not isinstance(value, list) or (isinstance(kind, tuple) and len(value) != kind[1]):
            return where
        return next((wrong for place, entry in enumerate(value)
                     if (wrong := misshapen(entry, kind[0], f"{where}[{place}]"))), "")
    if kind in (int, float):
        is_number = isinstance(value, (int, kind)) and not isinstance(value, bool) and math.isfinite(value)
        return "" if is_number else where
    return "" if isinstance(value, kind) else where
