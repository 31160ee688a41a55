#!/usr/bin/env python3
"""Random impacts with cohesive interfaces that delaminate; each is run in several variants with equal results.
Usage: damaging_models.py IMPLAM [COUNT] [FIRST] [LEFT_OUT]     (variants left out, such as two_ranks,three_ranks)

Each model is run unchanged, and then on two and three ranks, in other units (mm-t-s), rotated by 90 degrees, mirrored,
stopped and restarted, and with G_c larger by 1e-12. Differences of this perturbed run are those of round-off. A model
passes if the run ends with exit code 0, or with 3 and a message; if the dissipated energy is G_c times the delaminated
area to 1e-6; if it takes less than a minute of processor time; and if all variants give the same failed points of the
interfaces, the same failed plies of each element and the same delaminated area. Differences of the area are printed."""

import csv
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

LAYUPS = ((0, 90, 0), (90, 0, 90), (0, 90, 90, 0), (0, 45, 90, -45, -45, 90, 45, 0), (45, -45, -45, 45),
          (30, -30, 90, -30, 30), (0, 60, -60, -60, 60, 0))
EXIT_DONE, EXIT_CONVERGENCE, EXIT_STOPPED = 0, 3, 75
AREA, ENERGY = "delaminated_area", "energy_delamination"
SAME_AREA = 1e-6  # of the area; it includes points of partial damage
MINUTE = 60  # processor seconds
os.environ |= {"OMP_NUM_THREADS": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_hwloc_base_binding_policy": "none",
               "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
               "PRTE_MCA_hwloc_default_binding_policy": "none"}


def model(seed):
    """Return the choices that make a model, in SI."""
    chance = random.Random(seed)
    layup = chance.choice(LAYUPS)
    thickness = chance.uniform(1e-3, 3e-3)
    cell = chance.uniform(1.5e-3, 2.5e-3)
    core = 2 * chance.randint(4, 6), 2 * chance.randint(4, 6)
    interfaces = sorted(chance.sample([i for i in range(1, len(layup)) if layup[i - 1] != layup[i]],
                                      k=min(chance.choice([1, 1, 2, 3]), len(layup) - 1 - sum(
                                          layup[i - 1] == layup[i] for i in range(1, len(layup))))))
    return {"layup": layup, "thickness": thickness, "cell": cell, "interfaces": interfaces,
            "length": (chance.uniform(0.04, 0.1), chance.uniform(0.04, 0.1)),
            "edges": (chance.choice(["clamped", "simple"]),) * 2 + (chance.choice(["clamped", "simple", "free"]),) * 2,
            "elements": [number + 6 for number in core], "zone": [cell * number for number in core],
            "patch": 2 * cell * chance.choice([0.5, 1]), "mass": 10**chance.uniform(-1.5, 0.3),
            "energy": chance.uniform(0.8, 3) * (thickness / 1e-3)**1.5, "radius": chance.uniform(5e-3, 12e-3),
            "G_c": chance.uniform(200, 900), "YT": chance.uniform(20e6, 60e6), "S12": chance.uniform(40e6, 110e6),
            "starter": cell * 4 if chance.random() < 0.3 else 0, "friction": chance.choice([0, 0, 0.3]),
            "plies": chance.choice(["", "", "hashin", "puck"]), "kinematics": chance.choice(["von_karman", "linear"]),
            "law": chance.choice(["tan_sun", "hertz"]),
            "contact": chance.choice(["augmented_lagrangian"] * 3 + ["none"]),
            "thermal": chance.random() < 0.2,
            "steps": chance.randint(60, 120)}


