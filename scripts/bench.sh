#!/bin/sh
# Builds and runs every bench, in turn (docs/notes/benchmarks.md).
# Usage: bench.sh BUILD [TEXELS [SIZE]]    texels of each family in the bench of the fit (100), SIZE x SIZE texels for the whole job (64)
set -eu

build=$(cd "${1:?usage: bench.sh BUILD [TEXELS [SIZE]]}" && pwd)
texels=${2:-100}
size=${3:-64}
cd "$(dirname "$0")/.."
demo='demo-out/gabardine'
weave=assets/weaves/wool_gabardine.wv

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

heading() {
    printf '\n== %s\n' "$*"
}

cmake --build "$build" --target benches weft

heading "Evaluations a second of the models, one core"
"$build/bench/bench_reflectance"

if [ -e "$build/bench/numerics/bench_numerics" ]; then
    heading "Worst-case errors of the models against binary128"
    "$build/bench/numerics/bench_numerics" 2000
fi

heading "Fits of a texel against general solvers, one core"
"$build/bench/bench_fit" --texels "$texels"
if [ -e "$demo.btf.h5" ]; then
    "$build/bench/bench_fit" --texels "$texels" --only speed "$demo.btf.h5"
fi

heading "The whole job: reading, fitting all levels, writing, all cores"
"$build/bench/bench_large_dataset" "$scratch/cloth.btf.h5" "$size"
"$build/bench/bench_compress" "$scratch/cloth.btf.h5"

heading "Cloth from geometry, and the representation of Daubert et al. 2001 beside Weft's"
"$build/cli/weft" simulate assets/stitches/plain_knit.stitch -o "$scratch/knit.btf.h5" --size 16x16 --noise 2 --plane top --heights off
"$build/bench/bench_paper" "$scratch/knit.btf.h5"

heading "Aliasing of the drape seen from afar"
"$build/bench/bench_aliasing"

heading "Frame times of the player"
if [ -e "$demo.weft" ] && [ -e "$demo.btf.h5" ]; then
    "$build/bench/bench_player" "$demo.weft" "$demo.btf.h5" "$weave" 4
    "$build/bench/bench_raw_formats" "$demo.btf.h5"
else
    "$build/bench/bench_player" "$weave" 4
fi

heading "One view under many lamps: RTI's models and Weft"
"$build/bench/bench_rti"

heading "Registration against the ground truth of the virtual rig"
if [ -e "$demo.truth.h5" ] && [ -e "$demo.btf.h5" ]; then
    "$build/bench/bench_truth" "$demo" "$demo.btf.h5" "$demo.truth.h5"
else
    printf 'Skipped: no session in %s; make demo takes one.\n' "$demo"
fi
