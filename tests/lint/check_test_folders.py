"""Checks that unit tests follow the folders of the program. Usage:
check_test_folders.py ROOT

Every folder of src has tests in a folder of the same name under tests/unit, and every test uses, itself or by its
helpers, a module of that folder. Prints one line a breach and ends with code 1 if there is any.
"""

import re
import sys
from pathlib import Path

MODULE = re.compile(r"^\s*module\s+(?!procedure\b)(\w+)\s*$", re.MULTILINE | re.IGNORECASE)
USE = re.compile(r"^\s*use\s+(\w+)", re.MULTILINE | re.IGNORECASE)


def read(path):
    """Text of a file."""
    return path.read_text(encoding="utf-8")


def modules_of(files):
    """File of each module that these files define."""
    return {name.lower(): path for path in files for name in MODULE.findall(read(path))}


def used_by(path, helpers):
    """Names of the modules that a file uses, with those of its helpers."""
    names, waiting = set(), [path]
    while waiting:
        for name in USE.findall(read(waiting.pop())):
            if name.lower() not in names:
                names.add(name.lower())
                if name.lower() in helpers:
                    waiting.append(helpers[name.lower()])
    return names


def breaches(root):
    """One sentence per breach."""
    owners = {name: path.parent.name for name, path in modules_of(sorted(root.glob("src/*/*.f90"))).items()}
    shared = sorted(root.glob("tests/support/*.f90"))
    for folder in sorted(path for path in (root / "src").iterdir() if path.is_dir()):
        tests = sorted((root / "tests/unit" / folder.name).glob("*.pf"))
        if not tests:
            yield f"tests/unit/{folder.name}: there is no test of src/{folder.name}"
        helpers = modules_of(shared + sorted((root / "tests/unit" / folder.name).glob("*.f90")))
        for path in tests:
            if folder.name not in {owners.get(name) for name in used_by(path, helpers)}:
                yield f"{path.relative_to(root)}: uses no module of src/{folder.name}"


if __name__ == "__main__":
    FOUND = list(breaches(Path(sys.argv[1])))
    print("\n".join(FOUND))
    sys.exit(bool(FOUND))
