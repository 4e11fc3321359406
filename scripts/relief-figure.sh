#!/bin/sh
# docs/images/relief.png: a simulated knit between measured views, with and without its heights; and compressed, in
# docs/images/relief-layers.png. Usage: relief-figure.sh WEFT OUT.png LAYERS.png
set -eu
weft=$(realpath "$1")
out=$(realpath "$2")
layers=$(realpath "$3")
stitch=$(realpath "$(dirname "$0")/../assets/stitches/plain_knit.stitch")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$weft" simulate "$stitch" -o knit.btf.h5 --size 40x32 --noise 2
"$weft" relief knit.btf.h5
for relief in off on; do
    "$weft" render knit.btf.h5 --relief "$relief" --mesh plane --repeat 3.2 --camera -90,30,1.6 --light 45,120 --size 640x360 -o "$relief.png"
done
convert off.png on.png -bordercolor white -border 3 +append -colors 200 "$out"

"$weft" simulate "$stitch" -o coarse.btf.h5 --size 20x16 --noise 2 --directions ubo81
"$weft" relief coarse.btf.h5
"$weft" compress coarse.btf.h5 -o coarse.weft --layers 32
for relief in off on; do
    "$weft" render coarse.weft --relief "$relief" --filter exact --mesh plane --repeat 3.2 --camera -90,30,1.6 --light 45,120 --size 640x360 -o "layers-$relief.png"
done
convert layers-off.png layers-on.png -bordercolor white -border 3 +append -colors 200 "$layers"
