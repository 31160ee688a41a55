#!/usr/bin/env bash
# ./setup.sh       installs what is missing, builds Implam and strikes a first plate
# ./setup.sh test  the same set-up, then builds and runs the tests
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

task=${1:-run}
if [[ $task != run && $task != test ]] || (($# > 1)); then
  echo "Usage: ./setup.sh [test]" >&2
  exit 1
fi

packages=(gfortran cmake ninja-build pkg-config git openmpi-bin libopenmpi-dev libpetsc-real-dev libmumps-dev
  libsuitesparse-dev libmetis-dev libhdf5-openmpi-dev libopenblas0-pthread hdf5-tools python3-venv)

# What happens now, since each stage may take a minute.
stage() {
  echo "== $1"
}

install_packages() {
  local missing=() package log
  if ! command -v apt-get >/dev/null; then
    echo "No apt here: assuming that a Fortran compiler, CMake, Ninja, MPI, PETSc, CHOLMOD, METIS and parallel HDF5 are there."
    return
  fi
  for package in "${packages[@]}"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    echo "Packages are missing; as root run: apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  stage "Installing ${#missing[@]} packages: ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  log=$(mktemp)
  # apt and dpkg tell every package three times; what they say is shown if they fail.
  if ! { apt-get -o DPkg::Lock::Timeout=300 -qq update &&
    apt-get -o DPkg::Lock::Timeout=300 -qq install --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    cat "$log" >&2
    exit 1
  fi
  rm "$log"
}

# The commands that check and plot results go into .venv, and with them, for the tests, a checker of style and readers
# of field files.
install_python_tools() {
  local stamp=.venv/ready-to-$task tools=(./postproc) python=/usr/bin/python3
  [[ $task == run ]] || tools+=('ruff==0.17.*' h5py meshio)
  [[ -x $python ]] || python=python3
  if [[ -e $stamp && -z $(find postproc -name '*.py' -newer "$stamp" -o -name pyproject.toml -newer "$stamp") ]]; then
    return
  fi
  stage "Installing the Python commands into .venv"
  if { [[ -x .venv/bin/pip ]] || "$python" -m venv --clear .venv; } &&
    .venv/bin/pip install --quiet --disable-pip-version-check "${tools[@]}"; then
    touch "$stamp"
  else
    echo "Warning: Python's venv or pip failed (see above), so the commands that check and plot results are left out." >&2
  fi
}

install_packages
install_python_tools
stage "Configuring"
cmake --preset release

if [[ $task == test ]]; then
  stage "Building program and tests"
  cmake --build --preset release
  stage "Testing"
  exec ctest --preset release
fi

stage "Building the program"
cmake --build --preset release --target implam
stage "Striking a first plate, input/peanut.nml"
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
build/implam input/peanut.nml --output results/peanut
echo
echo "Done. The history of force, deflection and energies is in results/peanut/peanut_history.csv,"
echo "the fields for ParaView in results/peanut/peanut.xdmf."
if [[ -x .venv/bin/implam-plot ]]; then
  echo "To draw the delamination: .venv/bin/implam-plot results/peanut/peanut.h5"
fi
