"""Installs a build into a folder and runs a deck from there, without the build's own folders.
Usage: installed.py CMAKE BUILD FOLDER"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "regress"))
from solver_runs import require

FILES = ("bin/implam", "share/man/man1/implam.1", "share/bash-completion/completions/implam",
         "share/zsh/site-functions/_implam", "share/implam/input/peanut.nml", "share/doc/implam/doc/manual/laminate.md",
         "share/doc/implam/LICENSE", "share/doc/implam/CITATION.cff")
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES NONE)
find_package(Implam 0.2 REQUIRED)
get_target_property(program Implam::implam IMPORTED_LOCATION_RELEASE)
file(WRITE "${CMAKE_BINARY_DIR}/found" "${program}\\n${Implam_DECKS}")
"""


def main():
    """Install, check every file, run, and find the package from another project."""
    cmake, build, folder = sys.argv[1], sys.argv[2], Path(sys.argv[3]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    prefix, work = folder / "prefix", folder / "work"
    work.mkdir(parents=True)
    subprocess.run([cmake, "--install", build, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
    for name in FILES:
        require((prefix / name).is_file() and (prefix / name).stat().st_size > 0, f"{name} is not installed.")
    implam, deck = prefix / "bin/implam", prefix / "share/implam/input/small/delamination.nml"
    subprocess.run([implam, deck, "--output", work], check=True, cwd=work, stdout=subprocess.DEVNULL, timeout=120)
    require((work / "delamination_history.csv").is_file(), "The installed program writes no history.")
    (work / "CMakeLists.txt").write_text(PROJECT, encoding="utf-8")
    subprocess.run([cmake, "-G", "Ninja", "-S", work, "-B", work / "build", f"-DCMAKE_PREFIX_PATH={prefix}"],
                   check=True, stdout=subprocess.DEVNULL)
    program, decks = (work / "build/found").read_text(encoding="utf-8").splitlines()
    require(os.path.samefile(program, implam), f"find_package finds {program}.")
    require(os.path.samefile(decks, prefix / "share/implam/input"), f"find_package finds decks in {decks}.")
    print(f"{len(FILES)} files, a run and find_package: done")


if __name__ == "__main__":
    main()
