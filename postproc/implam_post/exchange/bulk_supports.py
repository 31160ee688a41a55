"""Supports of the edges from bulk data: SPC1, SPC and the constraints of GRID."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from implam_post.exchange.bulk_cards import BulkCard
from implam_post.exchange.bulk_connections import remark_connections
from implam_post.exchange.bulk_data import BulkData
from implam_post.exchange.bulk_shape import Shape
from implam_post.exchange.bulk_stringers import basis
from implam_post.exchange.remarks import Remarks

EDGES = ("x-min", "x-max", "y-min", "y-max")
_RIGID_MOTIONS = 3
# Rotations at edges along y and along x: first the one that a simple support constrains, then the other.
_ROTATIONS = ((4, 5), (5, 4))
# Cosine of the angle within which a direction is that of an axis.
_ALONG = 0.9998
Held = dict[int, dict[int, BulkCard]]


@dataclass(frozen=True)
class Supports:
    """Kinds of the four edges, and whether the supported edges constrain in-plane displacements.

    If they differ in that, or constrain one component only, `in_plane_lines` has edge and component of each constraint.
    """

    edges: tuple[str, ...]
    in_plane_fixed: bool
    in_plane_lines: tuple[tuple[int, int], ...] = ()


def read_supports(bulk: BulkData, systems: Mapping[int, Any], grids: Mapping[int, tuple[BulkCard, Any]], shape: Shape,
                  chosen: int | None, remarks: Remarks) -> Supports:
    """Return the supports; `chosen` is the number of the set; None: that of the case control, or the only one."""
    held = _held(bulk, systems, grids, shape, chosen, remarks)
    on_edges = {number: _edges_of(shape, place) for number, place in shape.places.items()}
    common = [_common(bulk, held, [grid for grid, edges in on_edges.items() if edges == [number]], number)
              for number in range(4)]
    in_plane = [{1, 2} & components for components in common]
    kinds = tuple(_kind(components, number, _card_on(held, on_edges, number), remarks)
                  for number, components in enumerate(common))
    fixed, lines = _in_plane(kinds, in_plane)
    pins = _pins(bulk, held, on_edges, common, kinds, remarks)
    if pins and (fixed or len(pins) > _RIGID_MOTIONS):
        card, grid = pins[0]
        raise bulk.error(card, f"it constrains grid {grid} in-plane, "
                                   "which is not the support of an entire edge.")
    for card, _ in pins:
        remarks.add(card, "part of it suppresses in-plane rigid-body motion, which Implam does by itself")
    remark_connections(bulk, on_edges, EDGES, kinds, remarks)
    if not any(kind != "free" for kind in kinds):
        remarks.note("nothing supports the panel: all its edges are free in the deck", in_deck=True)
    for number in sorted({edge for edge, _ in lines}):
        remarks.edge(EDGES[number], "in-plane constraints are written as &line, since edges or components differ")
    return Supports(kinds, fixed or all(kind == "free" for kind in kinds), lines)


def _held(bulk: BulkData, systems: Mapping[int, Any], grids: Mapping[int, tuple[BulkCard, Any]], shape: Shape,
          chosen: int | None, remarks: Remarks) -> Held:
    """Return for each grid of the panel the cards that constrain each component, in the axes of the panel."""
    held: Held = {}
    constraints = list(_constraints(bulk, _sets(bulk, chosen)))
    for card, numbers, components in [*constraints, *_rigid(bulk, grids, constraints, shape, remarks)]:
        if outside := sum(number not in shape.places for number in numbers):
            remarks.add(card, "some of its grids do not belong to the panel" if outside < len(numbers) else
                        "none of its grids belongs to the panel")
        _hold(bulk, held, card, numbers, components, systems, grids, shape)
    for number in shape.places:
        card, grid = grids[number]
        _hold(bulk, held, card, [number], grid.ps, systems, grids, shape)
    return held


def _sets(bulk: BulkData, chosen: int | None) -> set[int]:
    """Return the numbers of the support sets that apply."""
    there = {bulk.integer(card, 1) for card in bulk.named("SPC1", "SPC")}
    added: dict[int, set[int]] = {}
    for card in bulk.named("SPCADD"):
        sets = {bulk.integer(card, number) for number in range(2, len(card.fields))}
        added.setdefault(bulk.integer(card, 1), set()).update(sets)
    wanted = bulk.case_control.selected("SPC") if chosen is None else chosen
    if wanted is None:
        if len(there) > 1 or added:
            raise bulk.missing(f"there are the support sets {', '.join(map(str, sorted(there | set(added))))}: "
                               "choose one with --spc.")
        return there
    sets = added.get(wanted, {wanted})
    if absent := sets - there:
        origin = "in the case control" if chosen is None else "of --spc"
        raise bulk.missing(f"SPC = {wanted} {origin} needs an SPC1 or SPC of set {min(absent)}, which does not exist.")
    return sets


def _constraints(bulk: BulkData, sets: set[int]) -> Iterable[tuple[BulkCard, list[int], str]]:
    """Return card, grids and components of each support in these sets."""
    from pyNastran.bdf.cards.constraints import SPC, SPC1
    for card in bulk.named("SPC1", "SPC"):
        if bulk.integer(card, 1) not in sets:
            continue
        if card.name == "SPC1":
            _check_ranges(bulk, card)
            read = bulk.read(card, SPC1)
            yield card, read.nodes, read.components
            continue
        read = bulk.read(card, SPC)
        if any(read.enforced):
            raise bulk.error(card, "prescribed displacements are not supported.")
        for number, components in zip(read.nodes, read.components, strict=True):
            yield card, [number], components


def _rigid(bulk: BulkData, grids: Mapping[int, tuple[BulkCard, Any]],
           constraints: Iterable[tuple[BulkCard, list[int], str]], shape: Shape, remarks: Remarks
           ) -> Iterable[tuple[BulkCard, list[int], str]]:
    """Return the constraints of RBE2 whose independent grid is constrained in all components, as their other grids are.
    """
    fixed: dict[int, set[str]] = {number: set(grid.ps) for number, (_, grid) in grids.items()}
    for _, numbers, components in constraints:
        for number in numbers:
            fixed.setdefault(number, set()).update(components)
    for card in bulk.named("RBE2"):
        # A real number after the grids is a thermal expansion coefficient.
        independent, *dependent = (int(text or 0) for text in (card.fields.field(2), *card.fields.card[4:])
                                   if (text or "0").isdigit())
        if set("123456") <= fixed.get(independent, set()) and any(number in shape.places for number in dependent):
            bulk.also_read.add(card)
            remarks.add(card, f"read as a support, since grid {independent} is constrained in all components")
            yield card, [number for number in dependent if number], card.fields.field(3) or ""


def _check_ranges(bulk: BulkData, card: BulkCard) -> None:
    """Refuse a range of grids without its last number or in descending order, which would constrain no grid."""
    for number in range(4, len(card.fields)):
        if str(card.fields.field(number) or "").upper() == "THRU":
            first, last = (card.fields.field(place) for place in (number - 1, number + 1))
            if last is None:
                raise bulk.error(card, f"no grid follows THRU after {first}.")
            if bulk.integer(card, number - 1) >= bulk.integer(card, number + 1):
                raise bulk.error(card, f"{first} THRU {last}: the second number must be greater than the first.")


def _hold(bulk: BulkData, held: Held, card: BulkCard, numbers: Iterable[int], components: str,
          systems: Mapping[int, Any], grids: Mapping[int, tuple[BulkCard, Any]], shape: Shape) -> None:
    """Store the components that a card constrains, in the axes of the panel, without the rotation about the normal."""
    for number in numbers:
        if number not in shape.places:
            continue
        directions = None
        for component in components:
            turns, axis = divmod(int(component) - 1, 3) if component in "123456" else (0, None)
            if axis is None:
                continue
            if directions is None:
                directions = _directions(bulk, systems, *grids[number], shape, number)
            along = directions[axis]
            if along is None and not set("12345") <= set(components):
                raise bulk.error(grids[number][0], f"its CD is {grids[number][1].cd}: components of the {card.name} in "
                                                   f"line {card.line} must be along axes of the panel; leave CD blank.")
            for each in range(3) if along is None else [along]:
                if (turns, each) != (1, 2):
                    held.setdefault(number, {})[3 * turns + each + 1] = card


def _directions(bulk: BulkData, systems: Mapping[int, Any], card: BulkCard, grid: Any, shape: Shape, number: int
                ) -> list[int | None]:
    """Return for each component of a grid the axis of the panel along which it is: that of the panel's middle, or that
    of the surface at the grid; None if it is along none.
    """
    rows = np.eye(3)
    if grid.cd:
        point = np.array(systems[grid.cp].transform_node_to_global(grid.xyz))
        rows = basis(bulk, systems, card, grid, point)
    found: list[int | None] = []
    for row in rows:
        shares = np.abs([axes @ row for axes in (shape.axes, shape.surface.frame(shape.places[number]))])
        found.append(int(np.argmax(shares.max(axis=0))) if shares.max() > _ALONG else None)
    return found


def _edges_of(shape: Shape, place: np.ndarray) -> list[int]:
    """Return the edges on which a position lies."""
    return [2 * axis + far for axis in (0, 1) for far, sign in enumerate((-1, 1))
            if abs(sign * place[axis] - shape.lengths[axis] / 2) < 1e-6 * max(shape.lengths)]


def _common(bulk: BulkData, held: Held, along: list[int], number: int) -> set[int]:
    """Return the components constrained all along an edge between its corners."""
    if not along:
        raise bulk.missing(f"the edge {EDGES[number]} has no grid between its corners, which would define its support.")
    each = [set(held.get(grid, {})) for grid in along]
    common, somewhere = set.intersection(*each), set.union(*each)
    for component in sorted((somewhere - common) & {3, 4, 5}):
        grid, card = next((grid, held[grid][component]) for grid in along if component in held.get(grid, {}))
        bare = next(grid for grid in along if component not in held.get(grid, {}))
        raise bulk.error(card, f"it constrains grid {grid} on the edge {EDGES[number]}, but not grid {bare} of that "
                               "edge: only entire edges can be supported.")
    return common


def _card_on(held: Held, on_edges: Mapping[int, list[int]], number: int) -> BulkCard | None:
    """Return a card that constrains an edge, if there is one."""
    return next((next(iter(held[grid].values())) for grid, edges in on_edges.items() if edges == [number]
                 and held.get(grid)), None)


def _kind(components: set[int], number: int, card: BulkCard | None, remarks: Remarks) -> str:
    """Return the kind of an edge; a simple support constrains the rotation along the edge, a clamp both."""
    along, about_normal = _ROTATIONS[number // 2]
    turns = components & {4, 5}
    if 3 not in components:
        if components and card:
            raise card.error(f"the edge {EDGES[number]} is constrained, but not its deflection, component 3: it is "
                             "neither clamped nor simple nor free. Mesh both sides of a line of symmetry.")
        return "free"
    kind = "clamped" if about_normal in turns else "simple"
    if along not in turns:
        remarks.edge(EDGES[number], f"{kind}; in the file the rotation along the edge is free, Implam constrains it")
    return kind


def _in_plane(kinds: tuple[str, ...], in_plane: list[set[int]]) -> tuple[bool, tuple[tuple[int, int], ...]]:
    """Return whether all supported edges constrain both in-plane components; if not, edge and component of each."""
    supported = [number for number, kind in enumerate(kinds) if kind != "free"]
    if supported and all(in_plane[number] == {1, 2} for number in supported):
        return True, ()
    return False, tuple((number, component) for number in supported for component in sorted(in_plane[number]))


def _pins(bulk: BulkData, held: Held, on_edges: Mapping[int, list[int]], common: list[set[int]],
          kinds: Sequence[str], remarks: Remarks) -> list[tuple[BulkCard, int]]:
    """Return card and grid of in-plane constraints off the edges; corners must have those of their edges."""
    pins = []
    for grid, edges in on_edges.items():
        expected = set().union(*(common[number] for number in edges))
        there = held.get(grid, {})
        missing = expected - set(there)
        if missing & {1, 2, 3}:
            card = _card_on(held, on_edges, edges[0]) or _card_on(held, on_edges, edges[-1])
            sentence = (f"the corner grid {grid} is not constrained in component {min(missing)} (in the panel's axes) "
                        "as its edges are: only entire edges can be supported.")
            raise card.error(sentence) if card else bulk.missing(sentence)
        if missing:
            remarks.edge(" and ".join(EDGES[number] for number in edges),
                         f"rotations of the corner grid {grid} are free in the file, Implam constrains them")
        # Supports of Implam constrain the rotation along the edge, whether or not the file does.
        expected |= {_ROTATIONS[number // 2][0] for number in edges if kinds[number] != "free"}
        for component, card in there.items():
            if component in expected:
                continue
            if component > 2:
                raise bulk.error(card, f"it constrains grid {grid}, which is not on an edge with that constraint: only "
                                       "entire edges can be supported.")
            pins.append((card, grid))
    return pins
