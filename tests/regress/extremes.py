"""Extreme cases of extremes.toml against independent figures and bounds: each ends with its
result, or in one sentence with the exit code that the row gives.

usage: extremes.py IMPLAM FOLDER [--explicit] [NAME ...]    (rows whose names contain one of the words; without
words all)

With --explicit the transient rows without a front run by central differences, except those of more than 1e6 steps: for
these the check must give the number. Whatever a row expects, a completed run has finite numbers only and a ledger that
closes.
"""

import json
import math
import re
import resource
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "bench"))

from modal_impact import Model, response, condensed, patch_weight, section
from solver_runs import ENERGIES, TrialError, change_deck, exit_code_of, read_history, require

LONGEST_ROW = 60  # processor seconds, after which a run is ended
LEDGER = 1e-4  # of the largest energy
RECORDED = 1e-6  # relative error of an energy that is a toughness times an area
SAME = 1e-6  # relative difference of a run in other units
MAX_STEPS = 1e6  # of a run by central differences
LEDGER_EXPLICIT = 1e-2  # of the largest energy, by central differences


# Powers of mass, length and time in the units of keys, and of the columns that are compared.
DIMENSIONS = {"length": (0, 1, 0), "time": (0, 0, 1), "mass": (1, 0, 0), "mass/volume": (1, -3, 0),
              "length/time": (0, 1, -1), "length/time^2": (0, 1, -2), "pressure": (1, -1, -2),
              "pressure/length": (1, -2, -2), "energy": (1, 2, -2), "energy/area": (1, 0, -2),
              "force/length^1.5": (1, -0.5, -2)}
COLUMNS = {"force": (1, 1, -2), "deflection": (0, 1, 0), "delaminated_area": (0, 2, 0), "energy_strain": (1, 2, -2)}
# Units of mass, length and time in a kilogram, a metre and a second.
SYSTEMS = {"mm-t-s": (1e-3, 1e3, 1.0), "mm-kg-ms": (1.0, 1e3, 1e3), "mm-mN-kg-s": (1.0, 1e3, 1.0)}


def factor(dimension, system):
    """The factor that converts a value in SI to a system of units."""
    return math.prod(unit**power for unit, power in zip(SYSTEMS[system], dimension, strict=True))


def converted(implam, deck, system):
    """A deck in SI converted to another system of units, by the units of its keys that the program prints."""
    def multiplied(found):
        words = [f"{float(word) * factor(DIMENSIONS[unit], system):.12g}" for word in found[2].split(",")]
        return found[1] + ", ".join(words)

    def changed(group):
        nonlocal unit
        text = group[0]
        table = subprocess.run([implam, "explain", group[1], "--markdown"], stdout=subprocess.PIPE, text=True,
                               check=True).stdout
        for key, unit in re.findall(r"^\| `(\w+)` \|[^|]*\|[^|]*\| (\S+) \|", table, re.MULTILINE):
            if unit in DIMENSIONS:
                text = re.sub(rf"(\b{key} *= *)(\d[-+.\de]*(?: *, *[-+.\de]+)*)", multiplied, text)
        return text

    unit = ""
    return re.sub(r"^&(\w+)(?:'[^']*'|[^'/])*/", changed, deck, flags=re.MULTILINE)


