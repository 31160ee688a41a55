"""The panel for export to other programs: its cells, their sublaminates, its supports."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from implam_post.exchange.degradation import Degradation, failed_modes
from implam_post.exchange.stringers import Stringer
from implam_post.laminate.sections import Material, Ply
from implam_post.laminate.zones import LayUp

Cell = tuple[int, int]


class Stack(NamedTuple):
    """A sublaminate: plies `first` to `last` of the laminate, counted from the struck face, and the failure modes of
    each. Where doublers or ply drops change its plies, `lay_up` has them, and the failures are theirs.
    """

    first: int
    last: int
    failures: tuple[int, ...]
    lay_up: LayUp | None = None


class MaterialState(NamedTuple):
    """A material of the deck after some failure modes."""

    name: str
    failures: int

    @property
    def failed(self) -> str:
        """Names of the failure modes; empty if undamaged."""
        return failed_modes(self.failures)


class Layer(NamedTuple):
    """A ply of a section."""

    material: MaterialState
    thickness: float
    angle: float


@dataclass(frozen=True)
class Section:
    """The plies of a stack, their numbers, and z of its mid-plane, from that of the full laminate towards the back."""

    layers: tuple[Layer, ...]
    middle: float
    numbers: tuple[int, ...]

    @property
    def thickness(self) -> float:
        """Thickness of the stack."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def first_face(self) -> float:
        """z of the surface nearest to the struck face."""
        return _plain(self.middle - self.thickness / 2, self.thickness)

    @property
    def last_face(self) -> float:
        """z of the surface nearest to the back."""
        return _plain(self.middle + self.thickness / 2, self.thickness)

    @property
    def title(self) -> str:
        """Numbers of the plies and their failures, as text."""
        runs: list[list[int]] = []
        for number in self.numbers:
            if runs and number == runs[-1][-1] + 1:
                runs[-1].append(number)
            else:
                runs.append([number])
        words = ["plies " + " and ".join(f"{run[0]} to {run[-1]}" for run in runs)]
        words += [f"{number} {layer.material.failed}" for number, layer in zip(self.numbers, self.layers, strict=True)
                  if layer.material.failures]
        return ", ".join(words)


def _plain(place: float, thickness: float) -> float:
    """Return a coordinate without the round-off of summed thicknesses, or of a zero of a sine."""
    return 0.0 if abs(place) <= 1e-9 * thickness else float(f"{place:.12g}")


@dataclass(frozen=True)
class Panel:
    """A rectangular panel, centred at the origin, in cells; `x` and `y` are the lines between cells, ascending.

    `temperature` is the change from the stress-free temperature; `unwritten` has notes on what the deck has beyond the
    export. The lines of the stress-free panel along x and y have a `curvature`, and an initial deflection in half waves
    with the amplitude `imperfection`. `in_plane` is `fixed`, `free` or `tangential`. `added` are the plies of doublers,
    numbered after those of the laminate.
    """

    name: str
    plies: Sequence[Ply]
    x: np.ndarray
    y: np.ndarray
    stacks: dict[Cell, tuple[Stack, ...]]
    edges: Sequence[str]
    in_plane: str
    degradation: Degradation
    pressure: float | None = None
    temperature: float | None = None
    unwritten: tuple[str, ...] = ()
    imperfection: float = 0.0
    half_waves: tuple[int, int] = (1, 1)
    curvature: tuple[float, float] = (0.0, 0.0)
    added: Sequence[Ply] = ()
    stringers: Sequence[Stringer] = ()

    @property
    def cells(self) -> tuple[int, int]:
        """Numbers of cells along x and y."""
        return len(self.x) - 1, len(self.y) - 1

    def initial_deflection(self, x: float, y: float) -> float:
        """Return the height of the stress-free panel at a position, positive towards the back."""
        waves = [math.sin(count * math.pi * (place - lines[0]) / (lines[-1] - lines[0]))
                 for count, place, lines in zip(self.half_waves, (x, y), (self.x, self.y), strict=True)]
        height = sum(curvature * (place - (lines[0] + lines[-1]) / 2)**2 / 2
                     for curvature, place, lines in zip(self.curvature, (x, y), (self.x, self.y), strict=True))
        return _plain(self.imperfection * math.prod(waves) + height, abs(self.imperfection) or abs(height))

    def normal(self, x: float, y: float) -> np.ndarray:
        """Return the unit normal of the stress-free panel at a position, towards the back."""
        slopes = []
        for axis in (0, 1):
            step = np.zeros(2)
            step[axis] = 1e-4 * np.ptp((self.x, self.y)[axis])
            ahead, behind = (self.initial_deflection(x + sign * step[0], y + sign * step[1]) for sign in (1, -1))
            slopes.append((ahead - behind) / (2 * step[axis]))
        normal = np.array([-slopes[0], -slopes[1], 1.0])
        return np.asarray(normal / np.linalg.norm(normal))

    def section(self, stack: Stack) -> Section:
        """Return the section of a stack."""
        faces = np.concatenate([[0.0], np.cumsum([ply.thickness for ply in self.plies])])
        every = [*self.plies, *self.added]
        numbers, front = stack.lay_up or LayUp(tuple(range(stack.first, stack.last + 1)),
                                               faces[stack.first - 1] - faces[-1] / 2)
        plies = [every[number - 1] for number in numbers]
        layers = tuple(Layer(MaterialState(ply.material.name, failed), ply.thickness, ply.angle)
                       for ply, failed in zip(plies, stack.failures, strict=True))
        middle = front + sum(layer.thickness for layer in layers) / 2
        return Section(layers, _plain(middle, faces[-1]), numbers)

    def outer_face(self, cell: Cell, outwards: int) -> float:
        """Return z of the face of a cell at the back (`outwards` 1) or the struck side (-1)."""
        stacks = self.stacks[cell]
        return self.section(stacks[-1]).last_face if outwards > 0 else self.section(stacks[0]).first_face

    def sections(self) -> list[Section]:
        """Return the sections of the panel, the most frequent one first, which usually is the undamaged one."""
        count: dict[Section, int] = {}
        for stacks in self.stacks.values():
            for stack in stacks:
                section = self.section(stack)
                count[section] = count.get(section, 0) + 1
        return sorted(count, key=lambda section: (-len(section.layers), -count[section], section.numbers))

    def materials(self) -> dict[MaterialState, Material]:
        """Return the material states of the panel with their elastic constants, undamaged ones first."""
        originals = {ply.material.name: ply.material for ply in (*self.plies, *self.added)}
        states = {MaterialState(name, 0) for name in originals}
        states |= {layer.material for section in self.sections() for layer in section.layers}
        order = list(originals)
        return {state: self.degradation.degraded(originals[state.name], state.failures)
                for state in sorted(states, key=lambda state: (state.failures, order.index(state.name)))}

    def delaminated(self, cell: Cell) -> frozenset[int]:
        """Return the delaminated interfaces of a cell, as numbers of the ply above."""
        return frozenset(stack.last for stack in self.stacks[cell][:-1])

    @property
    def expands(self) -> bool:
        """Whether the change of temperature is a load of the panel."""
        return bool(self.temperature) and any(any(ply.material.expansion) for ply in (*self.plies, *self.added))

    def with_pressure(self, pressure: float | None) -> "Panel":
        """Return the panel under another pressure; None keeps the pressure."""
        return self if pressure is None else replace(self, pressure=pressure)
