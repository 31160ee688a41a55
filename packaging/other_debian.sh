#!/usr/bin/env bash
# Builds and tests Implam on another release of Debian: a bare system in a folder of its own, and the last commit in it.
# Usage (as root): packaging/other_debian.sh RELEASE [FOLDER [WORD...]]
#   RELEASE   bookworm (12) or trixie (13)
#   FOLDER    where the system goes, kept for the next time; outside the repository [/var/tmp/implam-RELEASE]
#   WORD...   for ctest, as in ./setup.sh test WORD...
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$source_dir/packaging/bare_debian.sh"

release=${1:-}
[[ $release == bookworm || $release == trixie ]] || complain "Usage: packaging/other_debian.sh bookworm|trixie [FOLDER [WORD...]]"
shift
root=$(system_folder "$source_dir" "$release" "${1:-}")
(($# == 0)) || shift

# The last commit, in the clone of the time before if there is one, so that only what has changed is compiled.
update_clone() {
  local clone=$root/root/implam commit
  commit=$(git -C "$source_dir" rev-parse HEAD)
  git -C "$source_dir" diff --quiet HEAD || echo "Note: what is not committed stays out of the test."
  [[ -d $clone ]] || git clone --quiet --no-checkout "$source_dir" "$clone"
  git -C "$clone" fetch --quiet "$source_dir" "$commit"
  git -C "$clone" checkout --quiet --force --detach "$commit"
}

set_up "$release" "$root"
update_clone
inside "$root" bash -c 'cd && exec implam/setup.sh test "$@"' setup.sh "$@"
