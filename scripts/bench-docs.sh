#!/bin/sh
# Measures the fit again and replaces its tables in docs/notes/benchmarks.md:
# the text between <!-- bench_fit SECTION --> and <!-- end -->.
# Usage: bench-docs.sh BUILD [TEXELS]; with the demo's dataset in demo-out/ also its speed
set -eu

build=$(cd "${1:?usage: bench-docs.sh BUILD [TEXELS]}" && pwd)
texels=${2:-100}
cd "$(dirname "$0")/.."
page=docs/notes/benchmarks.md
dataset=demo-out/gabardine.btf.h5
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

for section in speed quality extensions instruction-sets tape pass; do
    "$build/bench/bench_fit" --texels "$texels" --only "$section" --markdown >"$scratch/$section"
done
if [ -e "$dataset" ]; then
    "$build/bench/bench_fit" --texels "$texels" --only speed --markdown "$dataset" >>"$scratch/speed"
fi

awk -v scratch="$scratch" '
    /^<!-- end -->$/ { skipping = 0; print "" }
    !skipping { print }
    /^<!-- bench_fit [a-z-]+ -->$/ {
        skipping = 1
        while ((getline line < (scratch "/" $3)) > 0) print line
    }' "$page" >"$scratch/page"
cp "$scratch/page" "$page"
