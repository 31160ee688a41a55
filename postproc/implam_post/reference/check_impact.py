"""Check an impact against the semi-analytic solution (`implam-check-impact DECK`)."""

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from implam_post.io.deck import Deck, read_deck
from implam_post.io.errors import EXIT_DONE, EXIT_USAGE, CommandParser, count, finite, run
from implam_post.io.history import History, read_history
from implam_post.io.quantities import QUANTITIES, contact, peak, rms_force_difference
from implam_post.reference.semi_analytic import semi_analytic

_COMPARED = {"peak_force": "peak force", "peak_force_time": "time of peak force",
             "contact_begin": "contact begins", "contact_release": "contact ends",
             "second_contact_begin": "second contact begins", "second_contact_release": "second contact ends",
             "second_peak_force": "second peak force", "second_peak_force_time": "time of second peak force",
             "max_deflection": "largest centre deflection", "max_deflection_time": "time of largest deflection",
             "rebound_velocity": "rebound velocity"}


class Difference(NamedTuple):
    """One quantity of both histories; its relative difference refers to `scale`."""

    label: str
    found: float
    expected: float
    relative: float


def differences(history: History, reference: History) -> list[Difference]:
    """Return the differences of the quantities that at least one of the histories has.

    Scales are the peak force for forces, the duration of the first contact for times, the largest deflection, and the
    velocity at first contact. The difference is NaN if one history does not have the quantity.
    """
    first = contact(reference, 0)
    end = first.end if math.isfinite(first.end) else reference.time[-1]
    force = peak(reference, "force").value
    scales = {"peak_force": force, "second_peak_force": force, "max_deflection": peak(reference, "deflection").value,
              "rebound_velocity": abs(reference["impactor_velocity"][0])}
    found = []
    for name, label in _COMPARED.items():
        one, other = QUANTITIES[name](history), QUANTITIES[name](reference)
        if not (math.isnan(one) and math.isnan(other)) or name in ("peak_force", "max_deflection"):
            scale = scales.get(name, end - first.begin)
            found.append(Difference(label, one, other, (one - other) / scale if scale else math.nan))
    rms = rms_force_difference(history, reference)
    return [*found, Difference("rms force, first contact", rms, 0.0, rms)]


def differences_table(rows: Sequence[Difference]) -> str:
    """Return the differences as lines of text."""
    lines = [f"{'quantity':<26} {'history':>13} {'semi-analytic':>13} {'difference':>13} {'% of scale':>11}"]
    lines += [f"{row.label:<26} {row.found:13.6g} {row.expected:13.6g} {row.found - row.expected:13.6g} "
              f"{100 * row.relative:11.3f}" for row in rows]
    return "\n".join(lines)


def reference_table(reference: History) -> str:
    """Return the figures of the semi-analytic solution as lines of text."""
    return "\n".join(f"{label:<26} {value:13.6g}" for name, label in _COMPARED.items()
                     if math.isfinite(value := QUANTITIES[name](reference)))


def find_history(deck: Deck, output: Path | None) -> Path | None:
    """Return the history in `output`, in the deck's output folder (from here or the deck) or in the current folder."""
    folders = [deck.directory, deck.path.parent / deck.directory, Path()]
    candidates = [folder / f"{deck.name}_history.csv" for folder in ([output] if output else []) + folders]
    return next((path for path in candidates if path.is_file()), None)


def notes(deck: Deck) -> list[str]:
    """Return notes on parts of the deck that the semi-analytic solution does not model."""
    found = []
    if deck.choice("case", "kinematics", ("von_karman", "linear")) != "linear":
        found.append("the deck requires von Karman strains; the semi-analytic plate is linear.")
    if deck.choice("impactor", "contact_area", ("patch", "sphere")) == "sphere":
        found.append("contact in the deck is that of a sphere; the semi-analytic solution loads the patch only.")
    found += [f"the deck models &{group}; the semi-analytic plate is undamaged."
              for group in ("ply_damage", "delamination") if deck.has(group)]
    return found


def _command(options: argparse.Namespace) -> int:
    """Solve, compare, print and plot."""
    deck = read_deck(options.deck)
    reference = semi_analytic(deck, options.modes)
    for note in notes(deck):
        print(f"note: {note}")
    path = options.history or find_history(deck, options.output)
    history = None if path is None else read_history(path)
    if not options.no_plot:
        from implam_post.plot.pictures import plot_forces
        folder = options.output or (path.parent if path else Path())
        print(f"plot: {plot_forces([reference, *([history] if history else [])], folder / f'{deck.name}_check.png')}")
    if history is None:
        print(f"no {deck.name}_history.csv was found: semi-analytic solution only\n{reference_table(reference)}")
        return EXIT_DONE
    rows = differences(history, reference.until(history.time[-1]))
    print(f"history: {path}\n{differences_table(rows)}")
    within = options.tolerance is None or all(abs(row.relative) <= options.tolerance for row in rows)
    return EXIT_DONE if within else EXIT_USAGE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-check-impact", description="Check the impact on a simply supported, specially "
                           "orthotropic plate against its semi-analytic solution.")
    parser.add_argument("deck", type=Path, metavar="DECK", help="the namelist deck")
    parser.add_argument("--history", type=Path, metavar="CSV",
                        help="history to check (default: NAME_history.csv in the output folder or the current one)")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder of the plot (default: that of the history)")
    parser.add_argument("--modes", type=count, metavar="N",
                        help="number of odd half-wave numbers with inertia along each side (default: up to two half "
                        "waves per patch)")
    parser.add_argument("--no-plot", action="store_true", help="print only, without a plot")
    parser.add_argument("--tolerance", type=finite, metavar="FRACTION",
                        help="exit code 1 if a difference exceeds this fraction of its scale")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
