"""Cases of a sweep on this machine: folders, results, and runs in progress."""

import os
import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from implam_post.io.counts import counted
from implam_post.io.errors import EXIT_DONE, FileError, reason
from implam_post.io.files import read_deck_text, write_text
from implam_post.io.program import EXIT_STOPPED, last_words, version_in, version_of
from implam_post.io.progress import Progress
from implam_post.sweep.case_run import OUTPUT, case_command, changed_input, read_record, remove_results
from implam_post.sweep.plan import Case, Plan

NOT_RUN, STOPPED, OUTDATED = "not run", "stopped", "out of date"
_PAUSE = 0.05  # seconds between checks of the runs
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2)


@dataclass
class _Job:
    """A run in progress; it stops when its pipe `lifeline` is closed."""

    case: Case
    process: subprocess.Popen
    lifeline: int


@dataclass
class Sweep:
    """A plan and the program that runs it."""

    plan: Plan
    program: list[str]
    folders: dict[str, Path] = field(init=False)

    def __post_init__(self) -> None:
        """Choose the folder of each case."""
        self.folders = {case.key: self.plan.output / "cases" / case.key for case in self.plan.cases}

    def folder(self, case: Case) -> Path:
        """Return the folder of a case."""
        return self.folders[case.key]

    def deck(self, case: Case) -> Path:
        """Return the path of a case's deck."""
        return self.folder(case) / case.deck_name

    def write_decks(self) -> None:
        """Write the decks that do not exist yet."""
        for case in self.plan.cases:
            path = self.deck(case)
            if not path.exists() or read_deck_text(path) != case.deck:
                write_text(path, case.deck)

    def open_cases(self) -> list[Case]:
        """Return the cases whose run has to be started or continued, one per deck."""
        first: dict[str, Case] = {}
        for case in self.plan.cases:
            first.setdefault(case.key, case)
        records = {key: read_record(self.folders[key]) for key in first}
        return [case for key, case in first.items() if not (records[key] and records[key].final)]

    def remove_outdated(self) -> list[str]:
        """Remove results with other input files, or of another version; return a sentence for each reason."""
        reasons: dict[str, list[Case]] = {}
        for case in self.plan.cases:
            if reason := self._outdated(case):
                reasons.setdefault(reason, []).append(case)
        for cases in reasons.values():
            for case in cases:
                remove_results(self.folder(case))
        return [f"{counted(len(cases), 'case')} of {len(self.plan.cases)} to run again from the start: {why}."
                for why, cases in reasons.items()]

    def _outdated(self, case: Case) -> str:
        """Return the reason why the results of a case are out of date; empty if they are not."""
        folder, version = self.folder(case), version_of(self.program)
        if changed := changed_input(folder, case.deck):
            return f"{changed} has changed since their run"
        before = version_in(folder).replace("(commit ", "(")
        return (f"their results are of Implam {before}, and this is {version}"
                if read_record(folder) is not None and version and before not in ("", version) else "")

    def failure(self, case: Case) -> str:
        """Return the reason why a case has no result; empty if it has one."""
        record = read_record(self.folder(case))
        if record is None:
            return NOT_RUN
        if changed_input(self.folder(case), case.deck):
            return OUTDATED
        if record.exit_code == EXIT_DONE:
            return ""
        if record.exit_code == EXIT_STOPPED:
            return STOPPED
        output = self.folder(case) / OUTPUT
        printed = last_words(output.read_text(encoding="utf-8", errors="replace")) if output.exists() else ""
        return f"ended with {record.exit_code}: {printed}"


def _start(sweep: Sweep, case: Case) -> _Job:
    """Start the run of a case in its own session, so that only closing its pipe `lifeline` stops it."""
    reading, lifeline = os.pipe()
    try:
        process = subprocess.Popen(
            [*case_command(sweep.folder(case), sweep.program), "--lifeline", str(reading)], stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, pass_fds=[reading], start_new_session=True)
    except OSError as error:
        raise FileError(f"a run cannot be started ({reason(error)}).") from None
    finally:
        os.close(reading)
    return _Job(case, process, lifeline)


def run_cases(sweep: Sweep, cases: Sequence[Case], jobs: int, now_and_then: Callable[[], None]) -> bool:
    """Run cases, several simultaneously; return False if a signal stopped them. `now_and_then` is called repeatedly."""
    waiting, running, stopped = list(reversed(cases)), [], []
    handlers = {number: signal.signal(number, lambda *_: stopped.append(True)) for number in _SIGNALS}
    try:
        with Progress(len(cases)) as progress:
            while running or (waiting and not stopped):
                while waiting and len(running) < jobs and not stopped:
                    running.append(_start(sweep, waiting.pop()))
                time.sleep(_PAUSE)
                for job in [job for job in running if job.process.poll() is not None]:
                    running.remove(job)
                    _end(sweep, job, progress)
                for job in running if stopped else ():
                    _cut(job)
                progress.tick()
                now_and_then()
    finally:
        for job in running:
            _cut(job)
        for number, handler in handlers.items():
            signal.signal(number, handler)
    return not stopped


def _end(sweep: Sweep, job: _Job, progress: Progress) -> None:
    """Report the end of a run."""
    _cut(job)
    printed = job.process.stderr.read().strip()
    job.process.stderr.close()
    failure = sweep.failure(job.case)
    progress.end_run(f"case {job.case.number}: {job.case.label}",
                     printed.splitlines()[-1] if failure == NOT_RUN and printed else failure)


def _cut(job: _Job) -> None:
    """Stop a run by closing its pipe."""
    if job.lifeline >= 0:
        os.close(job.lifeline)
        job.lifeline = -1
