"""One draw of one panel: its decks, its runs, and the figures of their results."""

import csv
import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

# Columns of the rows, in the units of the tables: kN, mm, ms, J, mm2, MPa.
FIGURES = ("peak_force", "displacement", "contact_until", "absorbed", "projected_area", "area_upper", "area_lower",
           "front", "dent", "history_error", "lowest_cracks", "fibre_area", "residual_strength", "failure_code")
# Groups of the first deck that the second one shares.
SHARED = ("material", "laminate", "ply_damage", "delamination", "thermal")


@dataclass(frozen=True)
class Job:
    """One draw: name and table of the panel, variant, energy of a ladder, seed, and digest of the inputs."""

    name: str
    panel: dict
    variant: str
    energy: object
    seed: int
    inputs: str


def decks_of(job, folder):
    """Return the texts of the decks with drawn inputs; the second is None without a compression."""
    from implam_post.io.deck import Deck
    from implam_post.io.deck_text import copy_groups, deck_value, key_path, set_keys
    from implam_post.sweep.samples import draw
    from implam_post.sweep.scatter_plan import Scatter
    changes = job.panel.get("set", {}) | job.panel.get("variants", {}).get(job.variant, {})
    name = job.panel["deck"]
    text = (folder / name).read_text(encoding="utf-8")
    if job.energy != "":
        changes = changes | {"impactor.energy": str(job.energy)}
    first = {key: value for key, value in changes.items() if not key.startswith("then.")}
    text = set_keys(text, {key_path(key): value for key, value in first.items()}, name)
    ranges = [entry for entry in job.panel.get("ranges", []) if not set(entry["keys"]) & set(changes)]
    fixed = {key_path(key) for entry in ranges for key in entry["keys"]}
    stated = Scatter(1, job.seed, "random", {}, {}).inputs(Deck(text, Path(name)))
    fixed = {path: 0.0 for path in fixed if any(str(found.path) == str(path) for found in stated)}
    text, _ = Scatter(1, job.seed, "random", {}, fixed).set(text, name, 0)
    for entry in ranges:
        shape = {"distribution": "uniform", "low": entry["low"], "high": entry["high"]}
        value = deck_value(draw(entry["keys"][0], shape, 1, job.seed, "random")[0])
        text = set_keys(text, {key_path(key): value for key in entry["keys"]}, name)
    if "then" not in job.panel:
        return text, None
    name = job.panel["then"]
    second = copy_groups(text, (folder / name).read_text(encoding="utf-8"), SHARED, name)
    later = {key.removeprefix("then."): value for key, value in changes.items() if key.startswith("then.")}
    return text, set_keys(second, {key_path(key): value for key, value in later.items()}, name)


def execute(implam, folder, name, text):
    """Run a deck in a folder, unless it has been run there; return its processor seconds."""
    folder.mkdir(parents=True, exist_ok=True)
    deck, record = folder / name, folder / f"{name}.seconds"
    if record.exists() and deck.read_text(encoding="utf-8") == text:
        return float(record.read_text(encoding="utf-8"))
    record.unlink(missing_ok=True)
    deck.write_text(text, encoding="utf-8")
    with (folder / f"{name}.out").open("w", encoding="utf-8") as out:
        process = subprocess.Popen([implam, name], cwd=folder, stdout=out, stderr=subprocess.STDOUT,
                                   env=os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"exit code {process.returncode}, see {folder / name}.out")
    seconds = usage.ru_utime + usage.ru_stime
    record.write_text(f"{seconds:.1f}", encoding="utf-8")
    return seconds


def run_job(job, implam, decks, results):
    """Run a job; return its figures, the version of the program, and processor seconds."""
    first, second = decks_of(job, decks)
    impact_only = not any(not key.startswith("then.") for key in job.panel.get("variants", {}).get(job.variant, {}))
    struck = results.resolve() / job.name / ("as_it_is" if impact_only else job.variant.replace(" ", "_")) \
        / f"{job.energy or 'energy'}_seed_{job.seed}"
    seconds = execute(implam, struck, job.panel["deck"], first)
    figures, version = of_impact(struck, job.panel, decks)
    if second is not None:
        pressed = struck / (job.variant.replace(" ", "_") or "compression")
        begun = next(struck.glob("*_restart.h5"))
        pressed.mkdir(exist_ok=True)
        link = pressed / begun.name
        if not link.exists():
            link.symlink_to(begun)
        seconds += execute(implam, pressed, job.panel["then"], second)
        summary = summary_of(pressed)
        figures |= {"residual_strength": f"{summary['residual_strength'] / 1e6:.5g}",
                    "failure_code": summary["failure_code"] or ("" if summary["has_failed"] else "no failure")}
    return figures, version, seconds


def summary_of(folder):
    """Return the summary of the run in a folder."""
    return json.loads(next(folder.glob("*_summary.json")).read_text(encoding="utf-8"))


def of_impact(folder, panel, decks):
    """Return the figures of an impact as texts, and the version of the program."""
    summary = summary_of(folder)
    with next(folder.glob("*_history.csv")).open(encoding="utf-8") as file:
        rows = [{name.strip(): float(value) for name, value in row.items()}
                for row in csv.DictReader(line for line in file if not line.startswith("#"))]
    interfaces, plies = summary["interfaces"], summary["plies"]
    lowest = [ply for ply in plies if all(after["angle"] == ply["angle"] for after in plies[ply["ply"] - 1:])]
    values = {
        "peak_force": summary["peak_force"] / 1e3,
        "displacement": 1e3 * max(row["impactor_displacement"] for row in rows),
        "contact_until": 1e3 * summary["contact_until"],
        "absorbed": summary["energy_absorbed"],
        "projected_area": 1e6 * summary["projected_area"],
        "area_upper": 1e6 * interfaces[0]["area"],
        "area_lower": 1e6 * interfaces[-1]["area"],
        "front": 1e3 * max([abs(x) for x in interfaces[-1]["x"] or []], default=0.0),
        "dent": 1e3 * summary["dent_depth"],
        "lowest_cracks": 1e6 * max(ply["matrix_crack_area"] for ply in lowest),
        "fibre_area": 1e6 * max(ply["fibre_failure_area"] for ply in plies),
    }
    if "history" in panel:
        values["history_error"] = 100 * error_of_history(rows, decks / panel["history"])
    provenance = summary["provenance"]
    return ({name: f"{value:.5g}" for name, value in values.items() if value is not None},
            provenance.get("commit") or provenance["version"])


def error_of_history(rows, path):
    """Return the relative L2 difference of the force from a measured one over the measured time."""
    import numpy as np
    times, forces = np.genfromtxt((line for line in path.open(encoding="utf-8") if not line.startswith("#")),
                                  delimiter=",", skip_header=1, unpack=True)
    every = np.linspace(times[0], times[-1], 1001)
    wanted = np.interp(every, times, forces)
    found = np.interp(every, [row["time"] for row in rows], [row["force"] for row in rows], right=0.0)
    return float(np.linalg.norm(found - wanted) / np.linalg.norm(wanted))
