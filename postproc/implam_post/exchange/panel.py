"""The panel for export to other programs: its cells, their sublaminates, its supports."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from implam_post.exchange.degradation import Degradation, failed_modes
from implam_post.laminate.sections import Material, Ply

Cell = tuple[int, int]


class Stack(NamedTuple):
    """A sublaminate: plies `first` to `last`, counted from the struck face, and the failure modes of each."""

    first: int
    last: int
    failures: tuple[int, ...]


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
    """The plies of a stack and z of its mid-plane, from that of the full laminate towards the back."""

    layers: tuple[Layer, ...]
    middle: float
    first: int

    @property
    def thickness(self) -> float:
        """Thickness of the stack."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def first_face(self) -> float:
        """z of the surface nearest to the struck face."""
        return _plain(self.middle - self.thickness / 2, self.thickness)

    @property
    def title(self) -> str:
        """Numbers of the plies and their failures, as text."""
        words = [f"plies {self.first} to {self.first + len(self.layers) - 1}"]
        words += [f"{number} {layer.material.failed}" for number, layer in enumerate(self.layers, self.first)
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
    with the amplitude `imperfection`. `in_plane` is `fixed`, `free` or `tangential`.
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

    def section(self, stack: Stack) -> Section:
        """Return the section of a stack."""
        faces = np.concatenate([[0.0], np.cumsum([ply.thickness for ply in self.plies])])
        plies = self.plies[stack.first - 1:stack.last]
        layers = tuple(Layer(MaterialState(ply.material.name, failed), ply.thickness, ply.angle)
                       for ply, failed in zip(plies, stack.failures, strict=True))
        middle = (faces[stack.first - 1] + faces[stack.last] - faces[-1]) / 2
        return Section(layers, _plain(middle, faces[-1]), stack.first)

    def sections(self) -> list[Section]:
        """Return the sections of the panel, the most frequent one first, which usually is the undamaged one."""
        count: dict[Section, int] = {}
        for stacks in self.stacks.values():
            for stack in stacks:
                section = self.section(stack)
                count[section] = count.get(section, 0) + 1
        return sorted(count, key=lambda section: (-len(section.layers), -count[section], section.first))

    def materials(self) -> dict[MaterialState, Material]:
        """Return the material states of the panel with their elastic constants, undamaged ones first."""
        originals = {ply.material.name: ply.material for ply in self.plies}
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
        return bool(self.temperature) and any(any(ply.material.expansion) for ply in self.plies)

    def with_pressure(self, pressure: float | None) -> "Panel":
        """Return the panel under another pressure; None keeps the pressure."""
        return self if pressure is None else replace(self, pressure=pressure)
