#!/bin/sh
# A capture with a camera on a network. Usage: tether.sh WEFT ASSETS PYTHON
set -eu
[ -n "${3-}" ] && [ -x "$3" ] || { echo "needs python3" && exit 77; }
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$3" "$here/tether.py" "$1" "$2"
