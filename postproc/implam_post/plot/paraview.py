"""Files for ParaView in addition to NAME.xdmf (`implam-paraview NAME.h5`): the moving impactor as a sphere, the
projected damage, and a state file that opens both with the plate."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import h5py
import numpy as np

from implam_post.io.errors import EXIT_DONE, CommandParser, FileError, run
from implam_post.io.fields import MODES, Fields, Snapshot, deck_in, read_fields
from implam_post.io.files import write_text
from implam_post.io.history import History
from implam_post.io.new_hdf5 import new_hdf5
from implam_post.io.run import open_run
from implam_post.io.shapes import heights_of
from implam_post.laminate.decks import plies_of

_ROUND, _RINGS = 48, 24
# By cell in plan: number of delaminated interfaces, the first of them, fraction of plies with a failure, and by mode.
_FIELDS = ("delaminated_interfaces", "first_delaminated_below_ply", "share_of_plies_failed", "share_of_plies_cracked",
           "share_of_plies_with_fibre_failure")


def sphere(radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Return points (points, 3) and triangles (triangles, 3) of a sphere about the origin."""
    polar, around = np.linspace(0, np.pi, _RINGS + 1), np.linspace(0, 2 * np.pi, _ROUND, endpoint=False)
    polar, around = np.meshgrid(polar, around, indexing="ij")
    points = radius * np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=-1)
    ring, place = np.meshgrid(np.arange(_RINGS), np.arange(_ROUND), indexing="ij")
    corner = ring * _ROUND + place
    beside = ring * _ROUND + (place + 1) % _ROUND
    lower, upper = (np.stack(three, axis=-1).reshape(-1, 3) for three in (
        (corner, corner + _ROUND, beside + _ROUND), (corner, beside + _ROUND, beside)))
    return points.reshape(-1, 3), np.concatenate([lower, upper])


