"""History: fields of a run, and of one that was restarted, as h5py and meshio read them, 1e-12.
Usage: fields.py IMPLAM FOLDER"""

import sys
from pathlib import Path

import h5py
import meshio
import numpy as np
from restart import run_split
from solver_runs import checkpoint_of, exit_code_of, read_history, require, run, run_deck, write_deck

SIDE = 8
SETTINGS = [f"mesh%elements={SIDE},{SIDE}", "time%end=60e-6", "output%fields_every=10e-6",
            "output%checkpoint_every=35e-6"]
TIMES = 1e-6 * np.arange(10, 61, 10)


def check_fields(history_path):
    """Fail unless both readers find the mesh and the deflection of the history."""
    base = str(history_path).removesuffix("_history.csv")
    history = read_history(history_path)
    with h5py.File(base + ".h5") as file:
        stored = [file["times"][name]["time"][()] for name in sorted(file["times"])]
        require(np.allclose(stored, TIMES, rtol=1e-12), f"{base}.h5 has the times {stored}.")
        require(file["provenance/deck"][()].decode().startswith("!"), f"{base}.h5 does not contain the deck.")
    with meshio.xdmf.TimeSeriesReader(base + ".xdmf") as reader:
        points, cells = reader.read_points_cells()
        require(points.shape == ((2 * SIDE + 1)**2, 3), f"{base}.xdmf has {len(points)} points.")
        require([(block.type, len(block.data)) for block in cells] == [("quad9", SIDE**2)], "The cells are wrong.")
        centre = np.argmin(np.hypot(points[:, 0], points[:, 1]))
        require(reader.num_steps == len(TIMES), f"{base}.xdmf has {reader.num_steps} times.")
        for number, expected in enumerate(TIMES):
            time, at_points, _ = reader.read_data(number)
            require(abs(time - expected) <= 1e-12 * expected, f"{base}.xdmf: {time} instead of {expected}.")
            require(np.all(np.isfinite(at_points["displacement"])), "A displacement is not finite.")
            deflection = np.interp(time, history["time"], history["deflection"])
            found = at_points["displacement"][centre, 2]
            require(abs(found - deflection) <= 1e-12 * deflection, f"At {time}: {found} instead of {deflection}.")


def check_ended(implam, folder):
    """The fields at the end, requested alone, are written once, also after a restart of the completed run."""
    deck = write_deck(folder, "sun_chen_tan_sun.nml", [*SETTINGS[:2], "output%fields_every=0"])
    base = str(run_deck(implam, deck)).removesuffix("_history.csv")
    run([implam, "restart", checkpoint_of(folder)])
    with h5py.File(base + ".h5") as file:
        stored = [file["times"][name]["time"][()] for name in file["times"]]
    require(len(stored) == 1 and abs(stored[0] - TIMES[-1]) < 1e-12 * TIMES[-1], f"{base}.h5 has the times {stored}.")


def check_moved(implam, folder):
    """A completed run that is restarted in another folder has its last fields there, in both files."""
    deck = write_deck(folder, "sun_chen_tan_sun.nml", SETTINGS[:3])
    name = run_deck(implam, deck).name.removesuffix("_history.csv")
    away = folder / "away"
    said = run([implam, "restart", checkpoint_of(folder), "--output", away])
    require(f"{away}/{name}.xdmf" in said, said)
    with meshio.xdmf.TimeSeriesReader(away / f"{name}.xdmf") as reader:
        reader.read_points_cells()
        times = [reader.read_data(number)[0] for number in range(reader.num_steps)]
    require(len(times) == 1 and abs(times[0] - TIMES[-1]) < 1e-12 * TIMES[-1], f"{name}.xdmf has the times {times}.")


def check_both(implam, folder):
    """Run, restart and read."""
    for history in run_split(implam, folder / "run", "sun_chen_tan_sun.nml", SETTINGS):
        check_fields(history)
    check_ended(implam, folder / "ended")
    check_moved(implam, folder / "moved")
    print(f"{len(TIMES)} times, the deflection of the history in each")


if __name__ == "__main__":
    raise SystemExit(exit_code_of(check_both, sys.argv[1], Path(sys.argv[2])))
