#!/bin/sh
# The shared library exports exactly the functions that the public headers declare.
# Usage: exported.sh NM LIBRARY INCLUDE
set -eu
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat "$3"/weft/*.h | sed -n 's/^WEFT_API [^(]*\b\(weft_[a-z0-9_]*\)(.*/\1/p' | sort >"$scratch/declared"
"$1" -D --defined-only "$2" | awk '{ print $NF }' | sort >"$scratch/exported"
[ "$(wc -l <"$scratch/declared")" -ge 40 ] || { echo "the headers declare few functions"; exit 1; }
diff "$scratch/declared" "$scratch/exported" || { echo "declared (<) and exported (>) differ"; exit 1; }
echo "$(wc -l <"$scratch/exported") functions"
