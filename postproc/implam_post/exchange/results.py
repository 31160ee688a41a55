"""Read panels from results (NAME.h5, which holds the deck) and from decks."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from implam_post.exchange.degradation import degradation_of
from implam_post.exchange.panel import Cell, Panel, Stack
from implam_post.exchange.starters import starters_of
from implam_post.exchange.stringers import Stringer, stringers_of
from implam_post.io.deck import Deck, read_deck, recorded_deck
from implam_post.io.errors import FileError, ImplamError
from implam_post.io.fields import IMAGES, Snapshot, opened, read_fields
from implam_post.io.shapes import curvatures_of
from implam_post.laminate.decks import plies_of
from implam_post.laminate.sections import Ply, natural_shear_correction
from implam_post.laminate.zones import LayUp, Zones, with_lines, zones_of

_STATES = {"ply_damage": "ply_1_failure", "delamination": "delaminated_above"}
# Groups with supports or loads that are not exported.
_UNWRITTEN = ("support", "line")
_STATE = "&initial_state is not written: export the results of the run, NAME.h5, which have its damage"
_BY_OTHERS = "the shear correction of &laminate is not written: each program has its own"


def read_panel(path: Path, time: float | None = None) -> Panel:
    """Return the panel of a NAME.h5 at the time nearest to `time` (None: the last), or the initial one of a deck."""
    if path.suffix.lower() == ".h5":
        return _from_results(path, time)
    if time is not None:
        raise ImplamError("--time needs a NAME.h5.")
    return _from_deck(read_deck(path))


def _from_results(path: Path, time: float | None) -> Panel:
    """Return the panel in the cells of the run, mirrored if the run used symmetry."""
    fields = read_fields(path)
    snapshot = fields.snapshots[-1 if time is None else fields.place(time)]
    with opened(path) as file:
        deck = recorded_deck(file["provenance"], path)
        written = set(file["times"][min(file["times"])].get("cells", {}))
    for group, field in _STATES.items():
        if deck.has(group) and field not in written:
            raise FileError(f"{path} does not hold the state of &{group}: run again with '{group}' among the fields of "
                            f"&output.")
    plies = plies_of(deck)
    if snapshot.mesh.last_ply.max() != len(plies):
        raise FileError(f"{path} is damaged: it has {snapshot.mesh.last_ply.max()} plies, but its deck {len(plies)}.")
    x, y = (_lines(snapshot.mesh.corners[..., axis]) for axis in (0, 1))
    zones = zones_of(deck, plies)
    stacks = _stacks(snapshot, x, y, zones)
    x, y, stacks = _completed(x, y, stacks, fields.part)
    every_cell = {(column, row) for column in range(len(x) - 1) for row in range(len(y) - 1)}
    if stacks.keys() != every_cell or not all(_is_complete(found, len(plies)) for found in stacks.values()):
        raise FileError(f"{path} is damaged: its cells do not form a plate of {len(plies)} plies.")
    return _panel(deck, zones, x, y, stacks)


def _is_complete(stacks: tuple[Stack, ...], plies: int) -> bool:
    """Return whether stacks have every ply once, from the struck face to the back.

    A layer of doublers that may come off counts as one more ply.
    """
    ends = [0, *(stack.last for stack in stacks)]
    return ends[-1] in (plies, plies + 1) and all(stack.first == above + 1 and len(stack.failures) == stack.last - above
                                     for above, stack in zip(ends, stacks, strict=False) if stack.lay_up is None)


def _lines(coordinates: np.ndarray) -> np.ndarray:
    """Return the coordinates that differ by more than round-off, in ascending order."""
    ordered = np.sort(coordinates.ravel())
    return ordered[np.concatenate([[True], np.diff(ordered) > 1e-9 * np.ptp(ordered)])]


def _stacks(snapshot: Snapshot, x: np.ndarray, y: np.ndarray, zones: Zones) -> dict[Cell, tuple[Stack, ...]]:
    """Return the stacks of each cell: its layers, joined where the interface between them is intact."""
    mesh = snapshot.mesh
    low = mesh.corners.min(axis=1)
    places = [np.argmin(np.abs(lines - low[:, axis, None]), axis=1) for axis, lines in enumerate((x, y))]
    layers: dict[Cell, list[int]] = {}
    for element in np.argsort(mesh.first_ply, kind="stable"):
        layers.setdefault((int(places[0][element]), int(places[1][element])), []).append(int(element))
    return {cell: _stacks_of_cell(snapshot, elements, zones.at(*mesh.corners[elements[0]][:, :2].mean(axis=0)),
                                  zones) for cell, elements in layers.items()}


def _stacks_of_cell(snapshot: Snapshot, elements: list[int], lay_up: LayUp, zones: Zones) -> tuple[Stack, ...]:
    """Return the stacks of a cell with its layers from the struck face on."""
    mesh, plies = snapshot.mesh, len(zones.laminate)
    firsts, ends = ([int(numbers[element]) for element in elements] for numbers in (mesh.first_ply, mesh.last_ply))
    added_in_front = firsts[0] < 1  # by doublers that may come off, which are written as bonded rigidly
    if not _is_regular(lay_up, zones):  # outer layers may begin and end with a ply of a doubler, or at a missing one
        if firsts[-1] > plies:  # doublers that may come off
            ends[-2:] = [plies, plies + 1]
        else:
            ends[-1] = plies
        firsts = [1, *(end + 1 for end in ends[:-1])]
    flags = snapshot.failures | snapshot.added
    found: list[Stack] = []
    for element, first, last, numbers in zip(elements, firsts, ends, split(lay_up.numbers, ends[:-1], plies),
                                             strict=True):
        failures = tuple(int(flags[ply][element]) if ply in flags else 0 for ply in numbers)
        if found and (not snapshot.delaminated[element] or (added_in_front and len(found) == 1 and first == 1)):
            above = found.pop()
            first, failures, numbers = above.first, above.failures + failures, (*above.lay_up.numbers, *numbers)
        found.append(Stack(first, last, failures, LayUp(numbers, 0.0)))
    return placed(found, lay_up, zones)


def split(numbers: tuple[int, ...], ends: Sequence[int], plies: int) -> list[tuple[int, ...]]:
    """Return the plies of a lay-up in parts that end after these plies of the laminate, which has `plies`.

    Plies of doublers on the struck face belong to the first part, others to the last one.
    """
    parts: list[list[int]] = [[] for _ in range(len(ends) + 1)]
    part = 0
    for number in numbers:
        if number <= plies:
            part = sum(end < number for end in ends)
        elif (parts[0] and parts[0][-1] <= plies) or part > 0:
            part = len(ends)
        parts[part].append(number)
    return [tuple(found) for found in parts]


def _is_regular(lay_up: LayUp, zones: Zones) -> bool:
    """Return whether a lay-up is that of the laminate."""
    return lay_up == LayUp(tuple(range(1, len(zones.laminate) + 1)), lay_up.front)


def placed(stacks: Sequence[Stack], lay_up: LayUp, zones: Zones) -> tuple[Stack, ...]:
    """Return stacks with their height, without a lay-up of their own where their plies are those of the laminate."""
    found, front, every = [], lay_up.front, zones.plies
    for stack in stacks:
        numbers = stack.lay_up.numbers
        if not numbers:
            raise ImplamError(f"the delamination below ply {stack.last} has no ply on one of its sides.")
        found.append(stack._replace(lay_up=None if _is_regular(lay_up, zones) else LayUp(numbers, front)))
        front += sum(every[number - 1].thickness for number in numbers)
    return tuple(found)


def _completed(x: np.ndarray, y: np.ndarray, stacks: dict[Cell, tuple[Stack, ...]], part: str
               ) -> tuple[np.ndarray, np.ndarray, dict[Cell, tuple[Stack, ...]]]:
    """Return lines and stacks of the full plate from those of the modelled part."""
    halved = [any(signs[axis] < 0 for signs in IMAGES[part]) and lines[0] > -1e-9 * lines[-1]
              for axis, lines in enumerate((x, y))]
    x, y = (np.concatenate([-lines[:0:-1], lines]) if half else lines
            for lines, half in zip((x, y), halved, strict=True))
    counts = (len(x) - 1, len(y) - 1)
    full = {}
    for cell, found in stacks.items():
        place = [index + count // 2 if half else index for index, count, half in zip(cell, counts, halved, strict=True)]
        for signs in IMAGES[part]:
            column, row = (index if sign > 0 else count - 1 - index
                           for index, count, sign in zip(place, counts, signs, strict=True))
            full[column, row] = found
    return x, y, full


def _from_deck(deck: Deck) -> Panel:
    """Return the panel with the starters of a deck, in equal cells, as many as the full plate has elements."""
    plies = plies_of(deck)
    zones = zones_of(deck, plies)
    lengths, elements = deck.lengths(), deck.numbers("mesh", "elements")
    if len(elements) != 2 or min(elements) < 1 or any(count % 1 for count in elements):
        raise deck.error("mesh", "elements must be two integers greater than zero.")
    part = deck.choice("plate", "symmetry", ("none", *list(IMAGES)[1:]))
    parts = (1 if part in ("none", "half_y") else 2, 2 if part in ("quarter", "half_y") else 1)
    x, y = (np.linspace(-length / 2, length / 2, factor * int(count) + 1)
            for length, count, factor in zip(lengths, elements, parts, strict=True))
    beams = _stringers(deck, plies)
    x, y = (with_lines(lines, [*zones.edges(axis), *(
        place for beam in beams for place in ([beam.at] if beam.axis != axis else beam.ends))])
        for axis, lines in enumerate((x, y)))
    starters = starters_of(deck, plies, x, y, IMAGES.get(part, IMAGES["full"]))
    stacks = {}
    for i in range(len(x) - 1):
        for j in range(len(y) - 1):
            middle = (x[i] + x[i + 1]) / 2, (y[j] + y[j + 1]) / 2
            lay_up, below = zones.at(*middle), len(plies) - (not zones.may_separate(*middle, "back"))
            ends = sorted({ply for ply, cells in starters if cells[i, j] and ply <= below} | {below + 1})
            stacks[i, j] = placed([Stack(above + 1, end, len(numbers) * (0,), LayUp(numbers, 0.0))
                                   for above, end, numbers in zip([0, *ends], ends, split(
                                       lay_up.numbers, ends[:-1], len(plies)), strict=False)], lay_up, zones)
    return _panel(deck, zones, x, y, stacks, *([_STATE] if deck.has("initial_state") else []))


def _unwritten(deck: Deck, zones: Zones) -> Iterator[str]:
    """Return notes on loads, supports and section of the deck that are not exported."""
    yield from (f"&{group} is not written: add its supports or loads" for group in filter(deck.has, _UNWRITTEN))
    if deck.has("pressure") and deck.choice("pressure", "distribution", ("uniform", "sine")) == "sine":
        yield "the pressure is not written, as its distribution is a sine: add a load, or give a uniform --pressure"
    if any(doubler.may_separate and doubler.face == "back" for doubler in zones.doublers):
        yield "the bond of doublers on the back is written as rigid where it has not delaminated"
    if any(doubler.may_separate and doubler.face == "front" for doubler in zones.doublers):
        yield "the bond of doublers on the struck face is written as rigid, also where it has delaminated"
    # By default that of the lay-up.
    if deck.choice("laminate", "shear_correction",
                   dict.fromkeys((natural_shear_correction(zones.laminate), "5/6", "energy"))) == "energy":
        yield _BY_OTHERS


def _stringers(deck: Deck, plies: Sequence[Ply]) -> tuple[Stringer, ...]:
    """Return the stringers; given sections without E have that of the first ply along its fibres."""
    return stringers_of(deck, plies[0].material.e1)


def _panel(deck: Deck, zones: Zones, x: np.ndarray, y: np.ndarray, stacks: dict[Cell, tuple[Stack, ...]],
           *notes: str) -> Panel:
    """Combine the panel with supports and load of the deck."""
    if "elastic" in deck.edges():
        raise deck.error("plate", "edges = 'elastic' cannot be exported: give other edges, and add springs there.")
    if unknown := [edge for edge in deck.edges() if edge not in ("clamped", "simple", "free")]:
        raise deck.error("plate", f"edges = '{unknown[0]}' is not one of clamped, simple, free.")
    in_plane = deck.choice("plate", "in_plane", ("fixed", "free", "tangential"))
    half_waves = deck.numbers("plate", "half_waves") or [1, 1]
    if len(half_waves) != 2 or min(half_waves) < 1 or any(count % 1 for count in half_waves):
        raise deck.error("plate", "half_waves must be two integers greater than zero.")
    uniform = deck.has("pressure") and deck.choice("pressure", "distribution", ("uniform", "sine")) == "uniform"
    return Panel(deck.name, zones.laminate, x, y, stacks, deck.edges(), in_plane, degradation_of(deck),
                 deck.number("pressure", "value") if uniform else None,
                 deck.number("thermal", "delta_T") if deck.has("thermal") else None, (*_unwritten(deck, zones), *notes),
                 deck.number("plate", "imperfection", 0.0), (int(half_waves[0]), int(half_waves[1])),
                 curvatures_of(deck), zones.plies[len(zones.laminate):], _stringers(deck, zones.laminate))
