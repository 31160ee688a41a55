"""Delaminations and ply failures in plan at the times written to NAME.h5."""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from implam_post.io.contours import WEIGHTS, above, area, areas, level_of, outline, region
from implam_post.io.deck import Deck, recorded_deck
from implam_post.io.errors import FileError, ImplamError

__all__ = ["FIBRES", "IMAGES", "MODES", "Fields", "Interface", "Mesh", "NoTimeError", "Snapshot", "area", "deck_in",
           "extents", "opened", "outline", "read_fields", "struck_point"]
MODES = {"fibre failure": 1, "matrix cracking": 2, "matrix crushing": 4}
FIBRES = ("fibres torn", "fibres crushed")
# Exceptions of h5py and numpy on damaged files or files of another program.
_DAMAGED = (KeyError, IndexError, TypeError, ValueError, AttributeError, RuntimeError, OverflowError, MemoryError)


class NoTimeError(FileError):
    """The file has no times: the run ended before fields were written."""


@dataclass(frozen=True)
class Mesh:
    """Elements in plan: corners, counter-clockwise (elements, 4, 2), first and last ply of each element, and whether
    the interface on top of it was delaminated initially."""

    corners: np.ndarray
    first_ply: np.ndarray
    last_ply: np.ndarray
    starter: np.ndarray

    @cached_property
    def lower(self) -> np.ndarray:
        """Whether an element has an interface on top; first ply 1 has one below doublers that may come off."""
        _, _, place = _plan_of(self.corners)
        covered = np.zeros(len(place), dtype=bool)
        covered[place[self.first_ply < 1]] = True
        return np.asarray((self.first_ply > 1) | ((self.first_ply == 1) & covered[place]))

    @property
    def interfaces(self) -> list[int]:
        """Numbers of the plies above the interfaces that may delaminate; 0 for doublers on the struck face."""
        return [int(ply) - 1 for ply in np.unique(self.first_ply[self.lower])]

    @property
    def plies(self) -> range:
        """Numbers of the plies."""
        return range(1, int(self.last_ply.max()) + 1)


@dataclass(frozen=True)
class Interface:
    """Figures of an interface as in the summary; `bounds` are least and greatest x, then y, of the delamination."""

    area: float
    is_cohesive: bool
    has_grown: bool
    bounds: tuple[float, float, float, float]

    @property
    def extents(self) -> tuple[float, float]:
        """Lengths along x and y."""
        return self.bounds[1] - self.bounds[0], self.bounds[3] - self.bounds[2]


