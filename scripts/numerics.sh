#!/bin/sh
# Measures the errors of every model again and replaces the tables of docs/notes/numerics.md:
# the text between <!-- numerics SECTION --> and <!-- end -->. Fails where a bound does not hold; the page then stays as it is.
# Usage: numerics.sh BUILD [EVALUATIONS]    evaluations in each search of a cheap model (3000)
set -eu

build=$(cd "${1:?usage: numerics.sh BUILD [EVALUATIONS]}" && pwd)
evaluations=${2:-3000}
cd "$(dirname "$0")/.."
page=docs/notes/numerics.md
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cmake --build "$build" --target bench_numerics
LIBGL_ALWAYS_SOFTWARE=1 "$build/bench/numerics/bench_numerics" "$evaluations" >"$scratch/sections"

awk -v sections="$scratch/sections" '
    BEGIN {
        while ((getline line < sections) > 0)
            if (line ~ /^<!-- numerics /) name = line
            else text[name] = text[name] line "\n"
    }
    /^<!-- end -->$/ { skipping = 0 }
    !skipping { print }
    /^<!-- numerics [a-z]+ -->$/ {
        skipping = 1
        printf "%s", text[$0]
    }' "$page" >"$scratch/page"
cp "$scratch/page" "$page"
