#!/bin/sh
# docs/gallery.md and its pictures: the cloths that come with Weft, in the same light.
# Usage: gallery.sh WEFT [DATASETS [SECTION...]]
# A SECTION is one of stitches, photographed, weaves, microcylinders, cards; without one all are drawn. The others stay as the page
# has them. Photographs, registration and material of a weave take 3.4 to 3.8 minutes of processor time. The real card
# photographs are looked for beside the checkout. Datasets and materials are kept in DATASETS, and taken from there the next
# time. Frames are timed: let nothing else run. Where something did, the page says so.
set -eu
weft=$(realpath "$1")
source_dir=$(cd "$(dirname "$0")/.." && pwd)
pictures="$source_dir/docs/images/gallery"
page="$source_dir/docs/gallery.md"
cards="${WEFT_SHARED:-/nonexistent}/real/cards-blue"
work=${2:-$(mktemp -d)}
[ -n "${2:-}" ] || trap 'rm -rf "$work"' EXIT
[ $# -lt 2 ] || shift
shift
all="stitches photographed weaves microcylinders cards"
wanted=${*:-$all}
for section in $wanted; do
    case " $all " in
    *" $section "*) ;;
    *) echo "gallery.sh: '$section' is none of $all" >&2 && exit 2 ;;
    esac
done
mkdir -p "$work" "$pictures"
cd "$work"

# draw FILE ARGUMENT...: one picture of a cloth. $exposure is then that of the picture.
draw() {
    out=$1
    shift
    "$weft" render "$@" --size 400x300 -o drawn.png >said 2>&1 || { cat said >&2 && return 1; }
    exposure=$(sed -n 's/^exposure \([^ ]*\) .*/\1/p' said)
    exposure=${exposure:-1}
    mkdir -p "$(dirname "$pictures/$out.jpg")"
    convert drawn.png -quality 88 "$pictures/$out.jpg"
    rm drawn.png
}

# picture NAME WORD: how the page shows it.
picture() { echo "![$2](images/gallery/$1.jpg)"; }

