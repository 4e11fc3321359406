#!/bin/sh
# docs/images/tile-blend.png: a cloth from photographs of a hand, repeated as it is and blended. Usage: tile-figure.sh WEFT OUT.png
set -eu
weft=$(realpath "$1")
out=$(realpath "$2")
weave=$(realpath "$(dirname "$0")/../assets/weaves/wool_gabardine.wv")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$weft" synthetic "$weave" --photographs 60 --width 900 --truth-size 0 -q -o hand
"$weft" photographs hand --size 96x96 -o hand.btf.h5
"$weft" compress hand.btf.h5 -o hand.weft
"$weft" tile hand.weft --blend -o tile.weft
for cloth in "hand 4" "tile 6"; do
    set -- $cloth
    "$weft" render "$1.weft" --mesh plane --environment none --repeat "$2" --size 480x360 -o "$1.png"
done
convert hand.png tile.png -bordercolor white -border 3 +append +dither -colors 255 "$out"
