"""Profile of a run: its parts add up to the run, with the calls of the run, and only with --profile.
profile.py IMPLAM DECK"""

import json
import pathlib
import sys
import tempfile

from solver_runs import run


def main():
    """Run a deck with and without --profile."""
    implam, deck = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run([implam, deck, "--output", folder])
        summary = json.loads(next(folder.glob("*_summary.json")).read_text())
        assert "profile" not in summary, "a profile that was not requested"
        assert "Profile:" not in next(folder.glob("*.log")).read_text(), "a profile in the log that was not requested"
        run([implam, deck, "--profile", "--output", folder])
        summary = json.loads(next(folder.glob("*_summary.json")).read_text())
        log = next(folder.glob("*.log")).read_text()
    rows = {row["part"]: row for row in summary["profile"]}
    costs = summary["costs"]
    loading = rows["program and libraries"]["wall_seconds"]
    whole = sum(row["wall_seconds"] for row in rows.values())
    # Both clocks stop when the summary is written; a busy machine may suspend the program between them.
    assert abs(whole - loading - costs["wall_seconds"]) <= 0.05*costs["wall_seconds"] + 0.3, (whole, costs)
    assert all(row["wall_seconds"] >= 0 and row["calls"] > 0 for row in rows.values()), rows
    assert rows["steps"]["calls"] == summary["accepted_steps"], rows["steps"]
    if costs["refactorisations"] > 0:
        assert rows["factorization"]["calls"] == costs["refactorisations"], rows["factorization"]
        # Besides corrections each factorization needs one solution for the impactor's unit force.
        assert rows["solve"]["calls"] == costs["solves"] + costs["refactorisations"], rows["solve"]
    else:
        assert rows["nodes"]["calls"] == summary["accepted_steps"], rows
    assert all(f"\n{part} " in log for part in rows), "parts are missing in the log"
    assert sum(row["peak_megabytes_added"] for row in rows.values()) > 5, "memory is missing"
    print(f"{len(rows)} parts of {whole:.3f} s")


if __name__ == "__main__":
    main()
