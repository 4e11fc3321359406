#!/bin/sh
# The main job from end to end: photographs, dataset, material, picture. Usage: demo.sh WEFT OUT
set -eu

weft=$1
out=$2
source_dir=$(cd "$(dirname "$0")/.." && pwd)
weave="$source_dir/assets/weaves/wool_gabardine.wv"
shared=${WEFT_SHARED:+$WEFT_SHARED/real}
mkdir -p "$out"

step() {
    printf '\n== %s\n' "$*"
}

step "1/5 Photograph the cloth: 81 views x 81 lights = 6561 photographs by the virtual rig"
"$weft" capture --rig virtual --sample "$weave" --seed 1 -o "$out/gabardine"

step "2/5 Register the photographs: one projective warp a view, calibrated reflectance"
"$weft" register "$out/gabardine" --size 64x64 -o "$out/gabardine.btf.h5" --report "$out/registration"

step "3/5 Compress: 32 components, all mip levels"
"$weft" compress "$out/gabardine.btf.h5" -o "$out/gabardine.weft"

step "4/5 Draw: raw BTF, compressed material and analytic cloth side by side"
"$weft" render "$out/gabardine.weft" --raw "$out/gabardine.btf.h5" --weave "$weave" --mode split --repeat 40 --size 1500x560 \
    -o "$out/side-by-side.png"

step "5/5 Compare them with numbers"
"$weft" compare "$out/gabardine.btf.h5" "$out/gabardine.weft" --weave "$weave" --fit -o "$out/compare"

step "60 photographs to a picture: a camera and a lamp in the hand, as you would take them yourself"
rm -rf "$out/hand"
"$weft" synthetic "$weave" --photographs 60 --width 900 --truth-size 0 -q -o "$out/hand"
"$weft" photographs "$out/hand" --size 96x96 --report "$out/hand-report" -o "$out/hand.btf.h5"
"$weft" compress "$out/hand.btf.h5" -q -o "$out/hand.weft"
"$weft" tile "$out/hand.weft" --blend -o "$out/hand-tile.weft"
"$weft" render "$out/hand-tile.weft" -o "$out/hand.png"

if [ -n "$shared" ] && [ -d "$shared/cards-blue" ]; then
    step "And real photographs: nine flash pictures of a card"
    "$weft" import "$shared/cards-blue" --size 256 -o "$out/cards.btf.h5"
    "$weft" compress "$out/cards.btf.h5" -o "$out/cards.weft"
    "$weft" render "$out/cards.weft" --mesh plane --repeat 1 --light 35,120 --size 800x800 -o "$out/cards-moved-light.png"
    "$weft" compare "$out/cards.btf.h5" "$out/cards.weft" -o "$out/cards-compare"
else
    printf '\nWEFT_SHARED names no folder of real photographs: that part is skipped.\n'
fi

printf '\nDone. Look at:\n'
for result in side-by-side.png registration/index.html compare/index.html hand.png hand-report/index.html cards-moved-light.png cards-compare/index.html; do
    [ ! -e "$out/$result" ] || printf '    %s\n' "$out/$result"
done