class Row:
    """One run: its exit code, output, keys in effect, history and summary."""

    def __init__(self, implam, folder, deck, seconds=LONGEST_ROW):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        path = folder / "row.nml"
        path.write_text(deck, "utf-8")
        ended = subprocess.run([implam, path, "--output", folder], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, check=False,
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds)))
        self.code, self.said = ended.returncode, ended.stdout
        if self.code:
            return
        self.log = (folder / "row.log").read_text("utf-8")
        self.history = read_history(folder / "row_history.csv")
        self.summary = json.loads((folder / "row_summary.json").read_text("utf-8"))

    def key(self, group, name, default=None):
        """The value of a key as the log lists it, a number, a list of numbers or text."""
        found = re.search(rf"&{group} {name} = (.*?) \[", self.log)
        if not found:
            return default
        numbers = []
        try:
            for word in re.split("[ ,]+", found[1]):
                times, _, value = word.rpartition("*")
                numbers += int(times or 1) * [float(value)]
        except ValueError:
            return found[1].strip("'")
        return numbers if len(numbers) > 1 else numbers[0]

    def numbers(self, group, name):
        """The values of a key that may have several values."""
        value = self.key(group, name)
        return value if isinstance(value, list) else [value]

    def model(self):
        """The model for Navier's modes: plies of one material and thickness, or of several thicknesses."""
        angles = [int(angle) for angle in self.numbers("laminate", "angles")]
        thickness = self.numbers("laminate", "thicknesses")
        moduli = [self.key("material", name) for name in ("E1", "E2", "G12", "G13", "G23", "nu12")]
        if moduli[0] is None:
            young, poisson = self.key("material", "E"), self.key("material", "nu")
            moduli = [young, young] + 3 * [young / 2 / (1 + poisson)] + [poisson]
        law = self.key("indentation", "law", "hertz")
        return Model(tuple(self.numbers("plate", "length")), angles,
                     thickness[0] if len(set(thickness)) == 1 else thickness * (len(angles) // len(thickness)),
                     tuple(moduli), self.key("material", "density"), self.key("impactor", "mass", 1.0),
                     self.key("impactor", "velocity", 1.0), self.key("impactor", "radius", 1.0) or 1.0,
                     self.key("indentation", "k", 1.0), law)


def pressed_plate(model, pressure, shape):
    """Deflection at the centre of a simply supported plate under a pressure, by Navier's series of a Mindlin plate."""
    number = 1 if shape == "sine" else 201
    m, n = np.meshgrid(np.arange(1, number + 1, 2.0), np.arange(1, number + 1, 2.0), indexing="ij")
    load = pressure if shape == "sine" else 16 * pressure / (math.pi**2 * m * n)
    return float(np.sum(load * np.sin(m * math.pi / 2) * np.sin(n * math.pi / 2) / condensed(model, m, n)))


def stiffness_of_middle(model, patch):
    """Force over deflection of a simply supported plate loaded over a patch at its centre."""
    sizes = [int(6 * length / patch) + 40 for length in model.length]
    m, n = np.meshgrid(np.arange(1, sizes[0], 2.0), np.arange(1, sizes[1], 2.0), indexing="ij")
    return 1 / float(np.sum(patch_weight(model, patch, m, n) / condensed(model, m, n)))


def spring_peak(row, stiffness):
    """Largest force of a ball slowly in contact with a spring: all of its energy is stored."""
    k, energy = row.key("indentation", "k"), row.summary["energy_impact"]
    low, high = 0.0, k**0.4 * (2.5 * energy)**0.6
    for _ in range(200):
        force = (low + high) / 2
        stored = force**2 / 2 / stiffness + 0.4 * force**(5 / 3) / k**(2 / 3)
        low, high = (force, high) if stored < energy else (low, force)
    return force


def compare(what, found, expected, tolerance):
    """Print a relative difference; fail if it is too large."""
    error = found / expected - 1
    require(abs(error) <= tolerance, f"{what} is {found:.6g} and should be {expected:.6g} ({100 * error:+.3g} %)")
    return f"{what} {100 * error:+.2g} %"


def check_modes(row, tolerances):
    """Peak and history of the force against Navier's modes."""
    model = row.model()
    end = row.history["time"][-1]
    long = end > 300 * model.contact_time()
    times, forces, *_ = response(model, row.key("mesh", "patch"), end, *((20, 20) if long else (60, 50)))
    mine = np.interp(times, [0.0, *row.history["time"]], [0.0, *row.history["force"]])
    history = math.sqrt(np.sum((mine - forces)**2) / np.sum(forces**2))
    printed = compare("peak", max(row.history["force"]), forces.max(), tolerances[0])
    require(history <= tolerances[1], f"the history of the force is {100 * history:.3g} % off")
    return f"{printed}, history {100 * history:.2g} %"


def check_pressed(row, tolerance):
    """Deflection of a simply supported plate under pressure."""
    expected = pressed_plate(row.model(), row.key("pressure", "value"), row.key("pressure", "distribution"))
    return compare("deflection", row.history["deflection"][-1], expected, tolerance)


def check_weakened(row, bounds):
    """Deflection of a simply supported plate of failed plies under pressure, over that of the undamaged one."""
    expected = pressed_plate(row.model(), row.key("pressure", "value"), row.key("pressure", "distribution"))
    found = row.history["deflection"][-1] / expected
    require(bounds[0] <= found <= bounds[1], f"the deflection is {found:.6g} times that without damage")
    return f"deflection {found:.4g} times as large"


def check_clamped(row, tolerance):
    """Deflection of a clamped, isotropic, thin plate under pressure: 1.26532e-3 q a**4/D (Taylor and Govindjee
    2004)."""
    model = row.model()
    expected = 1.26532e-3 * row.key("pressure", "value") * model.length[0]**4 / section(model)[0][0]
    return compare("deflection", row.history["deflection"][-1], expected, tolerance)


def check_strip(row, tolerance):
    """Deflection of a strip on two simple supports with free sides: a beam under its load, with shear."""
    model = row.model()
    (d11, d12, d22, _), (shear, _), *_ = section(model)
    load, length = row.key("pressure", "value"), model.length[0]
    expected = 5 / 384 * load * length**4 / (d11 - d12**2 / d22) + load * length**2 / 8 / shear
    return compare("deflection", row.history["deflection"][-1], expected, tolerance)


def check_spring(row, tolerance):
    """Peak force of a heavy ball: the plate acts as a spring."""
    peak = spring_peak(row, stiffness_of_middle(row.model(), row.key("mesh", "patch")))
    return compare("peak", max(row.history["force"]), peak, tolerance)


def check_hertz(row, tolerance):
    """Peak force on a rigid plate: k**0.4 (1.25 m v**2)**0.6."""
    peak = row.key("indentation", "k")**0.4 * (2.5 * row.summary["energy_impact"])**0.6
    return compare("peak", max(row.history["force"]), peak, tolerance)


def check_first(row, tolerance):
    """Force before the plate deflects: k (v t)**1.5."""
    last = row.history["time"][-1]
    expected = row.key("indentation", "k") * (row.key("impactor", "velocity") * last)**1.5
    return compare("force", row.history["force"][-1], expected, tolerance)


def check_fracture(row, starter):
    """Fracture energy: toughness times the delaminated area beyond the starter."""
    expected = row.key("delamination", "G_c") * (row.history["delaminated_area"][-1] - starter)
    return compare("energy of fracture", row.history["energy_delamination"][-1], expected, RECORDED)


def check_within(row, bounds):
    """Largest values of columns within bounds."""
    printed = []
    for name, (low, high) in bounds.items():
        found = max(row.history[name])
        require(low <= found <= high, f"the largest {name} is {found:.6g}, not within {low:g} to {high:g}")
        printed.append(f"{name} {found:.4g}")
    return ", ".join(printed)


def check_warns(row, sentence):
    """A warning that must be printed."""
    require(re.search(f"warning.*{sentence}", row.said), f"nothing warns of '{sentence}'")
    return f"warns: {sentence}"


CHECKS = {"modes": check_modes, "pressed": check_pressed, "weakened": check_weakened, "clamped": check_clamped,
          "strip": check_strip, "spring": check_spring, "hertz": check_hertz, "first": check_first,
          "fracture": check_fracture, "within": check_within, "warns": check_warns}


def check_ledger(row, tolerance=LEDGER):
    """The energies balance."""
    largest = max(max(map(abs, row.history[name])) for name in ENERGIES)
    missing = max(map(abs, row.history["energy_error"]))
    require(missing <= tolerance * largest, f"the energy error is {missing:.3g} of {largest:.3g}")


def check_row(entry, row):
    """Compare a run with the expectations of its row; return the figures."""
    if "exit" in entry:
        require(row.code == entry["exit"], f"exit code {row.code}, not {entry['exit']}: {row.said[-300:]}")
        printed = [line for line in row.said.splitlines() if re.search(entry["says"], line)]
        require(len(printed) == 1, f"'{entry['says']}' is printed {len(printed)} times: {row.said[-300:]}")
        return printed[0][:120]
    require(row.code == 0, f"exit code {row.code}: {row.said[-300:]}")
    check_ledger(row, LEDGER_EXPLICIT if row.key("time", "integrator") == "central_difference" else LEDGER)
    checks = [name for name in CHECKS if name in entry]
    require(checks, "nothing is checked")
    return ", ".join(CHECKS[name](row, entry[name]) for name in checks)


def explicit(deck):
    """A transient deck changed to central differences, without keys of implicit steps; None for other decks."""
    if ("&time" not in deck and "&impactor" not in deck) or "&static" in deck or "starter" in deck:
        return None
    deck = re.sub(r"\b(step|rho_inf|integrator)=('\w+'|\S+)", "", deck)
    deck = re.sub(r"^&adapt[^/]*/\n", "", deck, flags=re.MULTILINE)
    if "&time" not in deck:
        deck += "&time /\n"
    return deck.replace("&time ", "&time integrator='central_difference' ")


def run_explicit(implam, folder, entry, deck):
    """Run a row by central differences and check what does not depend on the integrator."""
    check = subprocess.run([implam, "check", "/dev/stdin"], input=deck, text=True, capture_output=True, check=False)
    said = check.stdout + check.stderr
    steps = re.search(r"About ([\d.e+]+) steps?", said)
    if check.returncode:
        require(check.returncode == 2, f"exit code {check.returncode}: {said[-300:]}")
        return "refused: " + said.strip()[:160]
    require(steps, f"the check gives no number of steps: {said[-300:]}")
    if float(steps[1]) > MAX_STEPS:
        return f"{steps[0]}, not run"
    row = Row(implam, folder, deck, 600)
    if row.code:
        printed = [line for line in row.said.splitlines() if line.startswith("implam: ")]
        require(row.code == 3 and len(printed) == 1, f"exit code {row.code}: {row.said[-300:]}")
        return f"exit code 3: {printed[0][:160]}"
    check_ledger(row, LEDGER_EXPLICIT)
    printed = [CHECKS[name](row, entry[name]) for name in CHECKS if name in entry and name != "warns"]
    return ", ".join([steps[0], *printed])


def check_units(implam, folder, deck, system, row):
    """The run in another system of units against the one in SI."""
    other = Row(implam, folder / system, converted(implam, deck, system))
    require(other.code == 0, f"exit code {other.code} in {system}: {other.said[-300:]}")
    require("it is probably in" not in other.said, f"a value in {system} looks odd: {other.said[-300:]}")
    for name, dimension in COLUMNS.items():
        if name in row.history:
            mine = max(map(abs, row.history[name])) * factor(dimension, system)
            if mine > 0:
                compare(f"{name} in {system}", max(map(abs, other.history[name])), mine, SAME)
    return system


def processor_seconds():
    """Processor time of this process and the runs it has ended."""
    return sum(usage.ru_utime + usage.ru_stime
               for usage in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def main(implam, folder, *words):
    """Run the rows and print a line for each."""
    table = tomllib.loads((HERE / "extremes.toml").read_text("utf-8"))
    failures, begun, rows = [], processor_seconds(), 0
    by_explicit = "--explicit" in words
    words = [word for word in words if word != "--explicit"]
    for number, entry in enumerate(table["row"], 1):
        if words and not any(word in entry["name"] for word in words):
            continue
        deck = change_deck(table["model"][entry["model"]], entry.get("set", []))
        deck = explicit(deck) if by_explicit else deck
        if deck is None:
            continue
        rows += 1
        since = processor_seconds()
        here = Path(folder) / str(number)
        try:
            if by_explicit:
                print(f"{entry['name']:44s} {run_explicit(implam, here, entry, deck)}", flush=True)
                continue
            row = Row(implam, here, deck)
            printed = [check_row(entry, row)]
            printed += [check_units(implam, here, deck, system, row) for system in entry.get("units", [])]
            found = ", ".join(printed)
        except TrialError as failure:
            failures.append(entry["name"])
            found = f"FAILS: {failure}"
        print(f"{entry['name']:44s} {processor_seconds() - since:5.1f} s  {found}", flush=True)
    print(f"{rows - len(failures)} of {rows} rows hold, {processor_seconds() - begun:.0f} s of processor time")
    require(not failures, f"Failed rows: {', '.join(failures)}.")


if __name__ == "__main__":
    sys.exit(exit_code_of(main, *sys.argv[1:]))
