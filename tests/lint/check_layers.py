"""Checks that folders of the program use those of earlier tiers only. Usage:
check_layers.py COMPILER MODULES LAYERS TIER...

TIERs are names of folders with a slash before each new tier. LAYERS is a file with a line NAME=FOLDER;FOLDER for each
folder of the program: where its compiler looks for modules. Modules of the program are in folders of MODULES. For each
folder a module of every other one is used in a probe, which must compile only if the other is of an earlier tier.
README.md and doc/architecture.md list the same folders in the same tiers.
Prints one line a breach and ends with code 1 if there is any.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path


def tiers_of(words):
    """Number of the tier of each folder."""
    tiers, number = {}, 0
    for word in words:
        number += word == "/"
        if word != "/":
            tiers[word] = number
    return tiers


def compiles(compiler, module, searched):
    """Return whether a file that uses a module compiles with some folders to look for it."""
    with tempfile.TemporaryDirectory() as folder:
        probe = Path(folder, "probe.f90")
        probe.write_text(f"module probe\n  use {module}\nend module probe\n", encoding="utf-8")
        command = [compiler, "-fsyntax-only", f"-J{folder}", *(f"-I{path}" for path in searched if path), str(probe)]
        return subprocess.run(command, capture_output=True, check=False).returncode == 0


def breaches(compiler, modules, searched, tiers):
    """Sentences on folders that use too few or too many others."""
    for name, folders in searched.items():
        for other, tier in tiers.items():
            module = min(path.stem for path in Path(modules, other).glob("*.mod"))
            allowed = tier < tiers[name]
            if other != name and compiles(compiler, module, folders) != allowed:
                yield f"{name} {'can use none' if allowed else 'can use some'} of the modules of {other}"


def listed(root):
    """Tiers of the folders by the pages that list them: page, and folder to number."""
    text = Path(root, "README.md").read_text(encoding="utf-8")
    row = re.search(r"Tiers, from the lowest: (.*?) \(", text)
    yield "README.md", {name: number for number, tier in enumerate(row[1].split("; "), 1) for name in tier.split(", ")}
    text = Path(root, "doc", "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| (\w+) \|", text, re.M)
    yield "doc/architecture.md", {name: int(number) for number, name in rows}


def main(arguments):
    """Check the folders; return the exit code."""
    compiler, modules, layers, *words = arguments
    lines = Path(layers).read_text(encoding="utf-8").split()
    searched = {name: folders.split(";") for name, folders in (line.split("=") for line in lines)}
    tiers = tiers_of(words)
    found = list(breaches(compiler, modules, searched, tiers))
    found += [f"{name} has no tier" for name in searched.keys() ^ tiers.keys()]
    for page, places in listed(Path(__file__).resolve().parents[2]):
        found += [f"{page}: {name} has another tier, or none"
                  for name in tiers.keys() | places.keys() if places.get(name) != tiers.get(name, -1) + 1]
    print("\n".join(found) if found else f"{len(tiers)} folders use those of earlier tiers only")
    return 1 if found or not searched else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
