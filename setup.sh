#!/usr/bin/env bash
# ./setup.sh                installs what is missing, builds Implam and strikes a first plate
# ./setup.sh test [WORD...]  the same set-up, then builds and runs the tests; words go to ctest, such as -j 8
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

task=${1:-run}
(($# == 0)) || shift
if [[ $task != test ]] && { [[ $task != run ]] || (($#)); }; then
  echo "Usage: ./setup.sh [test [WORD...]], the words being those of ctest" >&2
  exit 1
fi

packages=(gfortran cmake ninja-build pkg-config git openmpi-bin libopenmpi-dev libpetsc-real-dev libmumps-dev
  libmetis-dev libhdf5-openmpi-dev libopenblas0-pthread hdf5-tools python3-venv)
# Without these some tests are skipped.
test_packages=(calculix-ccx slurm-wlm munge patch zsh)

# What happens now, since each stage may take a minute.
stage() {
  echo "== $1"
}

# is_missing PACKAGE
is_missing() {
  [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) != installed ]]
}

# is_offered PACKAGE: not every release of Debian has every one.
is_offered() {
  [[ $(LC_ALL=C apt-cache policy "$1") == *"Candidate: "[!\(]* ]]
}

# quietly WORD...: runs a command whose output is shown only if it fails.
quietly() {
  local log
  log=$(mktemp)
  if ! "$@" >"$log" 2>&1; then
    cat "$log" >&2
    exit 1
  fi
  rm "$log"
}

# run_apt WORD...: apt and dpkg print every package three times.
run_apt() {
  DEBIAN_FRONTEND=noninteractive quietly apt-get -o DPkg::Lock::Timeout=300 -qq "$@"
}

# build WORD...: without a terminal ninja prints a line for each of 840 files.
build() {
  if [[ -t 1 ]]; then
    cmake --build --preset release "$@"
  else
    quietly cmake --build --preset release "$@"
  fi
}

install_packages() {
  local missing=() wanted=() package
  if ! command -v apt-get >/dev/null; then
    echo "No apt here: assuming that a Fortran compiler, CMake, Ninja, MPI, PETSc, CHOLMOD, METIS and parallel HDF5 are there."
    return
  fi
  for package in "${packages[@]}"; do
    ! is_missing "$package" || missing+=("$package")
  done
  [[ $task == run ]] || for package in "${test_packages[@]}"; do
    ! is_missing "$package" || wanted+=("$package")
  done
  ((${#missing[@]} + ${#wanted[@]})) || return 0
  if ((EUID != 0)); then
    echo "Packages are missing; as root run: apt-get install --no-install-recommends ${missing[*]} ${wanted[*]}" >&2
    ((${#missing[@]} == 0)) || exit 1
    return 0
  fi
  run_apt update
  for package in "${wanted[@]}"; do
    if is_offered "$package"; then missing+=("$package"); else echo "This release has no package $package."; fi
  done
  ((${#missing[@]})) || return 0
  stage "Installing ${#missing[@]} packages: ${missing[*]}"
  run_apt install --no-install-recommends "${missing[@]}"
}

# The commands that check and plot results go into .venv, and with them, for the tests, checkers of style and types,
# readers of field files and of Nastran's, and the builder of pages. pyNastran comes by itself, as its package asks for an older
# numpy than it needs.
install_python_tools() {
  local stamp=.venv/ready-to-$task tools=(./postproc) pynastran=() pages=() python=/usr/bin/python3
  if [[ $task == test ]]; then
    tools=('./postproc[nastran,notebook]' 'ruff==0.17.*' 'mypy==2.4.*' meshio)
    pages=(--only-binary :all: -r doc/requirements.txt)
    pynastran=(--no-deps 'pyNastran==1.4.*')
  fi
  [[ -x $python ]] || python=python3
  if [[ -e $stamp && -z $(find postproc doc/requirements.txt -newer "$stamp" \( -name '*.py' -o -name '*.html' \
      -o -name pyproject.toml -o -name requirements.txt \)) ]]; then
    return
  fi
  stage "Installing the Python commands into .venv"
  if { [[ -x .venv/bin/pip ]] || "$python" -m venv --clear .venv; } &&
    .venv/bin/pip install --quiet --disable-pip-version-check "${tools[@]}" &&
    { ((${#pages[@]} == 0)) || .venv/bin/pip install --quiet --disable-pip-version-check "${pages[@]}"; } &&
    { ((${#pynastran[@]} == 0)) || .venv/bin/pip install --quiet --disable-pip-version-check "${pynastran[@]}"; }; then
    touch "$stamp"
  else
    echo "Warning: Python's venv or pip failed (see above), so the commands that check and plot results are left out." >&2
  fi
}

install_packages
install_python_tools
stage "Configuring"
quietly cmake --preset release

if [[ $task == test ]]; then
  stage "Building program and tests"
  build
  stage "Testing"
  status=0
  ctest --preset release --output-junit "$PWD/build/tests.xml" --test-output-size-passed 100000 "$@" || status=$?
  python=.venv/bin/python
  [[ -x $python ]] || python=python3
  "$python" -B tests/skipped.py build/tests.xml
  exit $status
fi

stage "Building the program (some minutes)"
build --target implam
stage "Striking a first plate, input/peanut.nml"
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
build/implam input/peanut.nml --output results/peanut
echo
echo "Done. The history of force, deflection and energies is in results/peanut/peanut_history.csv,"
echo "the fields for ParaView in results/peanut/peanut.xdmf."
if [[ -x .venv/bin/implam-plot ]]; then
  echo "To draw the delamination: .venv/bin/implam-plot results/peanut/peanut.h5 --save results/peanut/peanut.png"
fi
