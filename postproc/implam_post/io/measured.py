"""Measured curves beside results: whether they are in the units of the run."""

import numpy as np

from implam_post.io.errors import FileError
from implam_post.io.history import History

# Units of a quantity differ by 1000. Largest values of a run and a measurement that differ less than tenfold are then
# more than 100 apart in other units.
_APART = 100.0


def check_units(history: History, curve: History) -> None:
    """Refuse a curve whose columns have other units than those of a history."""
    for name in [column for column in curve.columns if column in history.columns]:
        measured, own = (float(np.max(np.abs(values), initial=0)) for values in (curve[name], history[name]))
        if own > 0 and measured > 0 and not own / _APART < measured < _APART * own:
            raise FileError(f"{curve.name}: {name} reaches {measured:.3g}, where the run reaches {own:.3g}: give the "
                            "curve in the units of the run, such as s and N instead of ms and kN.")
