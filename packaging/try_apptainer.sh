#!/usr/bin/env bash
# Runs the sections of implam.def without Apptainer: each stage in a bare Debian 12, then the test of the image.
# Usage (as root): packaging/try_apptainer.sh [FOLDER]
#   FOLDER    where the two systems go; outside the repository [/var/tmp/implam-apptainer]
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$source_dir/packaging/bare_debian.sh"
folder=$(realpath --canonicalize-missing "${1:-/var/tmp/implam-apptainer}")
[[ $folder/ != "$source_dir"/* ]] || complain "The folder $folder lies within the repository."

# section STAGE NAME: the lines of a section, of stage 1 or 2.
section() {
  awk -v stage="$1" -v name="%$2" '/^Bootstrap:/ { s++; on = 0 } /^%/ { on = s == stage && $0 == name; next } on' \
    "$source_dir/packaging/implam.def"
}

for stage in build final; do
  set_up bookworm "$folder/$stage"
done
rm -rf "$folder/build/implam" "$folder/build/build" "$folder/build/opt/implam" "$folder/final/opt/implam"
mkdir "$folder/build/implam"
git -C "$source_dir" archive HEAD | tar x -C "$folder/build/implam"
inside "$folder/build" sh -e -c "$(section 1 post)"
cp --archive "$folder/build/opt/implam" "$folder/final/opt/implam"
inside "$folder/final" sh -e -c "$(section 2 post)"
inside "$folder/final" sh -e -c "$(section 2 test)"
echo "The image would run."
