#!/bin/sh
# docs/images/look-size.png: weaves twenty times too coarse under a bare lamp, at their size under it, and at their size
# in the studio; docs/images/look-light.png: the three environments, on a weave and on a measured material.
# Usage: look-figures.sh WEFT MEASURED.weft
set -eu
weft=$(realpath "$1")
measured=$(realpath "$2")
source_dir=$(realpath "$(dirname "$0")/..")
images="$source_dir/docs/images"
weaves="$source_dir/assets/weaves"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

draw() { # NAME, then options
    picture=$1
    shift
    "$weft" render "$@" --size 360x250 -q -o "$picture.png"
}
sheet() { # NAME COLUMNS PICTURE...
    picture=$1
    columns=$2
    shift 2
    montage "$@" -tile "$columns" -geometry +2+2 -background white sheet.png
    convert sheet.png -dither FloydSteinberg -colors 256 -strip -define png:compression-level=9 "$images/$picture.png"
}

for cloth in silk_charmeuse:9.375 wool_gabardine:9.375 cotton_denim:18.75; do
    name=${cloth%:*}
    draw "1-$name" "$weaves/$name.wv" --repeat "${cloth#*:}" --environment none
    draw "2-$name" "$weaves/$name.wv" --environment none
    draw "3-$name" "$weaves/$name.wv"
    draw "4-$name" "$weaves/$name.wv" --mesh sphere
done
# One column for each cloth.
set --
for row in 1 2 3 4; do
    for name in silk_charmeuse wool_gabardine cotton_denim; do
        set -- "$@" "$row-$name.png"
    done
done
sheet look-size 3 "$@"

for light in studio overcast sky; do
    draw "a-$light" "$weaves/silk_charmeuse.wv" --environment "$light"
    draw "b-$light" "$measured" --environment "$light"
done
sheet look-light 3 a-studio.png a-overcast.png a-sky.png b-studio.png b-overcast.png b-sky.png
