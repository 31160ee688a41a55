#!/usr/bin/env python3
"""Compares all places that state the version with CMakeLists.txt, and the citation that the program prints with
CITATION.cff.

Usage: check_version.py [ROOT]
"""

import re
import sys
from pathlib import Path

# Files with the version, and its position in them.
PLACES = {
    "CITATION.cff": r"^version: (\S+)$",
    "CHANGELOG.md": r"^## (\S+)",
    "postproc/pyproject.toml": r'^version = "(\S+)"$',
    "packaging/spack/spack_repo/implam/packages/implam/package.py": r'^    version\("(\S+)"\)$',
    "packaging/implam.def": r"^  Version (\S+)$",
    "doc/limits.md": r"What version (\S+) does not model",
}

CITED = "src/results/run_provenance.f90"


def differing_citation(cff, source):
    """Sentences on a title or a year of CITATION.cff that the program's citation lacks."""
    title = re.search(r'^title: "Implam: ([^"]+)"$', cff, re.MULTILINE).group(1)
    year = re.search(r"^date-released: (\d+)", cff, re.MULTILINE).group(1)
    for part in (title, f"({year})"):
        if part not in source:
            yield f"{CITED} does not cite {part} as CITATION.cff does"


def breaches(root):
    """Sentences on versions that differ."""
    project = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    declared = re.search(r"project\(implam VERSION (\S+)", project).group(1)
    for name, pattern in PLACES.items():
        found = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.MULTILINE)
        if not found:
            yield f"{name} states no version"
        elif found.group(1) != declared:
            yield f"{name} is of version {found.group(1)}, CMakeLists.txt of {declared}"
    cff, source = ((root / name).read_text(encoding="utf-8") for name in ("CITATION.cff", CITED))
    yield from differing_citation(cff, source)


def main(arguments):
    """Check; return the exit code."""
    root = Path(arguments[0] if arguments else Path(__file__).resolve().parents[2])
    wrong = list(breaches(root))
    print("\n".join(wrong) if wrong else f"{len(PLACES)} places agree on the version")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
