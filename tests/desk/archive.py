"""Makes the source archive twice: each contains the commit and the files that git does not ignore, and no others.
Usage: archive.py CPACK BUILD SOURCE"""

import subprocess
import sys
import tarfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "regress"))
from solver_runs import require


def known_files(source):
    """Return the existing files that git tracks or does not ignore."""
    listed = subprocess.run(["git", "-C", source, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            check=True, capture_output=True, text=True).stdout
    return {name for name in listed.split("\0") if name and (source / name).is_file()}


def archived_files(archive):
    """Return the files of an archive, without its own folder's name."""
    with tarfile.open(archive) as file:
        return {member.name.partition("/")[2] for member in file if not member.isdir()}


def main():
    """Make the archive twice in the clone, as for a second release."""
    cpack, build, source = sys.argv[1], *map(Path, sys.argv[2:])
    expected = known_files(source) | {"COMMIT"}  # before the first archive, which might leave files
    for stale in build.glob("implam-*.tar.gz"):
        stale.unlink()
    for _ in range(2):
        subprocess.run([cpack, "--config", build / "CPackSourceConfig.cmake"], check=True, cwd=source,
                       stdout=subprocess.DEVNULL)
        found = list(build.glob("implam-*.tar.gz"))
        require(len(found) == 1, f"{len(found)} archives are in the folder of the build.")
        differing = archived_files(found[0]) ^ expected
        require(not differing, f"Archive and clone differ in {len(differing)} files: {sorted(differing)[:5]}")
    print(f"{len(expected)} files, twice: done")


if __name__ == "__main__":
    main()
