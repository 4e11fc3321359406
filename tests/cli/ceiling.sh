#!/bin/sh
# Samples that are no reflectance: components clip them, and compress says so. Usage: ceiling.sh WEFT ASSETS PYTHON
set -eu
weft=$1
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/ceiling-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# Photographs with positions: reflectance is inverse to the power of the light.
mkdir card
for i in 0 1 2 3 4 5 6 7 8; do
    convert -size 4x4 "xc:rgb($((60 + 10 * i)),80,100)" "card/0$i.png"
    echo "$i,$((8 - i)),30"
done >card/camera_pos.txt
cp card/camera_pos.txt card/light_pos.txt
echo 4 >card/image_size.txt
for power in 3000,3000,3000 1,1,1; do
    echo "$power" >card/light_power.txt
    expect_ok import card -o card.btf.h5
    expect_ok compress card.btf.h5 --components 8 --hold-out off -o card.weft
    cat out.log err.log >"said.${power%%,*}"
done
grep -q "values above 235 were clipped" said.1 || fail "nothing is said of clipped values: $(cat said.1)"
! grep -q "were clipped" said.3000 || fail "reflectance is taken for counts: $(cat said.3000)"
expect_ok compress card.btf.h5 --lobes 1 --hold-out off -o card.weft
! grep -q "were clipped" out.log err.log || fail "lobes have no ceiling"
echo "$passed passed, 0 failed"
