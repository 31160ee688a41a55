"""Figures of a plate under compression, such as compression after impact, from its summary and its history."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from implam_post.io.errors import FileError
from implam_post.io.history import History
from implam_post.io.run import read_summary
from implam_post.io.summary_shape import ACROSS

STRENGTH, STRESS = "residual_strength", "far_field_stress"
# The plate has failed once the stress falls below this fraction of its maximum at a nominal strain above this one, as
# in the summary. Later maxima are ignored: the halves of a failed plate vibrate with a load above its strength.
_FAILED, _FAILED_BEYOND = 0.7, 1e-3


class Across(NamedTuple):
    """Failures across the width: plies above delaminated interfaces, plies with fibre failure."""

    interfaces: list[int]
    plies: list[int]


def row_of_strength(history: History) -> int:
    """Return the row of the largest stress up to the failure of the plate."""
    stress = history[STRESS]
    failed = (stress < _FAILED * np.maximum.accumulate(stress)) & (history["nominal_strain"] > _FAILED_BEYOND)
    return int(np.argmax(stress[:int(np.argmax(failed)) + 1] if np.any(failed) else stress))


def strength_of(path: Path) -> float:
    """Return the residual strength in the summary of another run."""
    summary = read_summary(path)
    if STRENGTH not in summary:
        raise FileError(f"{path} has no {STRENGTH}: no &line compresses that plate.")
    return float(summary[STRENGTH])


def failed_across_width(summary: Mapping[str, Any]) -> Across:
    """Return the interfaces and plies that failed across the width under the load."""
    collapse = summary.get("collapse", {})
    return Across([entry["ply_above"] for entry in collapse.get("interfaces", []) if entry[ACROSS]],
                  [entry["ply"] for entry in collapse.get("fibres", []) if entry[ACROSS]])
