"""Runs the commands of the tutorial, page by page, like a reader: the lines of blocks marked `sh`, in one folder with
the decks. Each command ends with code 0, and each picture of a page is drawn by one of them. Decks with
delaminations end early (page_commands.EARLY), unless --whole is given.
Usage: tutorial.py IMPLAM ROOT FOLDER [--whole] [--keep]      (--keep puts the pictures into doc/tutorial/pictures)

Ends with code 77 where the Python commands are not installed."""

import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

from page_commands import Command, parts_of, shorten

SKIPPED = 77
PICTURE = re.compile(r"!\[[^\]]*\]\(pictures/([\w.-]+)\)")


def commands_of(page):
    """The commands of a page that are run."""
    return [part.text for part in parts_of(page) if isinstance(part, Command) and part.kind == "run"]


def main(arguments):
    """Run all pages; return the exit code."""
    keep, whole = "--keep" in arguments, "--whole" in arguments
    implam, root, folder = (Path(word).resolve() for word in arguments if not word.startswith("--"))
    scripts = root / ".venv" / "bin"
    if not (scripts / "implam-plot").exists():
        print("skipped: the Python commands are not installed")
        return SKIPPED
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name in ("tutorial", "small"):
        shutil.copytree(root / "input" / name, folder / "input" / name)
    if not (keep or whole):
        shorten(folder)
    environment = os.environ | {"PATH": f"{implam.parent}:{scripts}:{os.environ['PATH']}"}
    wrong, drawn = [], []
    for path in sorted((root / "doc" / "tutorial").glob("*.md")):
        page = path.read_text(encoding="utf-8")
        for command in commands_of(page):
            begun = time.monotonic()
            done = subprocess.run(command, shell=True, cwd=folder, env=environment, capture_output=True, text=True,
                                  check=False)
            print(f"{path.name}: {command}: {time.monotonic() - begun:.1f} s", flush=True)
            if done.returncode:
                printed = done.stdout[-2000:] + done.stderr[-2000:]
                wrong.append(f"{path.name}: {command}: code {done.returncode}\n{printed}")
        for picture in PICTURE.findall(page):
            drawn.append(picture)
            if not (folder / "pictures" / picture).exists():
                wrong.append(f"{path.name}: no command draws pictures/{picture}")
    if keep and not wrong:
        kept = root / "doc" / "tutorial" / "pictures"
        kept.mkdir(exist_ok=True)
        for picture in drawn:
            shutil.copy(folder / "pictures" / picture, kept)
    print("\n".join(wrong) if wrong else "The tutorial runs.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
