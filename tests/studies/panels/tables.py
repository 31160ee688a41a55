"""Tables of measured and computed values, and the page they are part of. Requires the standard library only."""

import re
from statistics import mean, stdev

LABELS = {"peak_force": "peak force, kN", "displacement": "largest displacement, mm",
          "contact_until": "end of contact, ms", "absorbed": "absorbed energy, J",
          "projected_area": "projected area, mm²", "dent": "dent, mm",
          "history_error": "force history, relative L2, %", "residual_strength": "strength after impact, MPa"}
ENOUGH = 10  # runs, from which a bound is held or not


def number(value, digits=3):
    """Return a number to some digits, without an exponent and without a zero before the point."""
    text = f"{float(f'{value:.{digits}g}'):.10g}"
    return re.sub(r"^(-?)0\.", r"\1.", text)


def values_of(rows, name, quantity):
    """Return the values of a quantity in the rows of a panel as its decks are."""
    return [float(row[quantity]) for row in rows if row["panel"] == name and not row["variant"] and row[quantity]]


def verdict(entry, values, error):
    """Return whether a mean is within its bound, or within two standard errors of it and one and a half bounds."""
    if "bound" not in entry:
        return "-"
    limit = entry["bound"] * (entry["value"] / 100 if entry["value"] else 1)
    off = abs(mean(values) - entry["value"])
    likely = error is not None and off <= min(1.5 * limit, limit + 2 * error)
    state = "within" if off <= limit or likely else "outside"
    return state if len(values) >= ENOUGH else f"{state}, {len(values)} of {ENOUGH} runs"


def measured_line(entry, values):
    """Return one line: measured with scatter, computed with standard error, difference, bound, others, earlier."""
    measured = number(entry["value"], 4) + (f" ± {number(entry['scatter'], 2)}" if "scatter" in entry else "")
    cells = [LABELS[entry["of"]], measured if entry["value"] else "-"]
    known = [entry.get("others", "-"), entry.get("earlier", "-")]
    if not values:
        return [*cells, "-", "-", "-", "-", *known]
    error = stdev(values) / len(values)**0.5 if len(values) > 1 else None
    computed = number(mean(values), 4) + (f" ± {number(error, 2)}" if error is not None else "")
    off = mean(values) - entry["value"]
    relative = f"{100 * off / entry['value']:+.0f} %" if entry["value"] else "-"
    together = ((error or 0)**2 + entry.get("scatter", 0)**2 / entry.get("tests", 1))**0.5
    in_errors = f"{off / together:+.1f}" if error and entry["value"] else "-"
    return [*cells, computed, relative, in_errors, verdict(entry, values, error), *known]


def markdown(head, lines):
    """Return a table."""
    return [f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *lines)]


def event_line(event, panel, rows):
    """Return the lowest energy of a ladder at which an event occurs: observed, and the mean of all draws."""
    seeds = sorted({row["seed"] for row in rows})
    firsts, never = [], 0
    for seed in seeds:
        at = sorted((float(row["energy"]), float(row[event["of"]])) for row in rows
                    if row["seed"] == seed and row[event["of"]])
        occurs = [energy for energy, value in at if value > event.get("above", 0) * 0.98]
        if occurs:
            firsts.append(occurs[0])
        elif len(at) == len(panel["energies"]):
            never += 1
    observed = f"{number(event['from'])} to {number(event['to'])}" if "to" in event else \
        f"not up to {number(event['from'])}" if "from" in event else "before the next"
    if not firsts:
        return [event["label"], observed, f"not up to {number(panel['energies'][-1])}" if never else "-", str(never)]
    error = f" ± {number(stdev(firsts) / len(firsts)**0.5, 2)}" if len(firsts) > 1 else ""
    also = f", never in {never}" if never else ""
    return [event["label"], observed, number(mean(firsts)) + error + also, str(len(firsts) + never)]


def panel_lines(name, panel, rows):
    """Return the table of a panel."""
    own = [row for row in rows if row["panel"] == name and not row["variant"]]
    if "events" in panel:
        lines = [event_line(event, panel, own) for event in panel["events"]]
        steps = ", ".join(number(energy) for energy in panel["energies"])
        return [*markdown(["lowest energy, J, of", "observed", "Implam", "draws"], lines), "",
                f"Steps of the ladder: {steps} J. {cost_of(own)}"]
    shown = [*panel["measured"], *({"of": quantity, "value": 0} for quantity in panel.get("shown", []))]
    lines = [measured_line(entry, values_of(own, name, entry["of"])) for entry in shown]
    head = ["", "measured", "Implam", "difference", "in standard errors", "bound", "others", "earlier decks"]
    return [*markdown(head, lines), "", cost_of(own)]


def cost_of(rows):
    """Return the number of runs, their cost and the versions of the program that made them."""
    if not rows:
        return "No run yet."
    hours = number(sum(float(row["minutes"]) for row in rows) / 60, 2)
    state = ", of the decks before their last change" if any("earlier" in row for row in rows) else ""
    versions = ", ".join(dict.fromkeys(row["version"].removesuffix("-modified") for row in rows))
    return f"Runs: {len(rows)}, {hours} hours of one core{state}, by {versions}."


def variant_lines(name, panel, rows):
    """Return the differences of the variants of a panel from the deck as it is, over pairs of equal seeds.

    The pairs are by one version of the program, where there are such."""
    rows = [row for row in rows if "earlier" not in row]
    base = {row["seed"]: row for row in rows if row["panel"] == name and not row["variant"]}
    quantities = [*(entry["of"] for entry in panel["measured"]), *panel.get("shown", [])]
    lines = []
    for variant in panel.get("variants", {}):
        own = [row for row in rows if row["panel"] == name and row["variant"] == variant and row["seed"] in base]
        cells = [variant, str(len(own))]
        pairs = [(row, row.get("base") or base[row["seed"]]) for row in own]
        for quantity in quantities:
            off = [float(row[quantity]) - float(other[quantity]) for row, other in pairs
                   if row[quantity] and other[quantity]]
            error = f" ± {number(stdev(off) / len(off)**0.5, 2)}" if len(off) > 1 else ""
            cells.append(f"{mean(off):+.3g}{error}" if off else "-")
        lines.append(cells)
    return markdown(["change", "pairs", *(LABELS[quantity] for quantity in quantities)], lines)


def page_of(template, panels, rows):
    """Return the page: <<table NAME>> and <<variants NAME>> are replaced, <<hours>> is the cost of all rows."""
    def filled(match):
        word, name = match[1], match[2].strip()
        if word == "hours":
            return number(sum(float(row["minutes"]) for row in rows) / 60, 2)
        return "\n".join((panel_lines if word == "table" else variant_lines)(name, panels[name], rows))
    return re.sub(r"<<(hours|table|variants)([^>]*)>>", filled, template)
