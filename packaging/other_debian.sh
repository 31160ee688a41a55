#!/usr/bin/env bash
# Builds and tests Implam on another release of Debian: a bare system in a folder of its own, and the last commit in it.
# Usage (as root): packaging/other_debian.sh RELEASE [FOLDER [WORD...]]
#   RELEASE   bookworm (12) or trixie (13)
#   FOLDER    where the system goes, kept for the next time; outside the repository [/var/tmp/implam-RELEASE]
#   WORD...   for ctest, as in ./setup.sh test WORD...
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

complain() {
  echo "$1" >&2
  exit 1
}

release=${1:-}
[[ $release == bookworm || $release == trixie ]] || complain "Usage: packaging/other_debian.sh bookworm|trixie [FOLDER [WORD...]]"
shift
root=$(realpath --canonicalize-missing "${1:-/var/tmp/implam-$release}")
(($# == 0)) || shift
[[ $root/ != "$source_dir"/* ]] || complain "The folder $root lies within the repository."
((EUID == 0)) || complain "A system in a folder can only be set up and entered by root."

# Packages come from where this machine has its own, by the same proxy and with the same certificates.
bootstrap() {
  local mirror proxy=
  if ! command -v debootstrap >/dev/null; then
    apt-get -qq update
    apt-get -qq install --no-install-recommends debootstrap
  fi
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Identifier: Packages' 'Origin: Debian' 'Label: Debian' | head -n 1)
  eval "$(apt-config shell proxy Acquire::http::Proxy)"
  [[ -z $proxy ]] || export http_proxy=$proxy
  echo "== Setting up Debian's $release in $root"
  debootstrap --variant=minbase --include=ca-certificates "$release" "$root" ${mirror:+"$mirror"} >"$root.log" ||
    complain "debootstrap failed; its log is $root.log."
  touch "$root/complete"
}

# What the system needs to reach the same packages as this machine.
share_network() {
  local file
  apt-config dump | grep -E '^Acquire::(https?|Check-[A-Za-z-]*)(::| )' >"$root/etc/apt/apt.conf.d/90machine" || true
  for file in /etc/resolv.conf /etc/hosts /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do
    [[ ! -e $file ]] || cp --dereference "$file" "$root$file"
  done
}

# The last commit, in the clone of the time before if there is one, so that only what has changed is compiled.
update_clone() {
  local clone=$root/root/implam commit
  commit=$(git -C "$source_dir" rev-parse HEAD)
  git -C "$source_dir" diff --quiet HEAD || echo "Note: what is not committed stays out of the test."
  [[ -d $clone ]] || git clone --quiet --no-checkout "$source_dir" "$clone"
  git -C "$clone" fetch --quiet "$source_dir" "$commit"
  git -C "$clone" checkout --quiet --force --detach "$commit"
}

mkdir --parents "$root"
[[ -e $root/complete ]] || bootstrap
share_network
update_clone
# The mounts are seen by this command alone and end with it.
exec unshare --mount bash -c '
  set -e
  root=$1
  shift
  mount --rbind /dev "$root/dev"
  mount --rbind /sys "$root/sys"
  mount -t proc proc "$root/proc"
  exec chroot "$root" /usr/bin/env HOME=/root TMPDIR=/tmp PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    bash -c "cd && exec implam/setup.sh test \"\$@\"" setup.sh "$@"' enter "$root" "$@"