def plan_of(snapshot: Snapshot) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return the cells in plan, (cells, 4, 2), and the damage through the thickness of each."""
    mesh = snapshot.mesh
    scale = np.abs(mesh.corners).max() or 1.0
    middles = np.round(mesh.corners.mean(axis=1) / scale * 1e7).astype(np.int64)
    _, first, place = np.unique(middles, axis=0, return_index=True, return_inverse=True)
    place = place.ravel()
    delaminated, top = np.zeros(len(first)), np.full(len(first), np.inf)
    np.add.at(delaminated, place, snapshot.delaminated)
    np.minimum.at(top, place[snapshot.delaminated], mesh.first_ply[snapshot.delaminated] - 1.0)
    failed = {name: np.zeros(len(first)) for name in ("any", *MODES)}
    for ply, flags in snapshot.failures.items():
        of_ply = (mesh.first_ply <= ply) & (ply <= mesh.last_ply)
        np.add.at(failed["any"], place[of_ply], flags[of_ply] > 0)
        for name, mode in MODES.items():
            np.add.at(failed[name], place[of_ply], flags[of_ply] & mode > 0)
    plies = len(mesh.plies)
    values = (delaminated, np.where(np.isfinite(top), top, -1),
              *(failed[name] / plies for name in ("any", "matrix cracking", "fibre failure")))
    return mesh.corners[first], dict(zip(_FIELDS, values, strict=True))


def write_files(fields: Fields, history: History | None, base: Path) -> list[Path]:
    """Write BASE_paraview.h5, BASE_through.xdmf, BASE_impactor.xdmf (if any), BASE_paraview.py; return paths."""
    deck = deck_in(fields.path)
    if deck is None:
        raise FileError(f"{fields.path} has no deck, which is needed for radius and thickness.")
    thickness = sum(ply.thickness for ply in plies_of(deck))
    radius = deck.number("impactor", "radius", 0.0) if deck.has("impactor") else 0.0
    data = base.with_name(f"{base.name}_paraview.h5")
    grids: dict[str, list[str]] = {"through": []}
    with new_hdf5(data) as file:
        for number, snapshot in enumerate(fields.snapshots, start=1):
            grids["through"].append(_write_plan(file, f"{number:08d}", fields, snapshot, thickness / 2))
        if radius > 0 and history is not None:
            at = deck.numbers("impactor", "at") or [0.0, 0.0]
            start = np.array([*at, heights_of(deck, np.array(at)) - thickness / 2 - radius])
            grids["impactor"] = _write_sphere(file, fields, history, radius, start)
    paths = [data]
    for name, of_times in grids.items():
        paths.append(base.with_name(f"{base.name}_{name}.xdmf"))
        times = "".join(f'<Grid Name="{name}"><Time Value="{snapshot.time!r}"/>\n{grid}</Grid>\n'
                        for snapshot, grid in zip(fields.snapshots, of_times, strict=True))
        write_text(paths[-1], '<?xml version="1.0"?>\n<Xdmf Version="3.0"><Domain>\n<Grid Name="times" '
                   f'GridType="Collection" CollectionType="Temporal">\n{times}</Grid>\n</Domain></Xdmf>\n')
    paths.append(base.with_name(f"{base.name}_paraview.py"))
    write_text(paths[-1], _state(base, max(deck.lengths()), bool(fields.snapshots[-1].mesh.interfaces),
                                 "impactor" in grids))
    return paths


def _write_plan(file: h5py.File, name: str, fields: Fields, snapshot: Snapshot, depth: float) -> str:
    """Write the damage through the thickness of the full plate at a time, on its back face; return the XDMF of it."""
    cells, values = plan_of(snapshot)
    cells_of_plate = fields.full_plate(cells)
    count = len(cells_of_plate)
    corners = cells_of_plate.reshape(-1, 2)
    file[f"{name}/points"] = np.column_stack([corners, heights_of(deck_in(fields.path), corners) + depth])
    file[f"{name}/cells"] = np.arange(4 * count).reshape(-1, 4)
    for field, value in values.items():
        file[f"{name}/{field}"] = np.tile(value, count // len(cells))
    attributes = "".join(f'<Attribute Name="{field}" Center="Cell">{_item(file, f"{name}/{field}")}</Attribute>\n'
                         for field in _FIELDS)
    return _shape(file, "Quadrilateral", f"{name}/cells", f"{name}/points") + attributes


def _write_sphere(file: h5py.File, fields: Fields, history: History, radius: float, start: np.ndarray) -> list[str]:
    """Write the impactor at every time, starting at first contact; return the XDMF of each."""
    sphere_points, file["triangles"] = sphere(radius)
    depths = np.interp([snapshot.time for snapshot in fields.snapshots], history.time,
                       history["impactor_displacement"])
    for number, depth in enumerate(depths, start=1):
        file[f"{number:08d}/sphere"] = sphere_points + start + np.array([0, 0, depth])
    return [_shape(file, "Triangle", "triangles", f"{number:08d}/sphere") for number in range(1, len(depths) + 1)]


def _item(file: h5py.File, path: str) -> str:
    """Return a DataItem of XDMF."""
    data = file[path]
    shape = " ".join(map(str, data.shape))
    kind = "Float" if data.dtype.kind == "f" else "Int"
    return (f'<DataItem Format="HDF" NumberType="{kind}" Precision="8" Dimensions="{shape}">'
            f"{Path(file.filename).name}:/{path}</DataItem>")


def _shape(file: h5py.File, kind: str, cells: str, points: str) -> str:
    """Return topology and geometry of XDMF."""
    return (f'<Topology TopologyType="{kind}" NumberOfElements="{len(file[cells])}">{_item(file, cells)}</Topology>\n'
            f'<Geometry GeometryType="XYZ">{_item(file, points)}</Geometry>\n')


def _state(base: Path, length: float, may_delaminate: bool, moves: bool) -> str:
    """Return the state file: plate, coloured by delaminations, damage through the thickness, and impactor."""
    script = f'''# State of ParaView: File > Load State, or paraview --script={base.name}_paraview.py
# z points in the direction of impact; the camera shows the struck face on top.
import os

from paraview.simple import *

folder = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else {str(base.parent.absolute())!r}


def opened(name):
    """Read a file in the folder of this one."""
    reader = XDMFReader(registrationName=name, FileNames=[os.path.join(folder, name + ".xdmf")])
    reader.UpdatePipeline()
    return reader


view = GetActiveViewOrCreate("RenderView")
# The modelled part of the plate: layers at their z, with displacements.
plate = opened("{base.name}")
moved = WarpByVector(registrationName="moved plate", Input=plate)
moved.Vectors = ["POINTS", "displacement"]
plate_shown = Show(moved, view)
plate_shown.Representation = "Surface With Edges"
# The full plate below it: damage seen through the thickness.
lowered = Transform(registrationName="damage through the thickness", Input=opened("{base.name}_through"))
lowered.Transform.Translate = [0.0, 0.0, {0.2 * length!r}]
through_shown = Show(lowered, view)
ColorBy(through_shown, ("CELLS", "{"delaminated_interfaces" if may_delaminate else "share_of_plies_failed"}"))
through_shown.RescaleTransferFunctionToDataRangeOverTime()
through_shown.SetScalarBarVisibility(view, True)
'''
    if may_delaminate:
        script += '''ColorBy(plate_shown, ("CELLS", "delaminated_above"))
plate_shown.RescaleTransferFunctionToDataRangeOverTime()
plate_shown.SetScalarBarVisibility(view, True)
'''
    if moves:
        script += f'''sphere_points_shown = Show(opened("{base.name}_impactor"), view)
sphere_points_shown.DiffuseColor = [0.7, 0.7, 0.7]
'''
    return script + f'''view.CameraPosition = [{1.2 * length!r}, {1.6 * length!r}, {-0.9 * length!r}]
view.CameraFocalPoint = [0.0, 0.0, {0.05 * length!r}]
view.CameraViewUp = [0.0, 0.0, -1.0]
animation = GetAnimationScene()
animation.UpdateAnimationUsingDataTimeSteps()
animation.GoToLast()
Render(view)
'''


def _command(options: argparse.Namespace) -> int:
    """Write the files and print their paths."""
    fields = read_fields(options.fields)
    print(*write_files(fields, open_run(options.fields).columns, options.fields.with_suffix("")), sep="\n")
    return EXIT_DONE


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = CommandParser("implam-paraview", description="Write files for ParaView to the folder of NAME.h5: moving "
                           "impactor as a sphere (NAME_impactor.xdmf), projected damage on the full plate "
                           "(NAME_through.xdmf), and NAME_paraview.py, a state file that opens both with the plate. "
                           "z points in the direction of impact.")
    parser.add_argument("fields", type=Path, metavar="NAME.h5")
    return run(_command, parser, arguments)


if __name__ == "__main__":
    raise SystemExit(main())
