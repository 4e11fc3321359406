#!/bin/sh
# What the depth of a sample does to registration (docs/notes/registration.md): a stitch photographed by the virtual rig and registered, against its
# simulation. About two minutes of processor time. Usage: parallax.sh BUILD [STITCH]    the tile of STITCH must be 1.8 x 1.44 mm
set -eu

build=$(cd "${1:?usage: parallax.sh BUILD [STITCH]}" && pwd)
cd "$(dirname "$0")/.."
stitch=${2:-assets/stitches/plain_knit.stitch}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cmake --build "$build" --target weft bench_parallax bench_truth

views='0,0 15,0 15,90 30,0 30,90 45,0 45,90 60,0 60,90 75,0 75,90'
lights='0,0 30,0 30,60 30,120 30,180 30,240 30,300 60,30 60,90 60,150 60,210 60,270 60,330'
{
    echo 'theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg'
    for view in $views; do
        for light in $lights; do
            echo "$light,$view"
        done
    done
} >"$scratch/plan.csv"
{
    echo 'theta_deg,phi_deg'
    printf '%s\n' $views $lights | sort -u
} >"$scratch/directions.csv"
# 8 x 10 tiles in the opening; a pixel is half a texel of the dataset.
echo '{"rig": "virtual", "opening_mm": 14.4, "width_px": 1040, "height_px": 1040, "focal_length_px": 10667}' >"$scratch/rig.json"

weft=$build/cli/weft
"$weft" capture --rig "$scratch/rig.json" --sample "$stitch" --plan "$scratch/plan.csv" -o "$scratch/session" --truth-size 160 --truth-images 11
"$weft" register "$scratch/session" --size 160x160 -o "$scratch/registered.btf.h5"
"$weft" simulate "$stitch" -o "$scratch/simulated.btf.h5" --plane top --heights off --size 20x16 --directions "$scratch/directions.csv"
"$build/bench/bench_truth" "$scratch/session" "$scratch/registered.btf.h5" "$scratch/session.truth.h5"
"$build/bench/bench_parallax" "$stitch" "$scratch/registered.btf.h5" "$scratch/simulated.btf.h5"
