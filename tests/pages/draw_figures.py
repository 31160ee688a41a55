"""Draws the figures of the pages: every picture in doc/figures has a script, and every script draws its picture.
Usage: draw_figures.py FIGURES FOLDER. Ends with code 77 where matplotlib is not installed."""

import importlib.util
import subprocess
import sys
from pathlib import Path

SKIPPED = 77


def main(figures, folder):
    """Run the scripts; return the exit code."""
    if importlib.util.find_spec("matplotlib") is None:
        print("skipped: matplotlib is not installed")
        return SKIPPED
    figures, folder = Path(figures), Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    scripts = {path.stem for path in figures.glob("*.py")} - {"drawing"}
    pictures = {path.stem for path in figures.glob("*.svg")}
    wrong = [f"{name}: a script or its picture is missing" for name in sorted(scripts ^ pictures)]
    for name in sorted(scripts):
        done = subprocess.run([sys.executable, "-B", figures / f"{name}.py", folder], check=False)
        if done.returncode or not (folder / f"{name}.svg").exists():
            wrong.append(f"{name}.py draws nothing")
    print("\n".join(wrong) if wrong else f"{len(scripts)} figures drawn")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
