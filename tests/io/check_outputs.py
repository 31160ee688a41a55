"""Opens the field files with h5py, meshio and, where it is installed, VTK (ParaView's reader), and kills
runs that write checkpoints.
Usage: check_outputs.py WRITE_SAMPLES RANKS LAUNCHER... (the launcher may be empty for one rank)"""

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

import h5py
import meshio
import numpy as np

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    vtk_is_installed = True
except ImportError:
    vtk_is_installed = False

ACROSS, ALONG, LAYERS = 6, 4, 2
POINTS = (2 * ACROSS + 1) * (2 * ALONG + 1) * LAYERS
CELLS = ACROSS * ALONG * LAYERS
TIMES = [0.0, 1.0, 1.5]
KILLS = 6


def check_h5(folder):
    with h5py.File(folder / "sample.h5") as file:
        assert file["provenance/citation"][()].decode().startswith("The Implam developers"), "no citation"
        assert file["provenance/deck"][()].decode().startswith("&case"), "the deck is not in the file"
        assert file["part"][()].decode() == "quarter"
        assert len(file["restarts"]) == 1
        assert [file["times"][name]["time"][()] for name in sorted(file["times"])] == TIMES
        assert [file["times"][name]["step"][()] for name in sorted(file["times"])] == [0, 1, 2]
        for group in file["times"].values():
            assert described(group["points"]) == {"displacement": ("length", "Displacement."),
                                                  "gap": ("length", "Product of x and y.")}
            meaning = "Number of the element, growing with time."
            assert described(group["cells"]) == dict.fromkeys(STRESSES, ("pressure", meaning))
        for mesh in file["meshes"].values():
            assert described(mesh["cells"]) == {"layer": ("-", "Number of the layer.")}


def described(group):
    return {name: tuple(field.attrs[what].decode() for what in ("unit", "meaning")) for name, field in group.items()}


STRESSES = [f"stress_{i}" for i in range(1, 7)]


def check_values(points, connectivity, time_now, displacement, gap, layer, *stress):
    x, y, z = points.T
    assert points.shape == (POINTS, 3) and connectivity.shape == (CELLS, 9)
    assert np.array_equal(displacement, np.column_stack([x, 2 * y, time_now + z]))
    assert np.array_equal(gap, x * y)
    assert np.array_equal(np.column_stack(stress), np.arange(1, CELLS + 1)[:, None] + time_now * np.arange(1, 7))
    assert np.array_equal(layer, np.repeat([1, 2], CELLS // 2))
    corners = points[connectivity[:, :4], :2]
    following = np.roll(corners, -1, axis=1)
    areas = 0.5 * np.sum(corners[..., 0] * following[..., 1] - corners[..., 1] * following[..., 0], axis=1)
    assert np.allclose(areas, 1), "corners are not in order"
    assert np.allclose(points[connectivity[:, 4:8], :2], (corners + following) / 2), "middles are not on their sides"
    assert np.allclose(points[connectivity[:, 8], :2], corners.mean(axis=1))


def check_meshio(folder):
    with meshio.xdmf.TimeSeriesReader(folder / "sample.xdmf") as reader:
        points, cells = reader.read_points_cells()
        assert reader.num_steps == len(TIMES) and cells[0].type == "quad9"
        for k, expected in enumerate(TIMES):
            now, at_points, in_cells = reader.read_data(k)
            assert now == expected
            check_values(points, cells[0].data, now, at_points["displacement"], at_points["gap"],
                         *(in_cells[name][0] for name in ["layer", *STRESSES]))


def check_vtk(folder):
    reader = vtkXdmfReader()
    reader.SetFileName(str(folder / "sample.xdmf"))
    for now in TIMES:
        reader.UpdateInformation()
        reader.UpdateTimeStep(now)
        grid = reader.GetOutputDataObject(0)
        while grid.IsA("vtkMultiBlockDataSet"):
            grid = grid.GetBlock(0)
        assert grid.GetCellType(0) == 28, "not a biquadratic quadrilateral"
        at_points, in_cells = grid.GetPointData(), grid.GetCellData()
        connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 9)
        check_values(vtk_to_numpy(grid.GetPoints().GetData()), connectivity, now,
                     *(vtk_to_numpy(at_points.GetArray(name)) for name in ("displacement", "gap")),
                     *(vtk_to_numpy(in_cells.GetArray(name)) for name in ("layer", *STRESSES)))


def check_checkpoint(path):
    """The check value is right, and the items of the file are of one time."""
    content = path.read_bytes()
    seal = content[:512].decode().split("\n")
    assert seal[:2] == ["IMPLAM CHECKPOINT", "format 5"]
    assert seal[2:4] == [f"bytes {len(content) - 512}", f"crc32 {zlib.crc32(content[512:]):08X}"]
    with h5py.File(path) as file:
        number = file["state/n"][()]
        assert np.all(file["state/numbers"][()] == number)
    return number


def processes_of(session):
    """Running processes of a session: the launcher and its ranks."""
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, its_session = status.read_text().rpartition(")")[2].split()[:4]
        except OSError:  # it has ended
            continue
        if int(its_session) == session and state != "Z":
            found.append(int(status.parent.name))
    return found


def kill_session(run):
    while running := processes_of(run.pid):
        for process in running:
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        time.sleep(0.01)
    run.wait()


def check_kills(command, folder):
    """Whenever the run is killed, the checkpoint is complete."""
    path = folder / "sample_restart.h5"
    for k in range(KILLS):
        path.unlink(missing_ok=True)
        run = subprocess.Popen([*command, "checkpoints", str(folder)], start_new_session=True,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while not path.exists() and run.poll() is None and time.monotonic() < deadline:
            time.sleep(0.005)
        written = path.exists()
        time.sleep(0.05 + 0.0137 * k)
        kill_session(run)
        assert written, "no checkpoint was written"
        check_checkpoint(path)


def main():
    program, ranks, *launcher = sys.argv[1:]
    command = [*launcher, program]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([*command, "fields", name], check=True)
        check_h5(folder)
        check_meshio(folder)
        if vtk_is_installed:
            check_vtk(folder)
        else:
            print("VTK is not installed, its reader was not tested")
        check_kills(command, folder)
    print(f"outputs are right on {ranks} rank(s)")


if __name__ == "__main__":
    main()
