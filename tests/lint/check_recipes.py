#!/usr/bin/env python3
"""Compares the recipes for Spack and Apptainer with what the build requires. Usage: check_recipes.py [ROOT]

- packaging/implam.def installs the packages of setup.sh that the program needs.
- The recipe for Spack is valid Python, and has the versions of PETSc and CMake that the build accepts.
"""

import ast
import re
import sys
from pathlib import Path

SPACK = "packaging/spack/spack_repo/implam/packages/implam/package.py"
# Packages of setup.sh only for tests and Python commands.
NOT_BUILT_WITH = {"hdf5-tools", "python3-venv"}


def words(text, pattern):
    """Blank-separated words of the first match, without continuation marks."""
    found = re.search(pattern, text, re.DOTALL)
    return set(found[1].replace("\\", " ").split()) if found else set()


def breaches(root):
    """Sentences on differences."""
    setup = words((root / "setup.sh").read_text(encoding="utf-8"), r"\npackages=\(([^)]*)\)") - NOT_BUILT_WITH
    image = words((root / "packaging/implam.def").read_text(encoding="utf-8"),
                  r"apt-get -qq install --no-install-recommends ([^#]*?)\n  (?:#|cmake)")
    for package in sorted(setup ^ image):
        yield f"packaging/implam.def: {package} is in {'setup.sh' if package in setup else 'the definition'} only"
    recipe = (root / SPACK).read_text(encoding="utf-8")
    try:
        ast.parse(recipe)
    except SyntaxError as error:
        yield f"{SPACK}:{error.lineno}: {error.msg}"
    build = (root / "cmake/ImplamDependencies.cmake").read_text(encoding="utf-8")
    lowest, above = re.search(r"PETSc>=(\d+\.\d+)", build)[1], re.search(r"VERSION_GREATER_EQUAL (\d+)\.(\d+)", build)
    cmake = re.search(r"cmake_minimum_required\(VERSION (\S+)\)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))
    for wanted in (f"petsc@{lowest}:{above[1]}.{int(above[2]) - 1} ", f"cmake@{cmake[1]}:"):
        if wanted not in recipe:
            yield f"{SPACK}: no {wanted.strip()}"


def main(arguments):
    """Check the recipes; return the exit code."""
    found = list(breaches(Path(arguments[0]) if arguments else Path(__file__).resolve().parents[2]))
    print("\n".join(found) if found else "the recipes agree with the build")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
