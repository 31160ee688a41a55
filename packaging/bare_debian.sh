# Functions for a bare Debian in a folder, for scripts that source this file; only root can set one up and enter it.

complain() {
  echo "$1" >&2
  exit 1
}

# system_folder SOURCE RELEASE FOLDER: where the system goes, outside the source; FOLDER is empty where none is given.
system_folder() {
  local source=$1 release=$2 root
  root=$(realpath --canonicalize-missing "${3:-/var/tmp/implam-$release}")
  [[ $root/ != "$source"/* ]] || complain "The folder $root lies within the repository."
  echo "$root"
}

# set_up RELEASE ROOT: packages come from where this machine has its own, by the same proxy and with the same certificates.
set_up() {
  local release=$1 root=$2 mirror proxy=
  ((EUID == 0)) || complain "A system in a folder can only be set up and entered by root."
  mkdir --parents "$root"
  if [[ ! -e $root/complete ]]; then
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
  fi
  share_network "$root"
}

# share_network ROOT: what the system needs to reach the same packages as this machine.
share_network() {
  local root=$1 file
  apt-config dump | grep -E '^Acquire::(https?|Check-[A-Za-z-]*)(::| )' >"$root/etc/apt/apt.conf.d/90machine" || true
  for file in /etc/resolv.conf /etc/hosts /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do
    [[ ! -e $file ]] || cp --dereference "$file" "$root$file"
  done
}

# inside ROOT WORD...: a command in the system. The mounts are seen by this command alone and end with it.
inside() {
  unshare --mount bash -c '
    set -e
    root=$1
    shift
    mount --rbind /dev "$root/dev"
    mount --rbind /sys "$root/sys"
    mount -t proc proc "$root/proc"
    exec chroot "$root" /usr/bin/env HOME=/root TMPDIR=/tmp PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"' inside "$@"
}
