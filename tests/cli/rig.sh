#!/bin/sh
# A capture with a rig that an operator sets by hand. Usage: rig.sh WEFT ASSETS PYTHON
set -eu
[ -n "${3-}" ] && [ -x "$3" ] || { echo "needs python3" && exit 77; }
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$3" "$here/rig.py" "$1" "$2"
