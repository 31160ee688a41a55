#!/usr/bin/env python3
"""Runs the commands of the pages like a reader: those of blocks marked `sh`, in the order of a page. Each page has its
own folder, arranged like a clone, with the program and the Python commands on the path. Each command
ends with code 0, unless it reports a Python package that is not installed. The times printed show which commands belong
into `sh long`: those of more than half a minute on a usual processor. These are started, and after some seconds stopped
by the signal TERM, as a queue would: they end with code 0, with code 75, or by the signal.
Usage: run_commands.py IMPLAM ROOT FOLDER [PAGE...]

Blocks marked `sh elsewhere` are left to check_commands.py, the tutorial to tutorial.py. Ends with code 77 where the
Python commands are not installed."""

import os
import resource
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from page_commands import Command, SavedFile, parts_of, shorten

SKIPPED = 77
# Folders of the pages.
PAGES = (".", "doc", "doc/manual", "doc/studies", "doc/theory")
# Seconds after which a long command is stopped, enough to read a deck and do some steps; then for its orderly end.
STARTED, ENDED = 3, 120
STOPPED = (0, 75, -signal.SIGTERM)
# Kinds of commands that are tested here.
TRIED = ("run", "start")
# Files of a clone that commands read, besides the decks, to which they may add files.
LINKED = (".venv", "doc", "postproc", "tests")


def processor_time():
    """Processor seconds used by commands so far."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Clone:
    """A folder like a clone with the program built."""

    def __init__(self, implam, root, folder):
        """Create it."""
        self.folder = folder
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "build").mkdir(parents=True)
        (folder / "build" / "implam").symlink_to(implam)
        for name in LINKED:
            if (root / name).exists():
                (folder / name).symlink_to(root / name)
        shutil.copytree(root / "input", folder / "input")
        (folder / "temporary").mkdir()
        path = f"{folder / 'build'}:{folder / '.venv' / 'bin'}:{os.environ['PATH']}"
        # Scripts that are stopped leave their temporary folders.
        self.environment = os.environ | {"PATH": path, "PYTHONDONTWRITEBYTECODE": "1", "MPLBACKEND": "Agg",
                                         "TMPDIR": str(folder / "temporary")}  # fmt: skip

    def save(self, file):
        """Save a file of the page."""
        path = self.folder / file.name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")

    def run(self, command):
        """Run a command, with decks that end early; return its fault and its processor time."""
        shorten(self.folder)
        begun = processor_time()
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)  # fmt: skip
        taken = processor_time() - begun
        if done.returncode and "is not installed" in done.stdout:
            print(f"skipped: {done.stdout.strip()}")
            return "", taken
        fault = f"code {done.returncode}\n{done.stdout[-2000:]}" if done.returncode else ""
        return fault, taken

    def start(self, command):
        """Start a long command and stop it; return its fault and its processor time."""
        shorten(self.folder)
        begun = processor_time()
        with subprocess.Popen(["bash", "-c", command], cwd=self.folder, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              start_new_session=True) as process:  # fmt: skip
            try:
                printed = process.communicate(timeout=STARTED)[0]
            except subprocess.TimeoutExpired:
                printed = self.stop(process)
        fault = "" if process.returncode in STOPPED else f"code {process.returncode}\n{printed[-2000:]}"
        return fault, processor_time() - begun

    def stop(self, process):
        """Stop a command and its child processes; return the output."""
        os.killpg(process.pid, signal.SIGTERM)
        try:
            return process.communicate(timeout=ENDED)[0]
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return process.communicate()[0]


def run_page(page, clone):
    """Run the commands of a page; return faults. After a fault the rest of the page is skipped."""
    for part in parts_of(page.read_text(encoding="utf-8")):
        if isinstance(part, SavedFile):
            clone.save(part)
        elif isinstance(part, Command) and part.kind in TRIED:
            fault, taken = clone.run(part.text) if part.kind == "run" else clone.start(part.text)
            print(f"{page.name}:{part.line}: {taken:.1f} s: {part.text}", flush=True)
            if fault:
                return [f"{page.name}:{part.line}: {part.text}: {fault}"]
    return []


def main(arguments):
    """Run the pages; return the exit code."""
    implam, root, folder = (Path(word).absolute() for word in arguments[:3])
    if not (root / ".venv" / "bin" / "implam-plot").exists():
        print("skipped: the Python commands are not installed")
        return SKIPPED
    wrong, begun, count = [], processor_time(), 0
    for page in sorted(page for pages in PAGES for page in (root / pages).glob("*.md")):
        if arguments[3:] and page.stem not in arguments[3:]:
            continue
        if any(isinstance(part, Command) and part.kind in TRIED for part in parts_of(page.read_text(encoding="utf-8"))):
            wrong += run_page(page, Clone(implam, root, folder / page.stem))
            count += 1
    if not count:
        wrong = ["No page has commands to run."]
    print("\n".join(wrong) or f"Commands of {count} pages run in {processor_time() - begun:.0f} s of processor time.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
