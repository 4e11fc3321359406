#!/bin/sh
# docs/gallery.md and its pictures: the cloths that come with Weft, in the same light. Usage: gallery.sh WEFT [DATASETS]
# Datasets and materials are kept in DATASETS, and taken from there the next time. Frames are timed: let nothing else run.
set -eu
weft=$(realpath "$1")
source_dir=$(cd "$(dirname "$0")/.." && pwd)
pictures="$source_dir/docs/images/gallery"
page="$source_dir/docs/gallery.md"
work=${2:-$(mktemp -d)}
mkdir -p "$work" "$pictures"
cd "$work"
[ -n "${2:-}" ] || trap 'rm -rf "$work"' EXIT

# draw FILE ARGUMENT...: one picture of a cloth.
draw() {
    out=$1
    shift
    "$weft" render "$@" --size 400x300 -o drawn.png >&2
    convert drawn.png -quality 88 "$pictures/$out.jpg"
    rm drawn.png
}

# kilobytes FILE, title FILE, held_out FILE ROW: what stands in the table.
kilobytes() { echo "$(($(stat -c %s "$1") / 1000)) kB"; }
title() { sed -n 's/.*name *= *"\([^"]*\)".*/\1/p' "$1" | head -n 1; }
held_out() { printf '%.3f' "$("$weft" info "$1" | sed -n "s/^  $2: //p" | head -n 1)"; }

# compare NAME: NAME.scenes holds how the material looks on a drape, and what a frame costs.
compare() {
    [ -s "$1.scenes" ] || { "$weft" compare "$1.btf.h5" "$1.weft" -o "$1-page" >scenes 2>/dev/null && mv scenes "$1.scenes"; }
}

# of_scene NAME FIELD, from these: 1 decibels beside raw, 2 milliseconds a frame, 3 of raw.
of_scene() {
    sed -n "s/.*, compressed beside raw: PSNR \([0-9.]*\) dB.*; \([0-9.]*\) ms a frame, raw \([0-9.]*\) ms.*/\\$2/p" "$1.scenes"
}

# row NAME: bytes, milliseconds and error of a dataset and its material.
row() {
    echo "| $(kilobytes "$1.btf.h5") / $(kilobytes "$1.weft") | $(of_scene "$1" 3) / $(of_scene "$1" 2)" \
        "| $(held_out "$1.weft" photographs_interpolated) / $(held_out "$1.weft" not_fitted) | $(of_scene "$1" 1) dB |"
}

{
    cat <<'TEXT'
# Gallery

Every cloth that comes with Weft, in the studio that a first picture begins in. `scripts/gallery.sh WEFT` draws this page.

*Raw* is the dataset, interpolated. *Compressed* is the same as a material of 32 layers, the default. Where the cloth is deep,
both are seen through the [heights](guide/relief.md) that were found in the views. Frames are those of `weft compare`: a drape
of 400 x 400 pixels, exact, on a software rasteriser. Errors are relative RMSEs on directions that were held out: what the
other photographs, interpolated, and what a material of them say there. Decibels compare the two pictures of the drape.

## Stitches: yarns in space, simulated, compressed

`weft simulate` traces light through yarns. 32 x 32 texels, 64 views x 64 lights; a napkin of 60 mm.

| stitch | raw | compressed | bytes, raw / compressed | ms a frame | error, raw interpolated / compressed | drape |
| --- | --- | --- | --- | --- | --- | --- |
TEXT
    for file in "$source_dir"/assets/stitches/*.stitch; do
        name=$(basename "$file" .stitch)
        [ -s "$name.btf.h5" ] || "$weft" simulate "$file" -o "$name.btf.h5" --size 32x32 --noise 3 -q >&2
        [ -s "$name.weft" ] || "$weft" compress "$name.btf.h5" -o "$name.weft" -q >&2
        compare "$name"
        draw "$name-raw" --raw "$name.btf.h5" --mesh drape --mesh-size 60
        draw "$name" "$name.weft" --mesh drape --mesh-size 60
        echo "| $(title "$file") | ![raw](images/gallery/$name-raw.jpg) | ![compressed](images/gallery/$name.jpg) $(row "$name")"
    done
    cat <<'TEXT'

## Weaves: analytic, from published parameters

A few numbers a yarn, no photographs: Irawan and Marschner's model. A cloth of 300 mm, and a ball of 30 mm that shows the yarns.

| weave | cloth | ball |
| --- | --- | --- |
TEXT
    for file in "$source_dir"/assets/weaves/*.wv; do
        name=$(basename "$file" .wv)
        draw "$name" --weave "$file"
        draw "$name-ball" --weave "$file" --mesh sphere --mesh-size 30
        echo "| $(title "$file") | ![cloth](images/gallery/$name.jpg) | ![ball](images/gallery/$name-ball.jpg) |"
    done
    cat <<'TEXT'

## Cloth of threads without yarns: the microcylinder model

| cloth | drape | ball |
| --- | --- | --- |
TEXT
    for file in "$source_dir"/assets/microcylinder/*.mc; do
        name=$(basename "$file" .mc)
        draw "$name" --weave "$file"
        draw "$name-ball" --weave "$file" --mesh sphere
        echo "| $(title "$file") | ![cloth](images/gallery/$name.jpg) | ![ball](images/gallery/$name-ball.jpg) |"
    done
    montage -geometry 200x150+2+2 -tile 6x $(for name in plain_knit twill two_colour_loops open_weave ribs satin silk_charmeuse \
        wool_gabardine-ball cotton_denim-ball cotton_twill shot satin_face; do echo "$pictures/$name.jpg"; done) -quality 88 \
        "$pictures/all.jpg" >&2
    echo
    echo "[All pages](README.md)"
} >"$work/gallery.md"
cp "$work/gallery.md" "$page"
