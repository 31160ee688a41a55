"""Fields over the plate at chosen times, from NAME.h5: what came apart and what failed, seen in plan."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from implam_post.errors import FileError, ImplamError

MODES = {"fibre failure": 1, "matrix cracking": 2, "matrix crushing": 4}


@dataclass(frozen=True)
class Mesh:
    """Cells in plan: their corners, counter-clockwise (elements, 4, 2), and the plies of each element."""

    corners: np.ndarray
    first_ply: np.ndarray
    last_ply: np.ndarray

    @property
    def interfaces(self) -> list[int]:
        """Plies above the interfaces that may come apart."""
        return [int(ply) - 1 for ply in np.unique(self.first_ply) if ply > 1]

    @property
    def plies(self) -> range:
        """Numbers of the plies."""
        return range(1, int(self.last_ply.max()) + 1)


@dataclass(frozen=True)
class Snapshot:
    """The state of interfaces and plies at one time, by element: flags, and G/G_c ahead of the fronts."""

    time: float
    mesh: Mesh
    delaminated: np.ndarray
    failures: dict[int, np.ndarray]
    release_ratio: np.ndarray

    def delaminated_cells(self, below_ply: int) -> np.ndarray:
        """Return the corners of the cells that came apart below a ply."""
        return self.mesh.corners[self.delaminated & (self.mesh.first_ply == below_ply + 1)]

    def release(self, below_ply: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners of the cells ahead of the front below a ply that release energy, and G/G_c there."""
        loaded = (self.release_ratio > 0) & (self.mesh.first_ply == below_ply + 1)
        return self.mesh.corners[loaded], self.release_ratio[loaded]

    def failed_cells(self, ply: int, mode: int) -> np.ndarray:
        """Return the corners of the cells in which a ply failed in a mode (1 fibres, 2 cracking, 4 crushing)."""
        of_ply = (self.mesh.first_ply <= ply) & (ply <= self.mesh.last_ply)
        return self.mesh.corners[of_ply & (self.failures[ply] & mode > 0)]


# Signs of x and y that put the images of a part of the plate in their places.
IMAGES = {"whole": [(1, 1)], "quarter": [(1, 1), (-1, 1), (-1, -1), (1, -1)], "half_x": [(1, 1), (-1, 1)],
          "half_y": [(1, 1), (1, -1)], "point": [(1, 1), (-1, -1)]}


@dataclass(frozen=True)
class Fields:
    """The times of a run; cells are those of the modelled part of the plate."""

    name: str
    part: str
    snapshots: list[Snapshot]

    @property
    def path(self) -> Path:
        """Path of the file."""
        return Path(self.name)

    def place(self, time: float) -> int:
        """Return the place among the snapshots of the one nearest to a time."""
        stored = np.array([snapshot.time for snapshot in self.snapshots])
        if not stored[0] * (1 - 1e-6) <= time <= stored[-1] * (1 + 1e-6):
            raise ImplamError(f"time {time:g} is outside the fields, which reach from {stored[0]:g} to {stored[-1]:g}.")
        return int(np.argmin(np.abs(stored - time)))

    @property
    def quarter(self) -> bool:
        """Whether a quarter was modelled."""
        return self.part == "quarter"

    def whole(self, cells: np.ndarray) -> np.ndarray:
        """Return the cells of the whole plate: those of the modelled part and their images."""
        return np.concatenate([cells * np.array(signs) for signs in IMAGES[self.part]])

    def times_apart(self, below_ply: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the cells of the whole plate that came apart below a ply, and the first time each is seen so."""
        found: dict[tuple[float, ...], tuple[np.ndarray, float]] = {}
        for snapshot in self.snapshots:
            for cell in snapshot.delaminated_cells(below_ply):
                found.setdefault(tuple(cell.ravel()), (cell, snapshot.time))
        cells = self.whole(np.array([cell for cell, _ in found.values()]).reshape(-1, 4, 2))
        times = np.array([time for _, time in found.values()])
        return cells, np.tile(times, len(IMAGES[self.part]))


def area(cells: np.ndarray) -> float:
    """Return the area of cells in plan."""
    x, y = cells[..., 0], cells[..., 1]
    return float(np.sum(np.abs(np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1), axis=1))) / 2)


def extents(cells: np.ndarray) -> tuple[float, float]:
    """Return the lengths along x and y of the smallest rectangle around cells; 0 if there are none."""
    if not len(cells):
        return 0.0, 0.0
    along, across = np.ptp(cells.reshape(-1, 2), axis=0)
    return float(along), float(across)


def outline(cells: np.ndarray) -> np.ndarray:
    """Return the edges that belong to one of the cells only, (edges, 2 ends, 2)."""
    if not len(cells):
        return np.empty((0, 2, 2))
    edges = np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2, 2)
    # Mirrored corners agree but for rounding: places are told apart to a millionth of the picture.
    places = np.round(edges / np.abs(cells).max() * 1e6).astype(int)
    _, position, count = np.unique(np.sort(places @ [10**8, 1], axis=1), axis=0, return_index=True, return_counts=True)
    return edges[position[count == 1]]


def read_fields(path: Path | str) -> Fields:
    """Read interfaces and plies from the solver's NAME.h5."""
    path = Path(path)
    with opened(path) as file:
        meshes = {number: _mesh(group) for number, group in enumerate(_in_order(file["meshes"]), start=1)}
        snapshots = [_snapshot(group, meshes) for group in _in_order(file["times"])]
        part = file["part"][()].decode()
    if not snapshots:
        raise FileError(f"{path} holds no time yet.")
    if part not in IMAGES:
        raise FileError(f"{path} holds a part of the plate that isn't known here: {part}.")
    return Fields(str(path), part, snapshots)


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file; whatever is wrong with it becomes one sentence."""
    try:
        with h5py.File(path, "r") as file:
            yield file
    except OSError as error:
        raise FileError(f"the fields {path} cannot be read ({error}).") from None
    except (KeyError, IndexError, TypeError, ValueError) as error:
        raise FileError(f"{path} isn't a file of fields written by implam ({error}).") from None


def _in_order(group: h5py.Group) -> list[h5py.Group]:
    """Return the numbered members of a group in their order."""
    return [group[name] for name in sorted(group)]


def _mesh(group: h5py.Group) -> Mesh:
    """Read a mesh; the first four points of an element are its corners."""
    corners = group["coordinates"][()][:, :2][group["connectivity"][()][:, :4]]
    first, last = (group[f"cells/{name}"][()].ravel() for name in ("first_ply", "last_ply"))
    return Mesh(corners, first, last)


def _snapshot(group: h5py.Group, meshes: dict[int, Mesh]) -> Snapshot:
    """Read a time; without interfaces nothing is apart, without ply damage no ply has an entry."""
    mesh, cells = meshes[int(group["mesh"][()])], group.get("cells", {})
    nothing = np.zeros(len(mesh.first_ply))
    delaminated, release_ratio = (cells[name][()].ravel() if name in cells else nothing
                                  for name in ("delaminated_above", "energy_release_above"))
    failures = {ply: cells[f"ply_{ply}_failure"][()].ravel().astype(int) for ply in mesh.plies
                if f"ply_{ply}_failure" in cells}
    return Snapshot(float(group["time"][()]), mesh, delaminated > 0, failures, release_ratio)