def deck(s, turned=False, mirrored=False, scale=(1, 1, 1)):
    """Return its deck; `scale` has the units of length, mass and time in which it is written, relative to SI."""
    length, mass, _ = scale
    stress, toughness = mass / length, mass  # the unit of time is the second
    x, y = (1, 0) if turned else (0, 1)
    edges = s["edges"][2:] + s["edges"][:2] if turned else s["edges"]
    angles = [angle + 90 if turned else -angle if mirrored else angle for angle in s["layup"]]
    end = min(max(3.2 * (s["mass"] / (4e6 * s["thickness"] / 2e-3))**0.5, 480e-6), 3e-3)
    plies = f"&ply_damage criteria='{s['plies']}' /" if s["plies"] else ""
    starter = f"starter={s['starter'] * length}" if s["starter"] else ""
    groups = "\n".join(f"&delamination below_ply={below} G_c={s['G_c'] * toughness} law='cohesive' {starter} "
                       f"zone={s['zone'][x] * length},{s['zone'][y] * length} contact='{s['contact']}' "
                       f"friction={s['friction']} /" for below in s["interfaces"])
    return f"""&case name='model' kinematics='{s["kinematics"]}' /
&plate length={s["length"][x] * length},{s["length"][y] * length} edges={",".join(f"'{edge}'" for edge in edges)} /
&mesh elements={s["elements"][x]},{s["elements"][y]} patch={s["patch"] * length} cell={s["cell"] * length}
  core={s["zone"][x] * length},{s["zone"][y] * length} /
&material name='ply' density={1600 * mass / length**3} E1={130e9 * stress} E2={7.7e9 * stress} G12={4.8e9 * stress}
  G23={3.8e9 * stress} nu12=0.30 alpha1=-0.3e-6 alpha2=28e-6 XT={2080e6 * stress} XC={1250e6 * stress}
  YT={s["YT"] * stress} YC={290e6 * stress} S12={s["S12"] * stress} G_ft={130e3 * toughness} G_fc={60e3 * toughness}
  G_mt={400 * toughness} G_mc={1500 * toughness} /
&laminate materials='ply' angles={",".join(map(str, angles))} thicknesses={s["thickness"] / len(angles) * length} /
&impactor mass={s["mass"] * mass} velocity={(2 * s["energy"] / s["mass"])**0.5 * length} radius={s["radius"] * length} /
&indentation law='{s["law"]}' {f"alpha_cr={80.3e-6 * length}" if s["law"] == "tan_sun" else ""} /
{plies}
{"&thermal delta_T=-100 /" if s["thermal"] else ""}
{groups}
&solver tolerance=1e-9 /
&time end={end} step={end / s["steps"]} integrator='generalized_alpha' /
&output fields_every={end} /
"""


