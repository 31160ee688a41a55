"""Equal histories of a deck run in two ways.
Usage: same_history.py ranks IMPLAM DECK FOLDER TOLERANCE LAUNCHER... [-- SETTING...]
       same_history.py all_ranks IMPLAM DECK FOLDER TOLERANCE LAUNCHER... [-- SETTING...]
       same_history.py PART IMPLAM DECK FOLDER TOLERANCE [-- SETTING...]
       same_history.py mirror IMPLAM DECK FOLDER TOLERANCE [-- SETTING...]
       same_history.py tolerances IMPLAM DECK FOLDER TOLERANCE [-- SETTING...]

ranks    on 1 and 2 ranks, and from the checkpoint of 2 ranks on 3
all_ranks  on 1 and 3 ranks, and from a checkpoint of each on 4 and 2
quarter  a quarter of the plate against the full one
half_x   a half along x against the full plate
half_y   a half along y against the full plate
point    the half of point symmetry against the full plate
mirror   against the plate with x and y exchanged
tolerances  residuals of 1e-9 against .8e-9 and 2e-9, with other numbers of iterations and updates of operators

LAUNCHER takes the number of ranks as its last word. The full plate has twice the elements along the directions halved.
Where an interface delaminates or plies fail, damage must grow, and the same cells and plies must have failed at the
end.
"""

import re
import shutil
import sys
from pathlib import Path

from released_cells import damage_of, folded, mirrored
from solver_runs import (
    DECKS,
    change_deck,
    checkpoint_of,
    exit_code_of,
    history_of,
    largest_difference,
    read_history,
    require,
    run,
    run_deck,
    write_deck,
)

# Columns of how the solution was found and its accuracy, not of the solution; the stress is a measure for the step
# only.
COUNTS = ("iterations", "force_iterations", "contact_iterations", "total_iterations", "total_force_iterations",
          "total_contact_iterations", "refactorisations", "solves", "complementarity")
PARTS = ("quarter", "half_x", "half_y", "point")
# Numbers of ranks, and those before and after the restarts. Ranks beyond the cores take
# turns, and most of the time: they have the last part of a run.
RANKS = {"ranks": ((1, 2), ((2, 3),)), "all_ranks": ((1, 3), ((1, 4), (3, 2)))}


def within(deck, settings):
    """Settings that leave one checkpoint within the run, at 70 % of its time or load."""
    found = re.search(r"^&time\b.*?\bend=(\S+)", change_deck((DECKS / deck).read_text("utf-8"), settings), re.MULTILINE)
    return [*settings, f"output%checkpoint_every={0.7 * float(found[1] if found else 1)!r}"]


def histories_of_ranks(kind, implam, deck, folder, launcher, settings):
    """Yield name and history of the runs on several numbers of ranks, and of those continued on others."""
    settings = within(deck, settings)
    numbers, changes = RANKS[kind]
    for ranks in numbers:
        path = write_deck(folder / f"ranks_{ranks}", deck, settings)
        history = run_deck(implam, path, [*launcher, str(ranks)])
        log = next(path.parent.glob("*.log")).read_text(encoding="utf-8")
        require(f"{ranks} rank" in log, f"The log does not name {ranks} ranks.")
        yield f"{ranks} ranks", read_history(history), damage_of(history)
    for first, second in changes:
        again = folder / f"ranks_{first}_{second}"
        shutil.rmtree(again, ignore_errors=True)
        shutil.copytree(folder / f"ranks_{first}", again)
        said = run([*launcher, str(second), implam, "restart", checkpoint_of(again)])
        require(f"{second} rank" in said, f"The restart is not on {second} ranks.")
        history = history_of(again)
        yield f"from {first} to {second} ranks", read_history(history), damage_of(history)