# kilobytes FILE, title FILE, held_out FILE ROW: what stands in the tables.
kilobytes() { echo "$((($(stat -c %s "$1") + 999) / 1000)) kB"; }
title() { sed -n 's/.*name *= *"\([^"]*\)".*/\1/p' "$1" | head -n 1; }
held_out() { printf '%.3f' "$("$weft" info "$1" | sed -n "s/^  $2: //p" | head -n 1)"; }

# compare NAME ARGUMENT...: NAME.scenes holds how the material looks on a drape, and what a frame costs.
compare() {
    name=$1
    shift
    [ ! -s "$name.scenes" ] || return 0
    "$weft" compare "$name.btf.h5" "$name.weft" "$@" -o "$name-page" >scenes 2>/dev/null || return
    echo "load: $(cut -d' ' -f1 /proc/loadavg) $(nproc)" >>scenes
    mv scenes "$name.scenes"
}

# timed_beside NAME...: what the page says where more ran while frames were timed than the processors have room for.
timed_beside() {
    for name in "$@"; do cat "$name.scenes"; done | awk '/^load: / { if ($2 > most) most = $2; processors = $3 }
        END { if (most > processors + 0.5) printf "\nFrames of this section were timed beside other work: up to %.0f programs on %d processors.\n", most, processors }'
}

# names_in FOLDER EXTENSION: of the cloths there.
names_in() { for file in "$source_dir/assets/$1"/*."$2"; do basename "$file" ".$2"; done; }

# of_scene NAME MODEL FIELD, from these: 1 decibels beside raw, 2 milliseconds a frame, 3 of raw.
of_scene() {
    sed -n "s/.*, $2 beside raw: PSNR \([0-9.]*\) dB.*; \([0-9.]*\) ms a frame, raw \([0-9.]*\) ms.*/\\$3/p" "$1.scenes"
}

# error_of NAME MODEL WHAT: its relative RMSE over all samples, or of the mean BRDF.
error_of() { sed -n "s/^$2, $3: relative RMSE \([0-9.]*\) %,.*/\1/p" "$1.scenes" | awk '{ printf "%.3f", $1 / 100 }'; }

stitches() {
    cat <<'TEXT'
## Stitches: yarns in space, simulated, compressed

`weft simulate` traces light through yarns. 32 x 32 texels, 64 views x 64 lights; a napkin of 60 mm. Both pictures of
a stitch have the exposure of the raw one.

| stitch | raw | compressed | bytes, raw / compressed | ms a frame | error, raw interpolated / compressed | drape |
| --- | --- | --- | --- | --- | --- | --- |
TEXT
    for file in "$source_dir"/assets/stitches/*.stitch; do
        name=$(basename "$file" .stitch)
        [ -s "$name.btf.h5" ] || "$weft" simulate "$file" -o "$name.btf.h5" --size 32x32 --noise 3 -q >&2
        [ -s "$name.weft" ] || "$weft" compress "$name.btf.h5" -o "$name.weft" -q >&2
        compare "$name"
        draw "$name-raw" --raw "$name.btf.h5" --mesh drape --mesh-size 60
        draw "$name" "$name.weft" --mesh drape --mesh-size 60 --exposure "$exposure"
        echo "| $(title "$file") | $(picture "$name-raw" raw) | $(picture "$name" compressed)" \
            "| $(kilobytes "$name.btf.h5") / $(kilobytes "$name.weft")" \
            "| $(of_scene "$name" compressed 3) / $(of_scene "$name" compressed 2)" \
            "| $(held_out "$name.weft" photographs_interpolated) / $(held_out "$name.weft" not_fitted)" \
            "| $(of_scene "$name" compressed 1) dB |"
    done
    timed_beside $(names_in stitches stitch)
}

# photograph NAME: its dataset and material, by the virtual rig.
photograph() {
    if [ ! -s "$1.btf.h5" ]; then
        "$weft" capture --rig virtual --sample "$source_dir/assets/weaves/$1.wv" --seed 1 -q -o "$1.session" >&2
        "$weft" register "$1.session" --size 64x64 -q -o "$1.btf.h5" >&2
        rm -rf "$1.session"
    fi
    [ -s "$1.weft" ] || "$weft" compress "$1.btf.h5" -q -o "$1.weft" >&2
    compare "$1" --weave "$source_dir/assets/weaves/$1.wv"
}

photographed() {
    cat <<'TEXT'
## Weaves: photographed, compressed, analytic

The virtual rig photographs weaves under 81 views x 81 lights, magnified; `weft register` makes 64 x 64 texels of that.
The analytic cloth is the weave that was photographed, but without its noise, because the places of its bright flecks are
random. Its error is over all samples. It comes [mostly from those flecks](notes/weaves.md#photographed-weaves) in denim,
twill and charmeuse, otherwise from steep views, whose pixels span two texels. A cloth of 300 mm; its three pictures have
the exposure of the raw one.

| weave | raw | compressed | analytic | bytes, raw / compressed / analytic | ms a frame, the same | error, raw interpolated / compressed / analytic | error of the mean BRDF, compressed / analytic | drape, compressed / analytic |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
TEXT
    for file in "$source_dir"/assets/weaves/*.wv; do
        name=$(basename "$file" .wv)
        photograph "$name"
        draw "photographed/$name-raw" --raw "$name.btf.h5" --mesh drape
        one=$exposure
        draw "photographed/$name" "$name.weft" --mesh drape --exposure "$one"
        draw "photographed/$name-analytic" "$name.weft" --weave "$file" --mode analytic --mesh drape --exposure "$one"
        echo "| $(title "$file") | $(picture "photographed/$name-raw" raw) | $(picture "photographed/$name" compressed)" \
            "| $(picture "photographed/$name-analytic" analytic)" \
            "| $(kilobytes "$name.btf.h5") / $(kilobytes "$name.weft") / $(kilobytes "$file")" \
            "| $(of_scene "$name" compressed 3) / $(of_scene "$name" compressed 2) / $(of_scene "$name" analytic 2)" \
            "| $(held_out "$name.weft" photographs_interpolated) / $(held_out "$name.weft" not_fitted) / $(error_of "$name" analytic samples)" \
            "| $(error_of "$name" compressed "mean BRDF") / $(error_of "$name" analytic "mean BRDF")" \
            "| $(of_scene "$name" compressed 1) / $(of_scene "$name" analytic 1) dB |"
    done
    timed_beside $(names_in weaves wv)
}

weaves() {
    cat <<'TEXT'
## Weaves: analytic, from published parameters

A few numbers a yarn, no photographs: Irawan and Marschner's model. A cloth of 300 mm, and a ball of 30 mm that shows the
yarns.

| weave | cloth | ball |
| --- | --- | --- |
TEXT
    for file in "$source_dir"/assets/weaves/*.wv; do
        name=$(basename "$file" .wv)
        draw "$name" --weave "$file"
        draw "$name-ball" --weave "$file" --mesh sphere --mesh-size 30
        echo "| $(title "$file") | $(picture "$name" cloth) | $(picture "$name-ball" ball) |"
    done
}

# A frame of such a cloth costs the same beside any dataset: that of one weave serves.
microcylinders() {
    photograph polyester_lining
    cat <<'TEXT'
## Cloth of threads without yarns: the microcylinder model

These were not photographed: there is nothing to compress, and no error. At the poles of a ball the threads turn about a
point: the glint there belongs to the ball, not to the cloth.

| cloth | drape | ball | bytes | ms a frame |
| --- | --- | --- | --- | --- |
TEXT
    for file in "$source_dir"/assets/microcylinder/*.mc; do
        name=$(basename "$file" .mc)
        draw "$name" --weave "$file"
        draw "$name-ball" --weave "$file" --mesh sphere
        ln -sf polyester_lining.btf.h5 "$name.btf.h5"
        ln -sf polyester_lining.weft "$name.weft"
        compare "$name" --weave "$file"
        echo "| $(title "$file") | $(picture "$name" cloth) | $(picture "$name-ball" ball)" \
            "| $(kilobytes "$file") | $(of_scene "$name" analytic 2) |"
    done
    timed_beside $(names_in microcylinder mc)
}

cards() {
    [ -d "$cards" ] || { section_of_page cards && return; }
    [ -s cards.btf.h5 ] || "$weft" import "$cards" --size 256 -q -o cards.btf.h5 >&2
    [ -s cards.weft ] || "$weft" compress cards.btf.h5 -q -o cards.weft >&2
    compare cards
    cat <<'TEXT'
## A card, really photographed

Nine flash photographs of a card with paper, foil and print, by a phone, from the MaterialGAN project. Their licence allows
measurements, but no copies, so there is no picture here. Errors are of photographs that are predicted from the other eight; no
frame is timed.

| texels | bytes, raw / compressed | error, raw interpolated / compressed |
| --- | --- | --- |
TEXT
    echo "| 256 x 256 | $(kilobytes cards.btf.h5) / $(kilobytes cards.weft)" \
        "| $(held_out cards.weft photographs_interpolated) / $(held_out cards.weft not_fitted) |"
}

heading_of() {
    case $1 in
    stitches) echo "## Stitches: yarns" ;;
    photographed) echo "## Weaves: photographed" ;;
    weaves) echo "## Weaves: analytic" ;;
    microcylinders) echo "## Cloth of threads" ;;
    cards) echo "## A card" ;;
    esac
}

# section_of_page SECTION: as the page has it, without the empty line at its end.
section_of_page() {
    awk -v heading="$(heading_of "$1")" '/^(## |\[All pages\])/ { inside = index($0, heading) == 1 } inside' "$page" | sed '${/^$/d}'
}

{
    cat <<'TEXT'
# Gallery

Every cloth that comes with Weft, in the studio light of a first picture. `scripts/gallery.sh WEFT` draws this page.

*Raw* is the dataset, interpolated. *Compressed* is the material of 32 components, the default. Deep cloth is seen through
the [heights](guide/relief.md) that were found in its views. Frames are those of `weft compare`: a drape of 400 x 400
pixels, exact, on a software rasteriser. Errors are relative RMSEs on held-out views and lights: of the other photographs,
interpolated, and of a material made of them. Decibels compare the two pictures of the drape.

TEXT
    for section in $all; do
        case " $wanted " in
        *" $section "*) "$section" && echo ;;
        *) grep -qF "$(heading_of "$section")" "$page" && section_of_page "$section" && echo ;;
        esac || [ -z "$wanted" ]
    done
    echo "[All pages](README.md)"
} >"$work/gallery.md"
montage -geometry 200x150+2+2 -tile 6x $(for name in plain_knit twill two_colour_loops open_weave ribs satin silk_charmeuse \
    wool_gabardine-ball cotton_denim-ball cotton_twill shot satin_face; do echo "$pictures/$name.jpg"; done) -quality 88 \
    "$pictures/all.jpg" >&2
cp "$work/gallery.md" "$page"
