#!/usr/bin/env bash
# Unpacks a source archive on a bare Debian, without a clone, and runs there what its README says: the first run, and tests.
# Usage (as root): packaging/try_archive.sh ARCHIVE RELEASE [FOLDER [WORD...]]
#   ARCHIVE   implam-VERSION.tar.gz, as written by cpack --config build/CPackSourceConfig.cmake
#   RELEASE   bookworm (12) or trixie (13)
#   FOLDER    where the system goes, kept for the next time; outside the repository [/var/tmp/implam-RELEASE]
#   WORD...   for ctest, as in ./setup.sh test WORD... [-L "unit|bad-input"]
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$source_dir/packaging/bare_debian.sh"

archive=${1:-}
release=${2:-}
[[ -f $archive && ( $release == bookworm || $release == trixie ) ]] ||
  complain "Usage: packaging/try_archive.sh ARCHIVE bookworm|trixie [FOLDER [WORD...]]"
shift 2
root=$(system_folder "$source_dir" "$release" "${1:-}")
(($# == 0)) || shift
(($#)) || set -- -L 'unit|bad-input'

set_up "$release" "$root"
rm -rf "$root/root/archive"
mkdir "$root/root/archive"
tar --extract --file "$archive" --directory "$root/root/archive" --strip-components 1
inside "$root" bash -c 'cd /root/archive && ./setup.sh && exec ./setup.sh test "$@"' setup.sh "$@"
