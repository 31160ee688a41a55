"""Tests of sweeps with runs of the program: the table, failures, and killed or stopped sweeps."""

import contextlib
import csv
import fcntl
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from collections.abc import Callable
from pathlib import Path

import h5py

from implam_post.io.history import read_history
from implam_post.io.program import EXIT_STOPPED
from implam_post.sweep import command as sweep
from implam_post.sweep.case_run import FINAL, case_command, read_record
from implam_post.sweep.table import FIGURES
from tests.program import SMALL, implam, run, run_quietly, start, surroundings

# Four runs of some seconds, with checkpoints.
LONG = """
deck = "ply_damage.nml"
[grid]
"laminate.angles" = [[0, 90, 0], [90, 0, 90]]
energy = [0.3, 0.9]
"time.end" = [1.0e-3]
"output.checkpoint_every" = [50e-6]
[derived]
"impactor.velocity" = "sqrt(2*energy/impactor.mass)"
"""
HARD = """
deck = "ply_damage.nml"
[list]
"solver.max_iterations" = [1, 30]
"solver.tolerance" = [1e-13, 1e-6]
"""
PATIENCE, SLOW = 120, 5  # seconds


class SweepTest(unittest.TestCase):
    """Each test has a folder with small decks; a wrapper of the program logs its calls."""

    def setUp(self) -> None:
        """Make the folder."""
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        for deck in SMALL.glob("*.nml"):
            shutil.copy(deck, self.folder)
        self.output, self.program, self.calls = (self.folder / name for name in ("out", "noting", "calls.txt"))
        self.program.write_text(f'#!/bin/sh\necho "$@" >> {self.calls}\nexec {implam()} "$@"\n')
        self.program.chmod(0o755)
        self.addCleanup(lambda: self.kill(self.processes()))

    def arguments(self, text: str, *more: object) -> list[str]:
        """Write the file of a sweep and return the arguments to run it."""
        path = self.folder / "sweep.toml"
        path.write_text(text)
        return [str(word) for word in (path, "--output", self.output, "--program", self.program, "--jobs", 2, *more)]

    def called(self, verb: str) -> int:
        """Return the number of calls of the program with a subcommand."""
        lines = self.calls.read_text().splitlines() if self.calls.exists() else []
        return sum(line.startswith(f"{verb} ") for line in lines)

    def table(self, output: Path | None = None) -> list[dict[str, str]]:
        """Return the rows of the table without the processor time."""
        with ((output or self.output) / "table.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            self.assertTrue(float(row.pop("cpu_time") or "nan") > 0 or row["exit_code"] == "", row)
        return rows

    def test_checks_are_reported(self) -> None:
        """Only warnings of the check are reported, once for all decks."""
        code, text = run_quietly(sweep.main, *self.arguments("""
            deck = "ply_damage.nml"
            [grid]
            "impactor.mass" = [0.1, 0.2]
            "output.history_every" = [1e-7]
            """, "--array"))
        self.assertEqual(code, 0, text)
        warnings = [line for line in text.splitlines() if line.startswith("warning, ")]
        self.assertEqual(len(warnings), 1, text)
        self.assertTrue(warnings[0].startswith("warning, 2 of 2 decks: "), text)

    def test_lost_histories(self) -> None:
        """A case with an empty or missing history, or one without rows, runs again from the start; others do not."""
        arguments = self.arguments("""
            deck = "delamination.nml"
            [grid]
            "impactor.velocity" = [0.5, 0.6, 0.7, 0.8]
            "output.checkpoint_every" = [100e-6]
            """)
        self.assertEqual(run_quietly(sweep.main, *arguments)[0], 0)
        before = self.table()
        histories = [self.output / row["folder"] / "delamination_history.csv" for row in before]
        first, whole = histories[0].read_text().splitlines()[0], histories[0].read_text()
        histories[0].write_text("")
        histories[1].write_text(first + "\n")
        histories[2].unlink()
        code, text = run_quietly(sweep.main, *arguments)
        self.assertEqual(code, 0, text)
        self.assertEqual((self.called("run"), self.called("restart")), (7, 0), text)
        self.assertEqual(self.table(), before)
        self.assertEqual(histories[0].read_text(), whole)

    def test_table_and_plots(self) -> None:
        """Figures are those of the summaries, in CSV and HDF5; the energy is the swept one; no run is repeated."""
        arguments = self.arguments("""
            deck = "delamination.nml"
            [grid]
            "delamination.G_c" = [300, 400]
            energy = [0.1, 0.25]
            "time.end" = [1.2e-3]
            [derived]
            "impactor.velocity" = "sqrt(2*energy/impactor.mass)" """)
        code, text = run_quietly(sweep.main, *arguments)
        self.assertEqual(code, 0, text)
        rows = self.table()
        self.assertEqual([(row["delamination.G_c"], row["energy"]) for row in rows],
                         [("300", "0.1"), ("300", "0.25"), ("400", "0.1"), ("400", "0.25")])
        for row in rows:
            history = read_history(self.output / row["folder"] / "delamination_history.csv")
            summary = json.loads((self.output / row["folder"] / "delamination_summary.json").read_text())
            for name, figure in FIGURES.items():
                self.assertEqual(name in row, figure.member in summary, name)
                if name in row and not summary["in_contact"]:
                    found = float(row[name]) if row[name] else None
                    self.assertEqual(found, summary[figure.member], name)
            self.assertAlmostEqual(float(row["impact_energy"]) / float(row["energy"]), 1, delta=1e-9)
            self.assertEqual(float(row["delaminated_area"]), history["delaminated_area"][-1])
            self.assertEqual((row["exit_code"], row["version"].split(".")[0]), ("0", "0"))
        self.assertGreater(float(rows[0]["rebound_velocity"]), 0.5)
        with h5py.File(self.output / "table.h5") as file:
            self.assertEqual(file["table/peak_force"][()].tolist(), [float(row["peak_force"]) for row in rows])
            self.assertEqual([word.decode() for word in file["table/folder"]], [row["folder"] for row in rows])
            self.assertIn(b"G_c=300", file["decks"][0])
            self.assertEqual(file.attrs["units"], "SI")
        for name in ("area_energy", "threshold_energy", "scatter"):
            self.assertGreater((self.output / f"{name}.png").stat().st_size, 10000)
        self.assertEqual(self.called("run"), 4)
        self.assertEqual(run_quietly(sweep.main, *arguments)[0], 0)
        self.assertEqual((self.called("run"), self.called("check"), self.table()), (4, 4, rows))

    def test_failures_are_collected(self) -> None:
        """A run without convergence has no figures, the other one has; it is repeated only with --retry."""
        for more, runs in (((), 2), ((), 2), (("--retry",), 3)):
            code, text = run_quietly(sweep.main, *self.arguments(HARD, *more))
            self.assertEqual((code, self.called("run")), (1, runs), text)
            self.assertIn("1 of 2 cases failed:\n  case 1 ", text)
            self.assertIn("solver.max_iterations=1  solver.tolerance=1e-13: ended with 3: ", text)
            rows = self.table()
            self.assertEqual([(row["exit_code"], row["peak_force"] == "") for row in rows], [("3", True), ("0", False)])

    def test_changed_checkpoint(self) -> None:
        """Cases that begin from a checkpoint run again once it has changed, or the program; others do not."""
        self.addCleanup(os.chdir, Path.cwd())
        os.chdir(self.folder)
        deck = self.folder / "cai_impact.nml"
        def strike(velocity: str) -> None:
            text = re.sub(r"velocity=\S+", f"velocity={velocity}", (SMALL / deck.name).read_text())
            deck.write_text(text.replace("end=0.72e-3", "end=0.3e-3"))
            subprocess.run([implam(), deck.name], check=True, stdout=subprocess.DEVNULL)
        strike("8")
        arguments = self.arguments('deck = "cai_compression.nml"\n[grid]\n"line[*].rise" = [0.09e-3]\n'
                                   '"time.end" = [0.4e-3]')
        self.assertEqual(run_quietly(sweep.main, *arguments)[0], 0)
        first, = self.table()
        self.assertEqual((run_quietly(sweep.main, *arguments)[0], self.called("run")), (0, 1))
        self.assertNotIn("impact_energy", first)
        strike("6")
        code, text = run_quietly(sweep.main, *arguments, "--table")
        self.assertEqual((code, self.called("run"), self.table()[0].get("residual_strength", "")), (75, 1, ""), text)
        self.assertIn("1 case without figures: a file that the deck reads has changed since.", text)
        code, text = run_quietly(sweep.main, *arguments)
        self.assertEqual((code, self.called("run")), (0, 2), text)
        self.assertIn("1 case of 1 to run again from the start: cai_impact_restart.h5 has changed since", text)
        self.assertNotEqual(self.table()[0]["residual_strength"], first["residual_strength"])
        log, = self.output.rglob("*.log")
        log.write_text(re.sub(r"^Implam [^,]*,", "Implam 0.0.9 (commit abc),", log.read_text(), flags=re.MULTILINE))
        code, text = run_quietly(sweep.main, *arguments)
        self.assertEqual((code, self.called("run")), (0, 3), text)
        self.assertIn("their results are of Implam 0.0.9 (abc), and this is ", text)

    def test_faults_are_reported_before_anything_runs(self) -> None:
        """A value out of range and a misspelt key: messages of the program, and no run."""
        for key, expected in (("impactor.mass", "mass = -1"), ("delamination.G_cc", "no such key")):
            code, text = run_quietly(sweep.main, *self.arguments(
                f'deck = "delamination.nml"\n[grid]\n"{key}" = [-1, 0.2]'))
            self.assertEqual(code, 2, text)
            self.assertRegex(text, f"case 1: {key}=-1\n.*{expected}.*\n(.*\n)*.*decks are faulty; no deck was run\\.")
        self.assertEqual((self.called("run"), self.called("check")), (0, 4))
        self.assertEqual([path for path in self.output.rglob("*") if path.suffix not in (".nml", "")], [])

    def test_faults_of_second_decks(self) -> None:
        """Faulty second decks are reported before the first runs; the decks of a valid check are removed."""
        deck = self.folder / "cai_compression.nml"
        arguments = self.arguments('deck = "cai_impact.nml"\nthen = "cai_compression.nml"\n'
                                   '[grid]\n"impactor.velocity" = [4.0, 5.0]', "--array")
        code, text = run_quietly(sweep.main, *arguments)
        self.assertEqual((code, (self.output / "second_decks").exists()), (0, False), text)
        deck.write_text(deck.read_text().replace("&line ", "&lime "))
        code, text = run_quietly(sweep.main, *arguments)
        self.assertEqual(code, 2, text)
        self.assertRegex(text, "case 2: .*\n.*&lime: there is no such group(.*\n)*.*decks are faulty; no deck was run")

    def test_second_impacts(self) -> None:
        """A second deck with an impactor strikes each panel again; the table has its figures, too."""
        code, text = run_quietly(sweep.main, *self.arguments(
            'deck = "cai_impact.nml"\nthen = "second_impact.nml"\n[grid]\n"impactor.velocity" = [6.0]'))
        self.assertEqual(code, 0, text)
        row, = self.table()
        self.assertGreater(float(row["second_peak_force"]), 1000)
        self.assertGreater(float(row["second_delaminated_area"]), float(row["delaminated_area"]))

    def test_killed(self) -> None:
        """After killing the sweep only, all its processes, or all but the runs, the table is the same."""
        reference = self.folder / "reference"
        code, text = run("sweep", *self.arguments(LONG, "--output", reference, "--program", implam()))
        self.assertEqual(code, 0, text)
        for kill in (self.kill_sweep, self.kill_all, self.kill_all_but_runs):
            before = self.states()
            with start("sweep", *self.arguments(LONG)) as process:
                self.wait_until(lambda before=before: len(self.states() - before) >= 2, process)
                kill(process)
        code, text = run("sweep", *self.arguments(LONG))
        self.assertEqual(code, 0, text)
        self.assertEqual(self.table(), self.table(reference))
        self.assertGreater(self.called("restart"), 0)
        self.assertLess(self.called("run"), 12)
        for case in (reference / "cases").iterdir():
            again = self.output / "cases" / case.name / "ply_damage_history.csv"
            self.assertEqual((case / again.name).read_bytes(), again.read_bytes())
        self.assertEqual(list(self.output.rglob(".draft*")), [])

    def test_stopped_by_a_signal(self) -> None:
        """SIGTERM ends the runs with checkpoints; the same command continues them."""
        with start("sweep", *self.arguments(LONG)) as process:
            self.wait_until(lambda: self.states(), process)
            process.send_signal(signal.SIGTERM)
            text, _ = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, EXIT_STOPPED, text)
        self.assertRegex(text, r"\d of 4 cases have not ended; the same command continues")
        self.assertEqual(self.processes(), [])
        code, text = run("sweep", *self.arguments(LONG))
        self.assertEqual(code, 0, text)
        self.assertGreater(self.called("restart"), 0)
        self.assertEqual({row["exit_code"] for row in self.table()}, {"0"})

    def test_stopped_while_loading(self) -> None:
        """A signal that ends the program before its first instruction has stopped the case as any other."""
        self.assertEqual(run_quietly(sweep.main, *self.arguments(HARD), "--array")[0], 0)
        case = next(iter(sorted((self.output / "cases").iterdir())))
        loading = self.folder / "loading"
        loading.write_text(f"#!/bin/sh\ntouch {case}/begun\nsleep 1\nexec {implam()} \"$@\"\n")
        loading.chmod(0o755)
        command = [*case_command(case, [str(loading)])]
        with subprocess.Popen(command, env=surroundings(), stdout=subprocess.PIPE, text=True) as process:
            self.wait_until((case / "begun").exists, process)
            process.send_signal(signal.SIGTERM)
            text, _ = process.communicate(timeout=PATIENCE)
        self.assertEqual((process.returncode, read_record(case).exit_code), (EXIT_STOPPED, EXIT_STOPPED), text)
        self.assertIn(subprocess.run(command, env=surroundings(), check=False).returncode, FINAL)

    def test_array(self) -> None:
        """A queue runs the commands of a file, one per deck; the sweep then writes the table without a run."""
        arguments = self.arguments(HARD)
        code, text = run_quietly(sweep.main, *arguments, "--array")
        self.assertEqual((code, self.called("run")), (0, 0), text)
        decks, commands = ((self.output / name).read_text().splitlines() for name in ("decks.txt", "array.txt"))
        self.assertEqual(([Path(deck).name for deck in decks], len(commands)), (2 * ["ply_damage.nml"], 2))
        codes = [subprocess.run(["/bin/sh", "-c", command], env=surroundings(), stdout=subprocess.DEVNULL, check=False,
                                cwd="/").returncode for command in commands]
        self.assertEqual((codes, self.called("run")), ([3, 0], 2))
        self.assertEqual(run_quietly(sweep.main, *arguments, "--table")[0], 1)
        self.assertEqual((self.called("run"), len(self.table())), (2, 2))
        self.assertEqual(run_quietly(sweep.main, *arguments, "--array")[0], 0)
        self.assertEqual((self.output / "decks.txt").read_text(), "")

    def test_useless_checkpoint(self) -> None:
        """A case with an invalid checkpoint is run from the start."""
        text = 'deck = "ply_damage.nml"\n[grid]\n"impactor.mass" = [0.2]'
        self.assertEqual(run_quietly(sweep.main, *self.arguments(text, "--array"))[0], 0)
        case = next((self.output / "cases").iterdir())
        (case / "ply_damage_restart.h5").write_text("nothing")
        code, said = run_quietly(sweep.main, *self.arguments(text))
        self.assertEqual((code, self.called("restart"), self.called("run")), (0, 1, 1), said)

    def test_one_sweep_a_folder(self) -> None:
        """A second sweep in a folder and a missing program end with one sentence and exit code 4."""
        self.output.mkdir()
        with (self.output / "lock").open("w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            code, text = run_quietly(sweep.main, *self.arguments(LONG))
        self.assertEqual((code, text.count("\n")), (4, 1), text)
        code, text = run_quietly(sweep.main, *self.arguments(LONG, "--program", "no_such_program"))
        self.assertEqual((code, text.count("\n")), (4, 1), text)
        self.assertEqual(list(self.output.rglob("*.nml")), [])

    def states(self) -> set[tuple[str, int]]:
        """Return the existing checkpoints with the times they were written."""
        return {(str(path), path.stat().st_mtime_ns) for path in self.output.glob("cases/*/*_restart.h5")}

    def wait_until(self, condition: Callable[[], bool], process: subprocess.Popen) -> None:
        """Wait until the condition is true; the process must still be running then."""
        latest = time.monotonic() + PATIENCE
        while not condition():
            self.assertIsNone(process.poll(), "the sweep ended too early")
            self.assertLess(time.monotonic(), latest, "nothing happens")
            time.sleep(0.02)

    def processes(self) -> list[int]:
        """Return the processes with the folder of the test in their command line."""
        numbers = [int(path.name) for path in Path("/proc").glob("[0-9]*")]
        return [number for number in numbers if str(self.folder).encode() in self.command(number)]

    def kill_sweep(self, process: subprocess.Popen) -> None:
        """Kill the sweep only: its runs then stop with a checkpoint."""
        process.kill()
        latest = time.monotonic() + PATIENCE
        while self.processes() and time.monotonic() < latest:
            time.sleep(0.05)
        records = [json.loads(path.read_text()) for path in self.output.glob("cases/*/run.json")]
        self.assertIn(EXIT_STOPPED, [record["exit_code"] for record in records])

    def kill_all(self, process: subprocess.Popen) -> None:
        """Kill the sweep and all its processes, as in a power failure."""
        self.kill(self.processes())

    def kill_all_but_runs(self, process: subprocess.Popen) -> None:
        """Kill the sweep and the supervisors of its runs; the runs continue slowly, and their ends are not recorded."""
        runs = [number for number in self.processes() if b"implam_post" not in self.command(number)]
        self.assertGreater(len(runs), 0)
        self.send(signal.SIGSTOP, runs)
        self.kill([number for number in self.processes() if number not in runs])
        timer = threading.Timer(SLOW, self.send, (signal.SIGCONT, runs))
        timer.start()
        self.addCleanup(timer.join)

    def kill(self, numbers: list[int]) -> None:
        """Stop, then kill processes, so that none reacts to the end of another."""
        self.send(signal.SIGSTOP, numbers)
        self.send(signal.SIGKILL, numbers)

    def send(self, number: signal.Signals, processes: list[int]) -> None:
        """Send a signal to processes; some may have ended."""
        for process in processes:
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, number)

    def command(self, number: int) -> bytes:
        """Return the command line of a process; empty if it has ended."""
        try:
            return Path(f"/proc/{number}/cmdline").read_bytes()
        except OSError:
            return b""