def ended(command, stop_after=None):
    """Run a command, stopped after some seconds; return exit code, last line and processor time."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True)
    if stop_after:
        time.sleep(stop_after)
        process.send_signal(signal.SIGUSR1)
    said = process.communicate(timeout=1800)[0]
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return process.returncode, (said.splitlines() or [""])[-1], after.ru_utime - before.ru_utime


def row_of(folder, number):
    """Return a row of the history."""
    with (folder / "model_history.csv").open(encoding="utf-8") as file:
        return {name: float(value) for name, value in list(csv.DictReader(file))[number].items()}


def names_of(points):
    """Return the positions of points in whole nanometres."""
    return [tuple(point) for point in np.round(1e9 * points).astype(int).tolist()]


def damage_of(folder, place, unit):
    """Return the points separated and the plies failed at the end, by position: `place` maps x and y to the unchanged
    model, `unit` is the unit of length."""
    with h5py.File(folder / "model.h5") as file:
        last = file["times"][max(file["times"])]
        mesh = file["meshes"][max(file["meshes"])]
        points = mesh["coordinates"][:] / unit
        points = np.column_stack((*place(points[:, 0], points[:, 1]), points[:, 2]))
        middles = names_of(points[mesh["connectivity"][:]].mean(axis=1))
        separated = set(names_of(points[last["points/damage_above"][:] > 1 - 1e-9]))
        failed = {(name, value, middle) for name, values in last["cells"].items() if name.endswith("_failure")
                  for value, middle in zip(values[:], middles, strict=True) if value}
    return separated, failed


def run_in(folder, text, implam, launcher=(), stop_after=None):
    """Run a deck; return exit code, last line, processor time and the last row of the history, if there is one."""
    folder.mkdir()
    (folder / "model.nml").write_text(text, encoding="utf-8")
    code, said, seconds = ended([*launcher, implam, folder / "model.nml", "--output", folder, "--profile"], stop_after)
    if stop_after and code == EXIT_STOPPED:
        code, said, _ = ended([implam, "restart", folder])
    return code, said, seconds, row_of(folder, -1) if (folder / "model_history.csv").exists() else None


def ways(s, seconds, implam, folder, left_out):
    """Yield each variant of a model: its name, exit code, last row, and the map and unit of its positions."""
    # Several ranks share the cores; a single rank that yields would wait for other processes.
    mpirun = ("env", "OMPI_MCA_mpi_yield_when_idle=1", "mpirun", "--allow-run-as-root", "-n")
    changed = s | {"G_c": s["G_c"] * (1 + 1e-12)}
    for name, options, keywords, place in (
            ("perturbed", {"s": changed}, {}, as_it_is), ("two_ranks", {}, {"launcher": (*mpirun, "2")}, as_it_is),
            ("three_ranks", {}, {"launcher": (*mpirun, "3")}, as_it_is),
            ("units", {"scale": (1e3, 1e-3, 1)}, {}, as_it_is), ("turned", {"turned": True}, {}, lambda x, y: (y, -x)),
            ("mirrored", {"mirrored": True}, {}, lambda x, y: (x, -y)),
            ("stopped", {}, {"stop_after": 0.3 + 0.4 * seconds}, as_it_is)):
        if name not in left_out:
            code, _, _, row = run_in(folder / name, deck(**({"s": s} | options)), implam, **keywords)
            yield name, code, row, place, options.get("scale", (1,))[0]


def as_it_is(x, y):
    """Return a position of the unchanged model."""
    return x, y


def faults_of(seed, implam, folder, left_out):
    """Run all variants of a model; return its report and its faults."""
    s = model(seed)
    code, said, seconds, row = run_in(folder / "plain", deck(s), implam)
    if code == EXIT_CONVERGENCE and said:
        return f"ends with 3: {said}", []
    if code != EXIT_DONE:
        return "", [f"ends with {code}: {said}"]
    starter = row_of(folder / "plain", 0)[AREA] if s["starter"] else 0
    cost = s["G_c"] * (row[AREA] - starter)
    separated, failed = damage_of(folder / "plain", as_it_is, 1)
    faults = [f"dissipates {row[ENERGY]}, not {cost}"] if abs(row[ENERGY] - cost) > 1e-6 * max(cost, 1e-12) else []
    if seconds > MINUTE:
        faults.append(f"takes {seconds:.0f} s")
    apart = 0
    for name, other, end, place, unit in ways(s, seconds, implam, folder, left_out):
        if other != EXIT_DONE:
            faults.append(f"{name}: ends with {other}")
            continue
        apart = max(apart, abs(end[AREA] / unit**2 - row[AREA]) / max(row[AREA], 1e-6))
        here = damage_of(folder / name, place, unit)
        if here[0] != separated:
            faults.append(f"{name}: {len(here[0] ^ separated)} points separated in one only")
        if here[1] != failed:
            faults.append(f"{name}: {len(here[1] ^ failed)} plies of elements fail in one only")
    if apart > SAME_AREA:
        faults.append("areas differ")
    return (f"area {1e6 * row[AREA]:.1f} mm2, {len(s['interfaces'])} interface(s), {len(separated)} points separated, "
            f"{len(failed)} plies failed, {row['step']:.0f} steps, {row['total_iterations']:.0f} iterations, "
            f"{seconds:.1f} s; areas {apart:.0e} apart"), faults


def main(implam, count="40", first="1", left_out=""):
    """Print a line per model, and the number that pass."""
    passed = 0
    for seed in range(int(first), int(first) + int(count)):
        with tempfile.TemporaryDirectory() as folder:
            printed, faults = faults_of(seed, Path(implam).absolute(), Path(folder), left_out.split(","))
        passed += not faults
        print(f"{seed}: {'; '.join([printed, *faults])}", flush=True)
    print(f"{passed} of {count} models pass.")


if __name__ == "__main__":
    if len(sys.argv) < 2 or "--help" in sys.argv:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
