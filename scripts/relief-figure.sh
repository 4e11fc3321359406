#!/bin/sh
# docs/images/relief.png: a simulated knit between measured views, with and without its heights. Usage: relief-figure.sh WEFT OUT.png
set -eu
weft=$(realpath "$1")
out=$(realpath "$2")
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
