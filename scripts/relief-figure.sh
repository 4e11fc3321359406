#!/bin/sh
# docs/images/relief.png: a simulated knit between measured views, with and without its heights; compressed, in
# docs/images/relief-layers.png; and with its texels moved onto the plane, in docs/images/relief-move.png.
# Usage: relief-figure.sh WEFT OUT.png LAYERS.png MOVE.png
set -eu
weft=$(realpath "$1")
out=$(realpath "$2")
layers=$(realpath "$3")
moved=$(realpath "$4")
stitch=$(realpath "$(dirname "$0")/../assets/stitches/plain_knit.stitch")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$weft" simulate "$stitch" --plane top -o knit.btf.h5 --size 40x32 --noise 2
for relief in off on; do
    "$weft" render knit.btf.h5 --relief "$relief" --mesh plane --repeat 3.2 --camera -90,30,1.6 --light 45,120 --size 640x360 -o "$relief.png"
done
convert off.png on.png -bordercolor white -border 3 +append -colors 200 "$out"

"$weft" simulate "$stitch" --plane top -o coarse.btf.h5 --size 20x16 --noise 2 --directions ubo81
"$weft" compress coarse.btf.h5 -o coarse.weft --components 32
for relief in off on; do
    "$weft" render coarse.weft --relief "$relief" --filter exact --mesh plane --repeat 3.2 --camera -90,30,1.6 --light 45,120 --size 640x360 -o "layers-$relief.png"
done
convert layers-off.png layers-on.png -bordercolor white -border 3 +append -colors 200 "$layers"

"$weft" simulate "$stitch" --plane top -o still.btf.h5 --size 32x32 --noise 3 --directions ubo81
"$weft" relief still.btf.h5 --move on -o moved.btf.h5
for name in still moved; do
    "$weft" compress "$name.btf.h5" -o "$name-2.weft" --lobes 2
    "$weft" compress "$name.btf.h5" -o "$name-32.weft" --components 32
    for model in 2 32; do
        "$weft" render "$name-$model.weft" --filter exact --mesh plane --repeat 3.2 --camera -90,30,1.6 --light 45,120 --size 480x270 -o "$name-$model.png"
    done
done
montage still-2.png moved-2.png still-32.png moved-32.png -tile 2x2 -geometry +3+3 grid.png
convert grid.png -colors 64 "$moved"
