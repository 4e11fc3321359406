#!/bin/sh
# docs/images/sources.png: the stacks of weft truth for all weaves and all stitches. Takes a quarter of an hour and needs
# rsvg-convert. With reports that are there already, it draws those.
# Usage: truth-figure.sh WEFT OUT.png [REPORT-OF-WEAVES REPORT-OF-STITCHES]
set -eu
weft=$(realpath "$1")
out=$(realpath "$2")
assets=$(realpath "$(dirname "$0")/../assets")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
weaves=$(realpath -m "${3:-$work/weaves}")
stitches=$(realpath -m "${4:-$work/stitches}")
cd "$work"
if [ ! -e "$weaves/index.html" ]; then
    echo '{"rig": "virtual", "width_px": 208, "height_px": 208, "focal_length_px": 960, "samples_per_pixel": 8}' >weaves.json
    "$weft" truth "$assets"/weaves/*.wv --rig weaves.json --texels 16 --queries 3000 -o "$weaves"
fi
if [ ! -e "$stitches/index.html" ]; then
    echo '{"rig": "virtual", "width_px": 144, "height_px": 144, "focal_length_px": 660, "samples_per_pixel": 4}' >stitches.json
    cd "$assets/stitches"
    "$weft" truth plain_weave.stitch twill.stitch satin.stitch open_weave.stitch ribs.stitch plain_knit.stitch purl_knit.stitch \
        two_colour_loops.stitch --rig "$work/stitches.json" --texels 12 --queries 1000 -o "$stitches"
    cd "$work"
fi

style='<style>text { font-family: sans-serif; font-size: 12px; fill: #555; } .label { font-weight: 600; fill: #111; }
.bar, tspan.key { fill: currentColor; } .whole { fill: none; stroke: #111; stroke-width: 1.6; } .grid path { stroke: #ccc; }
.colour0 { color: #33689e; } .colour1 { color: #c8384e; } .colour2 { color: #1f7a33; } .colour3 { color: #93700a; }</style>'
for report in "$weaves" "$stitches"; do
    sed -n '/<svg class="plot"/,/<\/svg>/p' "$report/index.html" |
        sed 's|<svg class="plot"|<svg xmlns="http://www.w3.org/2000/svg" class="plot"|' >plot.svg
    { head -1 plot.svg; echo "$style"; tail -n +2 plot.svg; } >styled.svg
    rsvg-convert -w 900 -b white styled.svg >"$(basename "$report").part.png"
done
convert "$(basename "$weaves").part.png" "$(basename "$stitches").part.png" -append -colors 64 "$out"
