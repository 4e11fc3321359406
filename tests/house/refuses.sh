#!/bin/sh
# Compiles two includes as a source of a room would be compiled: the first must be found, the second must not.
# Usage: refuses.sh COMPILER ALLOWED REFUSED INCLUDE-PATH...
set -u

compiler=$1 allowed=$2 refused=$3
shift 3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for folder in "$@"; do
    printf '%s\n' "-I$folder"
done >"$scratch/path"

compiles() {
    printf '#include "%s"\n' "$1" >"$scratch/source.c"
    "$compiler" -std=c17 -D_GNU_SOURCE @"$scratch/path" -fsyntax-only "$scratch/source.c" 2>"$scratch/errors"
}

compiles "$allowed" || {
    cat "$scratch/errors"
    echo "$allowed: not found, so this test would refuse everything"
    exit 1
}
if compiles "$refused"; then
    echo "$refused: compiles, though the room may not include it"
    exit 1
fi
grep -q "$refused: No such file" "$scratch/errors" || {
    cat "$scratch/errors"
    echo "$refused: refused for another reason than its absence"
    exit 1
}