def histories_of_part(part, implam, deck, folder, settings):
    """Yield name and history of a part and of the full plate."""
    modelled = write_deck(folder / part, deck, [*settings, f"plate%symmetry='{part}'"])
    history = run_deck(implam, modelled)
    yield part, read_history(history), damage_of(history)
    elements = re.search(r"elements=(\d+), *(\d+)", modelled.read_text(encoding="utf-8"))
    factors = (1 if part == "half_y" else 2, 2 if part in ("quarter", "half_y") else 1)
    doubled = f"mesh%elements={factors[0] * int(elements[1])},{factors[1] * int(elements[2])}"
    whole = write_deck(folder / "whole", deck, [*settings, "plate%symmetry='none'", doubled])
    history = run_deck(implam, whole)
    yield "whole", read_history(history), folded(damage_of(history), part)


def exchange_axes(text):
    """Return a deck with x and y exchanged: pairs swapped and a fibre angle replaced by 90 degrees less it."""
    pairs = r"\b(length|elements|core|zone)=([^\s,]+), *([^\s,]+)"
    text = re.sub(pairs, r"\1=\3, \2", text)
    text = re.sub(r"\bedges=('\w+'), *('\w+'), *('\w+'), *('\w+')", r"edges=\3, \4, \1, \2", text)
    return re.sub(r"(?<=\bangles=).*?(?=\s+\w+\s*=|\s*/)", lambda angles: re.sub(
        r"(\d+\*)?([-+.\d]+)", lambda ply: f"{ply[1] or ''}{90 - float(ply[2])!r}", angles[0]), text)


def histories_of_mirror(implam, deck, folder, _, settings):
    """Yield name, history and damage of the plate and of its mirror image, whose damage is mirrored again."""
    plate = write_deck(folder / "plate", deck, settings)
    history = run_deck(implam, plate)
    yield "plate", read_history(history), damage_of(history)
    image = write_deck(folder / "image", deck, settings)
    image.write_text(exchange_axes(plate.read_text(encoding="utf-8")), encoding="utf-8")
    history = run_deck(implam, image)
    rows = read_history(history)
    for name in [name for name in rows if name.startswith("extent_x_")]:
        other = name.replace("extent_x_", "extent_y_")
        rows[name], rows[other] = rows[other], rows[name]
    yield "mirror image", rows, mirrored(damage_of(history))


def histories_of_tolerances(implam, deck, folder, _, settings):
    """Yield name and history with several tolerances of equilibrium."""
    for tolerance in ("1e-9", "0.8e-9", "2e-9"):
        history = run_deck(implam, write_deck(folder / tolerance, deck, [*settings, f"solver%tolerance={tolerance}"]))
        yield f"residuals of {tolerance}", read_history(history), damage_of(history)


def compare(kind, implam, deck, folder, tolerance, *words):
    """Run and compare."""
    left_out = (*COUNTS, "stress") if kind in PARTS else COUNTS
    divide = words.index("--") if "--" in words else len(words)
    launcher, settings = words[:divide], words[divide + 1:]
    if kind in PARTS:
        runs = histories_of_part(kind, implam, deck, Path(folder), settings)
    elif kind in RANKS:
        runs = histories_of_ranks(kind, implam, deck, Path(folder), launcher, settings)
    else:
        histories = {"mirror": histories_of_mirror, "tolerances": histories_of_tolerances}[kind]
        runs = histories(implam, deck, Path(folder), launcher, settings)
    passed = True
    _, reference, reference_damage = next(runs)
    area = reference["delaminated_area"]
    require(area[0] == 0 or area[-1] > area[0], "Nothing grew: the trial is void.")
    require(bool(reference_damage) >= (area[-1] > 0), "The fields do not show the delamination.")
    for name, history, damage in runs:
        difference, column = largest_difference(history, reference, left_out)
        within = difference <= float(tolerance) and damage == reference_damage
        print(f"{name}: {len(history['time'])} rows, largest difference {difference:.2e} ({column}), "
              f"{len(damage)} delaminated or failed cells, {len(damage.items() ^ reference_damage.items())} other, "
              f"{'pass' if within else 'FAIL'}", flush=True)
        passed &= within
    require(passed, "The histories differ.")


if __name__ == "__main__":
    raise SystemExit(exit_code_of(compare, *sys.argv[1:]))
