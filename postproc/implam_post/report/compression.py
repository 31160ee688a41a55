"""The section on compressive strength in the page of a run."""

from collections.abc import Sequence

from implam_post.io.compression import failed_across_width
from implam_post.io.run import Run
from implam_post.plot.style import PictureStyle

# Rows: label, member, dimension.
_ROWS = (("shortening at the strength", "shortening_at_strength", "length"),
         ("effective modulus", "effective_modulus", "stress"))


def compression_rows(run: Run, style: PictureStyle, undamaged: float | None = None) -> list[tuple[str, str, str]]:
    """Return the rows of the section; `undamaged` is the strength of the undamaged plate, if known."""
    summary = run.summary
    if "residual_strength" not in summary:
        return []
    remark = "" if summary["has_failed"] else "a lower bound: the plate has not failed"
    rows = [("residual strength", style.shown("stress", summary["residual_strength"], 4), remark)]
    if undamaged:
        rows.append(("retained fraction of the undamaged strength", f"{summary['residual_strength'] / undamaged:.3f}",
                     f"of {style.shown('stress', undamaged, 4)}"))
    if "failure_load" in summary:
        rows += [("failure load", style.shown("force", summary["failure_load"], 4),
                  "of laminate, doublers and stringers"),
                 ("stress of the laminate at the strength",
                  style.shown("stress", summary["skin_stress_at_strength"], 4),
                  "by its share in the axial stiffness of the section")]
    for label, key, dimension in _ROWS:
        value = summary.get(key)
        rows.append((label, "-" if value is None else style.shown(dimension, value, 4), ""))
    if "percent_bending" in summary:
        strain = summary["buckling_strain"]
        rows += [("percent bending at the strength", f"{summary['percent_bending']:.3g} %", "back-to-back gauges"),
                 ("nominal strain of first buckling", "none" if strain is None else f"{1e6 * strain:.4g}e-6", "")]
    if "kinetic_share" in summary:
        rows.append(("largest kinetic energy over the work of the load", f"{100 * summary['kinetic_share']:.2g} %",
                     "from a quarter of the loading to the strength"))
    return rows + _collapse(run)


def _collapse(run: Run) -> list[tuple[str, str, str]]:
    """Return the rows on the failure of the plate."""
    if not run.summary["has_failed"] or "collapse" not in run.summary:
        return []
    across = failed_across_width(run.summary)
    return [("failure code of ASTM D7137", run.summary["failure_code"] or "not known", ""),
            ("interfaces delaminated across the width", _listed(across.interfaces), "below these plies"),
            ("plies with fibre failure across the width", _listed(across.plies), "")]


def _listed(numbers: Sequence[int]) -> str:
    """Return numbers separated by commas; a dash for none."""
    return ", ".join(map(str, numbers)) or "none"
