#!/usr/bin/env python3
"""Measured panels of four materials: runs with drawn inputs, and the page doc/validation.md from their results.

panels.py run IMPLAM [--panel NAME ...] [--variant NAME ...] [--seeds 1-10] [--jobs N] [--again]
           [--folder results/panels]
panels.py table [--panel NAME ...]      measured and computed values, one table a panel
panels.py page [--check]                writes doc/validation.md, or compares it with what would be written

Panels, with what was measured, are in panels/panels.toml. A job is one draw of one panel: its impact, and where the
panel has one the compression of the struck plate. Inputs are drawn within their usual tolerances
(doc/manual/scatter.md), those of a range uniformly within it; the seed decides. A completed job is a row of
panels/rows.csv, and is not repeated as long as decks and inputs are the same, so that the command can be stopped at
any time and continued; --again repeats jobs of another version of the program. The last row of a job counts. Rows of
earlier decks are kept; the page shows the last ones, and says so, until there are rows of the present decks. The
impact is not repeated for a variant that changes the compression only."""

import argparse
import csv
import hashlib
import os
import re
import subprocess
import sys
import threading
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "panels"))
from jobs import FIGURES, Job, run_job
from result_rows import append_row
from tables import page_of, panel_lines

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
DECKS, DATA, PAGE = ROOT / "input" / "experiments", HERE / "panels", ROOT / "doc" / "validation.md"
BASE_OF = ("panel", "energy", "seed", "version")
IDENTITY = ("panel", "variant", "energy", "seed", "inputs", "version", "minutes")


def read_panels():
    """Return the panels by name."""
    return tomllib.loads((DATA / "panels.toml").read_text(encoding="utf-8"))["panels"]


def digest(panel, variant):
    """Return a digest of the decks of a panel without comments, and of what is changed in them."""
    text = [re.sub(r"[ \t]*(!.*)?$", "", (DECKS / panel[key]).read_text(encoding="utf-8"), flags=re.MULTILINE)
            for key in ("deck", "then") if key in panel]
    changes = {key: panel.get(key) for key in ("set", "ranges")} | {"variant": panel.get("variants", {}).get(variant)}
    return hashlib.sha256(f"{text} {changes}".encode()).hexdigest()[:10]


def read_rows():
    """Return the rows of completed jobs."""
    path = DATA / "rows.csv"
    if not path.exists():
        return []
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def usable(rows, panels):
    """Return the rows of the present decks; of a panel without any the last ones, with the mark `earlier`.

    A row of a variant has that of the deck as it is by the same version of the program as `base`, where there is one.
    """
    found = []
    bases = {tuple(row[key] for key in BASE_OF): row for row in rows if not row["variant"]}
    for name, panel in panels.items():
        for variant in ("", *panel.get("variants", {})):
            own = list({tuple(row[key] for key in IDENTITY[:5]): row for row in rows
                        if (row["panel"], row["variant"]) == (name, variant)}.values())
            present = [row for row in own if row["inputs"] == digest(panel, variant)]
            found += present or [row | {"earlier": "yes"} for row in own if row["inputs"] == own[-1]["inputs"]]
    return [row | {"base": bases.get(tuple(row[key] for key in BASE_OF))} if row["variant"] else row for row in found]


def seeds_of(text):
    """Return the seeds of 3 or 1-10."""
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def version_of(implam):
    """Return the commit of the program."""
    words = subprocess.run([implam, "--version"], capture_output=True, text=True, check=True).stdout
    return re.search(r"\(([^)]*)\)", words)[1]


def jobs_of(options, panels):
    """Return the jobs that have no row, panel by panel within a seed, so that all panels have results early."""
    version = version_of(options.implam) if options.again else None
    done = {tuple(row[name] for name in IDENTITY[:5]) for row in read_rows() if version in (None, row["version"])}
    jobs = []
    for seed in options.seeds:
        for name in options.panel or panels:
            panel = panels[name]
            for variant in options.variant or [""]:
                if variant and variant not in panel.get("variants", {}):
                    continue
                for energy in panel.get("energies", [""]):
                    inputs = digest(panel, variant)
                    if (name, variant, str(energy), str(seed), inputs) not in done:
                        jobs.append(Job(name, panel, variant, energy, seed, inputs))
    return jobs


def run(options):
    """Run the jobs; return 1 if one has failed."""
    panels = read_panels()
    jobs, lock, failed = jobs_of(options, panels), threading.Lock(), []
    hours = sum(job.panel["minutes"] for job in jobs) / 60
    print(f"{len(jobs)} jobs, about {hours:.1f} hours of one core, {hours / options.jobs:.1f} hours of "
          f"{options.jobs}", flush=True)

    def work(job):
        label = f"{job.name} {job.variant} {job.energy} seed {job.seed}"
        try:
            figures, version, seconds = run_job(job, options.implam, DECKS, options.folder)
        except (OSError, RuntimeError) as error:
            failed.append(label)
            print(f"{label}: {error}", file=sys.stderr, flush=True)
            return
        with lock:
            identity = (job.name, job.variant, job.energy, job.seed, job.inputs, version, f"{seconds / 60:.2f}")
            append_row(DATA / "rows.csv", (*IDENTITY, *FIGURES), dict(zip(IDENTITY, identity, strict=True)) | figures)
        print(f"{label}: {seconds / 60:.1f} min", flush=True)

    with ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(work, jobs))
    return int(bool(failed))


def main():
    """Run jobs, print tables or write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    runner = commands.add_parser("run")
    runner.add_argument("implam", type=lambda word: str(Path(word).resolve()))
    runner.add_argument("--variant", action="append")
    runner.add_argument("--seeds", type=seeds_of, default=range(1, 11))
    runner.add_argument("--jobs", type=int, default=os.cpu_count())
    runner.add_argument("--again", action="store_true")
    runner.add_argument("--folder", type=Path, default=Path("results/panels"))
    table = commands.add_parser("table")
    for command in (runner, table):
        command.add_argument("--panel", action="extend", nargs="+", choices=list(read_panels()))
    commands.add_parser("page").add_argument("--check", action="store_true")
    options = parser.parse_args()
    if options.command == "run":
        return run(options)
    panels = read_panels()
    rows = usable(read_rows(), panels)
    if options.command == "table":
        for name in options.panel or panels:
            print("\n".join(["", panels[name]["title"], *panel_lines(name, panels[name], rows)]))
        return 0
    text = page_of((DATA / "validation.page").read_text(encoding="utf-8"), panels, rows)
    if not options.check:
        PAGE.write_text(text, encoding="utf-8")
        return 0
    if PAGE.read_text(encoding="utf-8") != text:
        print(f"{PAGE} is not the output of {Path(__file__).name} page.", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
