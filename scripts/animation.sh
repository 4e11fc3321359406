#!/bin/sh
# docs/images/moving-light.webp, for the README: what `make demo` left, under a light that goes round, with two lines that wipe
# between its photographs, its material and its analytic cloth. Usage: animation.sh WEFT DEMO-OUT [WORK]
set -eu
weft=$(realpath "$1")
demo=$(realpath "$2")
source_dir=$(cd "$(dirname "$0")/.." && pwd)
work=${3:-$(mktemp -d)}
mkdir -p "$work"
work=$(realpath "$work")
[ -n "${3:-}" ] || trap 'rm -rf "$work"' EXIT
width=480 height=340 frames=36 per_second=9
cd "$work"

path=$source_dir/assets/paths/light-round.csv
draw() { # MODE, then what it shows
    mode=$1
    shift
    "$weft" render "$@" --mode "$mode" --repeat 40 --path "$path" --fps $per_second --camera=-70,26,3.4 --exposure 1 --no-labels \
        --samples 3 --size ${width}x$height -q -o "$mode-%02d.png"
}
draw raw "$demo/gabardine.weft" --raw "$demo/gabardine.btf.h5"
draw compressed "$demo/gabardine.weft"
draw analytic --weave "$source_dir/assets/weaves/wool_gabardine.wv"

# ImageMagick's own font is a file of Ghostscript, which need not be there; this one comes with the packages.
font=$(fc-match -f '%{file}' Roboto)
label() { # X TEXT
    echo "text $1,$((height - 14)) '$2'"
}
for frame in $(seq 0 $((frames - 1))); do
    number=$(printf %02d "$frame")
    # Both lines swing once while the light goes round.
    lines=$(awk -v f="$frame" -v n=$frames -v w=$width 'BEGIN {
        s = 0.16 * sin(2 * 3.14159265 * f / n); printf "%d %d", w * (1 / 3 + s), w * (2 / 3 + s) }')
    first=${lines% *} second=${lines#* }
    convert "compressed-$number.png" \
        \( "raw-$number.png" -crop "${first}x$height+0+0" +repage \) -geometry +0+0 -composite \
        \( "analytic-$number.png" -crop "$((width - second))x$height+$second+0" +repage \) -geometry "+$second+0" -composite \
        -stroke white -draw "line $first,0 $first,$height line $second,0 $second,$height" -stroke none -fill white -font "$font" -pointsize 13 \
        -draw "$(label 12 photographs)" -draw "$(label $((first + 12)) compressed)" -draw "$(label $((second + 12)) 'woven model')" \
        "frame-$number.png"
done
convert -delay $((100 / per_second)) -loop 0 frame-*.png -quality 82 -define webp:method=6 "$source_dir/docs/images/moving-light.webp"
