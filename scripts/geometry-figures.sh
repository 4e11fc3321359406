#!/bin/sh
# The pictures and figures of docs/notes/geometry.md and docs/notes/truth.md that compare drapes: simulates six stitches, compresses them and draws them; with "truth" also
# traces four of them. About ten minutes of processor time, fifteen with the truth. Usage: geometry-figures.sh BUILD FOLDER [truth]
set -eu

build=$(cd "${1:?usage: geometry-figures.sh BUILD FOLDER [truth]}" && pwd)
mkdir -p "${2:?usage: geometry-figures.sh BUILD FOLDER [truth]}"
folder=$(cd "$2" && pwd)
truth=${3-}
stitches=$(cd "$(dirname "$0")/../assets/stitches" && pwd)
cmake --build "$build" --target weft
weft=$build/cli/weft
cd "$folder"

# Pictures in rows of $2, with captions where the arguments say so, into $1.
join() {
    result=$1 columns=$2
    shift 2
    montage -font DejaVu-Sans -pointsize 14 "$@" -geometry +3+3 -tile "${columns}x" -depth 8 -strip -quality 95 "$result"
}

for stitch in plain_knit:40x32 purl_knit:40x32 two_colour_loops:32x32 satin:32x32 ribs:32x32 open_weave:32x32; do
    name=${stitch%:*}
    [ -e "$name.btf.h5" ] || "$weft" simulate "$stitches/$name.stitch" --size "${stitch#*:}" --noise 3 --plane top --heights off -o "$name.btf.h5"
    "$weft" compress "$name.btf.h5" --lobes 2 -o "$name.weft"
done
"$weft" compress two_colour_loops.btf.h5 --lobes 1 -o lobes.weft

# With and without mip levels.
drape="--shadows=on --no-labels --quiet --size 420x380"
far="$drape --repeat 150 --camera=-70,34,3.3 --light 50,-120"
for format in png exr; do
    "$weft" render plain_knit.weft $far --level none --samples 1 -o "one.$format"
    "$weft" render plain_knit.weft $far --samples 1 -o "mip.$format"
    "$weft" render plain_knit.weft $far --level none --samples 16 -o "many.$format"
done
for picture in one mip; do
    oiiotool "$picture.exr" many.exr --diff | grep RMS || true
done
join drape-levels.png 3 -label 'without mip-mapping' one.png -label 'with mip-mapping' mip.png -label '256 samples a pixel' many.png

# With and without T.
near="--shadows=on --no-labels --quiet --size 420x340 --repeat 24 --camera=20,16,3.2 --light 45,0 --exposure 1.2"
"$weft" render lobes.weft $near -o lobes.png
"$weft" render --raw two_colour_loops.btf.h5 $near -o data.png
"$weft" render two_colour_loops.weft $near -o table.png
join drape-table.png 3 -label 'lobes alone' lobes.png -label 'dataset' data.png -label 'lobes and T' table.png

# Six stitches.
for name in plain_knit two_colour_loops purl_knit satin ribs open_weave; do
    "$weft" render "$name.weft" $drape --repeat 24 --camera=-70,30,3.4 --light 45,-120 -o "$name.png"
done
join drape-stitches.png 3 -resize 340x340 -label 'plain knit' plain_knit.png -label 'loops in two colours' two_colour_loops.png -label 'purl knit' \
    purl_knit.png -label satin satin.png -label ribs ribs.png -label 'open weave' open_weave.png

[ "$truth" = truth ] || exit 0
for name in satin plain_knit two_colour_loops open_weave; do
    "$weft" compare "$name.btf.h5" "$name.weft" --truth "$stitches/$name.stitch" -o "$name"
    set -- "$@" "$name/truth-0-all-raw.png" "$name/truth-0-all-compressed.png" "$name/truth-0-all-truth.png" \
        "$name/truth-0-all-compressed-minus-truth.png"
done
shift 3
join drape-truth.png 4 -resize 260x260 "$@"
