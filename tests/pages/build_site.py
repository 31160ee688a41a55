"""Builds the pages by Sphinx; a warning is an error. Ends with code 77 where Sphinx is not installed.
Usage: build_site.py DOC FOLDER"""

import importlib.util
import subprocess
import sys
from pathlib import Path

SKIPPED = 77
# Sphinx, the Markdown parser and the theme: doc/requirements.txt.
NEEDED = ("sphinx", "myst_parser", "furo")


def main(doc, folder):
    """Build the site; return the exit code."""
    missing = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    if missing:
        print(f"skipped: {', '.join(missing)} not installed, see doc/requirements.txt")
        return SKIPPED
    command = [sys.executable, "-B", "-m", "sphinx", "-q", "-E", "-n", "-W", "--keep-going", doc, folder]
    code = subprocess.run(command, check=False).returncode
    if code == 0 and not Path(folder, "index.html").exists():
        print("There is no first page.")
        return 1
    return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