@dataclass(frozen=True)
class Snapshot:
    """State at one time, by element: fraction of the toughness dissipated at the nine points of the interface on top,
    ply failures, G/G_c ahead of fronts, plies with crushed fibres; also figures of interfaces and projected area.

    `added` are the failures of plies of doublers, by their number, with 0 in elements without them."""

    time: float
    mesh: Mesh
    shares: np.ndarray
    failures: dict[int, np.ndarray]
    release_ratio: np.ndarray
    interfaces: dict[int, Interface] = field(default_factory=dict)
    projected_area: float | None = None
    crushed: dict[int, np.ndarray] = field(default_factory=dict)
    added: dict[int, np.ndarray] = field(default_factory=dict)

    @property
    def delaminated(self) -> np.ndarray:
        """Whether the interface on top of an element is delaminated: with cohesive laws the elements of largest shares,
        as many as have the dissipated area; with fronts the elements behind the front."""
        found = np.zeros(len(self.shares), dtype=bool)
        parts = self.shares @ WEIGHTS
        for below_ply in self.mesh.interfaces:
            own = np.flatnonzero(self.of_interface(below_ply) & (parts > 0))
            own = own[np.argsort(-parts[own], kind="stable")]
            sizes = areas(self.mesh.corners[own])
            # The last element counts as delaminated if more than half of it is needed to reach the area.
            found[own[np.cumsum(sizes) - sizes / 2 < np.sum(sizes * parts[own])]] = True
        return found

    def of_interface(self, below_ply: int) -> np.ndarray:
        """Return for each element whether this interface is on top of it."""
        return np.asarray(self.mesh.lower & (self.mesh.first_ply == below_ply + 1))

    def projected(self) -> tuple[np.ndarray, np.ndarray]:
        """Return cells in plan and at each of their points the largest share of all interfaces."""
        layered = self.mesh.lower
        corners, shares = self.mesh.corners[layered], self.shares[layered]
        _, first, place = _plan_of(corners)
        largest = np.zeros((len(first), 9))
        np.maximum.at(largest, place, shares)
        return corners[first], largest

    def release(self, below_ply: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners of cells ahead of the front below a ply with G > 0, and their G/G_c."""
        loaded = (self.release_ratio > 0) & self.of_interface(below_ply)
        return self.mesh.corners[loaded], self.release_ratio[loaded]

    def failed(self, ply: int, kind: str) -> np.ndarray:
        """Return whether a ply of an element failed: in one of MODES, or with fibres torn or fibres crushed."""
        of_ply = (self.mesh.first_ply <= ply) & (ply <= self.mesh.last_ply)
        mode = MODES.get(kind, MODES["fibre failure"])
        found = of_ply & (self.failures[ply] & mode > 0)
        return np.asarray(found if kind in MODES else found & (self.crushed[ply] == (kind == FIBRES[1])))

    def failed_cells(self, ply: int, kind: str) -> np.ndarray:
        """Return the corners of cells in which a ply failed; see `failed`."""
        return np.asarray(self.mesh.corners[self.failed(ply, kind)])

    @property
    def kinds_of_fibre_failure(self) -> tuple[str, ...]:
        """Kinds of fibre failure that the file distinguishes."""
        return FIBRES if self.crushed else ("fibre failure",)

    def projected_rest(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return `projected`, and for each of its cells the ply above the interface with the largest mean share."""
        corners, largest = self.projected()
        layered = np.flatnonzero(self.mesh.lower)
        _, _, place = _plan_of(self.mesh.corners[layered])
        order = np.lexsort((self.shares[layered] @ WEIGHTS, place))
        last = np.append(np.flatnonzero(np.diff(place[order])), len(order) - 1)
        return corners, largest, self.mesh.first_ply[layered[order[last]]] - 1


def _plan_of(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the middles of cells in plan, the first element of each, and the cell of each element."""
    middles = np.round(corners.mean(axis=1) / (np.abs(corners).max(initial=0) or 1) * 1e7).astype(np.int64)
    found, first, place = np.unique(middles, axis=0, return_index=True, return_inverse=True)
    return found, first, place.ravel()


# Signs of x and y of the mirror images of the modelled part.
IMAGES = {"whole": [(1, 1)], "full": [(1, 1)], "quarter": [(1, 1), (-1, 1), (-1, -1), (1, -1)],
          "half_x": [(1, 1), (-1, 1)], "half_y": [(1, 1), (1, -1)], "point": [(1, 1), (-1, -1)]}


@dataclass(frozen=True)
class Fields:
    """The state of a run at all times written; cells are those of the modelled part of the plate."""

    name: str
    part: str
    snapshots: list[Snapshot]
    _found: dict[tuple[int, int], np.ndarray] = field(default_factory=dict, compare=False, repr=False)

    @property
    def path(self) -> Path:
        """Path of the file."""
        return Path(self.name)

    def place(self, time: float) -> int:
        """Return the index of the snapshot nearest to a time."""
        stored = np.array([snapshot.time for snapshot in self.snapshots])
        if not stored[0] * (1 - 1e-6) <= time <= stored[-1] * (1 + 1e-6):
            raise ImplamError(f"time {time:g} is outside the times of the fields, {stored[0]:g} to {stored[-1]:g}.")
        return int(np.argmin(np.abs(stored - time)))

    @property
    def quarter(self) -> bool:
        """Whether a quarter of the plate was modelled."""
        return self.part == "quarter"

    def full_plate(self, cells: np.ndarray) -> np.ndarray:
        """Return the cells of the full plate: those of the modelled part and their mirror images, counter-clockwise."""
        return np.concatenate([(cells * np.array(signs))[:, ::signs[0] * signs[1]] for signs in IMAGES[self.part]])

    def delaminated(self, place: int, below_ply: int) -> np.ndarray:
        """Return the delamination below a ply at one of the times, as polygons on the full plate.

        With cohesive laws they enclose the largest fractions of dissipated toughness and have the dissipated area.
        """
        if (place, below_ply) not in self._found:
            snapshot = self._snapshot(place, below_ply)
            own = snapshot.of_interface(below_ply)
            self._found[place, below_ply] = self.full_plate(region(snapshot.mesh.corners[own], snapshot.shares[own]))
        return self._found[place, below_ply]

    def _snapshot(self, place: int, below_ply: int | None = None) -> Snapshot:
        """Return one of the snapshots; raise FileError if the file has no such time or interface."""
        count = len(self.snapshots)
        if not -count <= place < count:
            raise ImplamError(f"{self.name} has no time with index {place}: indices are 0 to {count - 1}.")
        known = sorted({ply for each in self.snapshots for ply in (*each.mesh.interfaces, *each.interfaces)})
        if below_ply is not None and below_ply not in known:
            raise ImplamError(f"{self.name} has no interface below ply {below_ply}; it has "
                              f"{', '.join(map(str, known)) or 'none'}.")
        return self.snapshots[place]

    def projected(self, place: int) -> np.ndarray:
        """Return the projected (C-scan) delamination at one of the times, as polygons on the full plate."""
        return self.full_plate(region(*self._snapshot(place).projected()))

    def projected_depths(self, place: int) -> list[np.ndarray]:
        """Return the part of each interface in the projected delamination, as polygons on the full plate."""
        snapshot = self.snapshots[place]
        level = level_of(*snapshot.projected())
        owns = [snapshot.of_interface(below_ply) for below_ply in snapshot.mesh.interfaces]
        return [self.full_plate(above(snapshot.mesh.corners[own], snapshot.shares[own], level)) for own in owns]

    def projected_rest(self, place: int) -> list[np.ndarray]:
        """Return the projected delamination by the interface with the largest share of each cell.

        The interpolated largest share is not the largest of the interpolated shares, so that `projected_depths` leaves
        parts of the region out.
        """
        snapshot = self.snapshots[place]
        corners, largest, of = snapshot.projected_rest()
        level = level_of(corners, largest)
        return [self.full_plate(above(corners[of == below_ply], largest[of == below_ply], level))
                for below_ply in snapshot.mesh.interfaces]

    def starter(self, below_ply: int) -> np.ndarray:
        """Return the cells of the full plate that were initially delaminated below a ply."""
        mesh = self.snapshots[-1].mesh
        return self.full_plate(mesh.corners[mesh.starter & mesh.lower & (mesh.first_ply == below_ply + 1)])

    def interface(self, place: int, below_ply: int) -> Interface:
        """Return the figures of an interface at one of the times, computed from its polygons if the file has none."""
        snapshot = self._snapshot(place, below_ply)
        if below_ply in snapshot.interfaces:
            return snapshot.interfaces[below_ply]
        cells = self.delaminated(place, below_ply)
        bounds = np.stack([cells.min(axis=(0, 1)), cells.max(axis=(0, 1))], axis=1) if len(cells) else np.zeros((2, 2))
        return Interface(area(cells), bool(np.any(snapshot.shares % 1 > 0)), len(cells) > 0, tuple(bounds.ravel()))

    def projected_area(self, place: int) -> float:
        """Return the projected (C-scan) area at one of the times."""
        found = self._snapshot(place).projected_area
        return area(self.projected(place)) if found is None else found


def extents(cells: np.ndarray) -> tuple[float, float]:
    """Return the lengths along x and y of the smallest rectangle around cells; 0 if there are none."""
    if not len(cells):
        return 0.0, 0.0
    along, across = np.ptp(cells.reshape(-1, 2), axis=0)
    return float(along), float(across)


def read_fields(path: Path | str) -> Fields:
    """Read interfaces and plies from the solver's NAME.h5."""
    path = Path(path)
    with opened(path) as file:
        meshes = {number: _mesh(group) for number, group in enumerate(_in_order(file["meshes"]), start=1)}
        snapshots = [_snapshot(group, meshes) for group in _in_order(file["times"])]
        part = file["part"][()].decode()
    if not snapshots:
        raise NoTimeError(f"{path} has no times yet.")
    if part not in IMAGES:
        raise FileError(f"{path} has an unknown symmetry: {part}.")
    return Fields(str(path), part, snapshots)


_CHECKPOINT = "_restart"


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file; all errors on it are reported as one sentence."""
    if not path.is_file():
        raise FileError(f"{path} is a folder; give the fields NAME.h5 in it." if path.is_dir() else
                        f"the fields {path} cannot be read (there is no such file).")
    if not h5py.is_hdf5(path):
        raise FileError(f"{path} is not a file of fields written by implam; give NAME.h5.")
    try:
        with h5py.File(path, "r") as file:
            if "meshes" not in file and _CHECKPOINT in path.name:
                raise FileError(f"{path} is a checkpoint; give the fields, {path.name.replace(_CHECKPOINT, '')}.")
            yield file
    except OSError as error:
        raise FileError(f"the fields {path} cannot be read ({_reason(error)}).") from None
    except _DAMAGED as error:
        raise FileError(f"{path} is not a file of fields written by implam, or is damaged "
                        f"({_reason(error)}).") from None


class _MemberError(ValueError):
    """An error about a member of the file, found by this module."""


def _reason(error: Exception) -> str:
    """Return the reason of an error in terms of the file; messages of h5py and numpy are about their internals."""
    if isinstance(error, _MemberError):
        return str(error)
    if lacking := re.search(r"object '([^']*)' doesn.t exist", str(error)):
        return f"it has no {lacking[1]}"
    if isinstance(error, OSError) and error.errno:
        return os.strerror(error.errno).lower()
    if isinstance(error, OSError) and "truncated" in str(error):
        return "it ends too early"
    return "part of it was not written by implam"


def _in_order(group: h5py.Group) -> list[h5py.Group]:
    """Return the numbered members of a group in ascending order."""
    return [group[name] for name in sorted(group)]


def _finite(values: np.ndarray, name: str, count: int | None = None) -> np.ndarray:
    """Return an array of this size; raise an error unless all its numbers are finite."""
    if values.dtype.kind not in "biuf" or not np.all(np.isfinite(values)) or (
            count is not None and len(values) != count):
        raise _MemberError(f"{name} does not have one number per element")
    return values


def _flags(values: np.ndarray, name: str, count: int) -> np.ndarray:
    """Return failures by element, as sums of modes."""
    if not np.all((_finite(values, name, count) >= 0) & (values <= sum(MODES.values()))):
        raise _MemberError(f"{name} does not have failures")
    return values.astype(int)


def _mesh(group: h5py.Group) -> Mesh:
    """Read a mesh; the first four points of an element are its corners."""
    points, connectivity = group["coordinates"][()], group["connectivity"][()]
    if connectivity.min(initial=0) < 0:
        raise _MemberError("connectivity has negative numbers")
    corners = _finite(points[:, :2][connectivity[:, :4]], "coordinates")
    first, last = (_finite(group[f"cells/{name}"][()].ravel(), name, len(corners)) for name in ("first_ply",
                                                                                                 "last_ply"))
    # The layer of a doubler that may come off lies above or below the laminate and has none of its plies.
    if first.min() < 0 or np.any(last < first - 1) or np.any((first < 1) & (last > 0)):
        raise _MemberError("first_ply and last_ply are not numbers of plies")
    starter = group["cells/starter_above"][()].ravel() if "starter_above" in group["cells"] else np.zeros(len(first))
    return Mesh(corners, first, last, _finite(starter, "starter_above", len(first)) > 0)


def _snapshot(group: h5py.Group, meshes: dict[int, Mesh]) -> Snapshot:
    """Read a time; without interfaces no element is delaminated, without ply damage no ply has an entry."""
    number = int(group["mesh"][()])
    if number not in meshes:
        raise _MemberError(f"it has no mesh {number}")
    mesh, cells = meshes[number], group.get("cells", {})
    nothing = np.zeros(len(mesh.first_ply))
    delaminated, release_ratio = (_finite(cells[name][()].ravel(), name, len(nothing)) if name in cells else nothing
                                  for name in ("delaminated_above", "energy_release_above"))
    names = (name for name in map(re.compile(r"ply_(\d+)_failure").fullmatch, cells) if name)
    found = sorted((int(name[1]), name.string) for name in names)
    every = {ply: _flags(cells[name][()].ravel(), name, len(nothing)) for ply, name in found}
    failures, added = ({ply: flags for ply, flags in every.items() if (ply in mesh.plies) == of_laminate}
                       for of_laminate in (True, False))
    crushed = {ply: _finite(cells[name][()].ravel(), name, len(nothing)) > 0 for ply in failures
               if (name := f"ply_{ply}_fibres_crushed") in cells}
    interfaces, projected = _figures(group.get("interfaces", {}))
    shares = np.repeat(delaminated[:, None], 9, axis=1)
    if "points/dissipated_above" in group:
        at_points = _finite(group["points/dissipated_above"][()], "dissipated_above")
        at_points = at_points[group.file[f"meshes/{number:08d}/connectivity"][()]]
        cohesive = [below_ply + 1 for below_ply, figures in interfaces.items() if figures.is_cohesive]
        shares = np.where((mesh.lower & np.isin(mesh.first_ply, cohesive))[:, None], at_points, shares)
    time = float(_finite(group["time"][()], "time"))
    return Snapshot(time, mesh, np.clip(shares, 0, 1), failures, release_ratio, interfaces, projected,
                    crushed, added)


def _figures(group: h5py.Group | dict[str, Any]) -> tuple[dict[int, Interface], float | None]:
    """Read the figures of the interfaces and the projected area; files of earlier versions do not have them."""
    if not len(group):
        return {}, None
    plies, cohesive, stages, sizes = (_finite(group[name][()].ravel(), name) for name in (
        "ply_above", "is_cohesive", "stage", "area"))
    bounds = _finite(group["bounds"][()], "bounds", len(plies))
    interfaces = {int(ply): Interface(float(size), bool(law), bool(stage > 1),
                                      (float(x_min), float(x_max), float(y_min), float(y_max)))
                  for ply, law, stage, size, (x_min, x_max, y_min, y_max)
                  in zip(plies, cohesive, stages, sizes, bounds, strict=True)}
    return interfaces, float(_finite(group["projected_area"][()].ravel(), "projected_area", 1)[0])


def deck_in(path: Path) -> Deck | None:
    """Return the deck of the run from its NAME.h5 or history; None if it is not known."""
    fields = path if path.suffix == ".h5" else path.with_name(path.name.removesuffix("_history.csv") + ".h5")
    try:
        with opened(fields) as file:
            return recorded_deck(file["provenance"], fields)
    except ImplamError:
        return None


def struck_point(fields: Fields) -> np.ndarray:
    """Return the struck point, from the centre of the plate; the centre if the deck of the run is not known."""
    deck = deck_in(fields.path)
    at = [] if deck is None else deck.numbers("impactor", "at")
    return np.array(at if len(at) == 2 else [0.0, 0.0])
