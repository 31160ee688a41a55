#!/usr/bin/env python3
"""Holds all places that state the version against CMakeLists.txt. Usage: check_version.py [ROOT]"""

import re
import sys
from pathlib import Path

# Files with the version, and where it stands in them.
PLACES = {
    "CITATION.cff": r"^version: (\S+)$",
    "CHANGELOG.md": r"^## (\S+)",
    "postproc/pyproject.toml": r'^version = "(\S+)"$',
    "packaging/spack/packages/implam/package.py": r'^    version\("(\S+)"\)$',
    "packaging/implam.def": r"^  Version (\S+)$",
    "doc/limits.md": r"What version (\S+) does not model",
}


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


def main(arguments):
    """Check; return the exit code."""
    root = Path(arguments[0] if arguments else Path(__file__).resolve().parents[2])
    wrong = list(breaches(root))
    print("\n".join(wrong) if wrong else f"{len(PLACES)} places agree on the version")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
