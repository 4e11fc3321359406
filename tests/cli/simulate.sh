#!/bin/sh
# From a stitch to a material, and what is refused on the way. Usage: simulate.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/simulate-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

stitch="$assets/stitches/open_weave.stitch"
cat >directions.csv <<'CSV'
theta_deg,phi_deg
0,0
30,0
30,120
30,240
60,60
60,180
60,300
CSV

expect_says "^plane: the top of the cloth, for too few views" simulate "$stitch" -o open.btf.h5 --size 8x8 --noise 20 --directions directions.csv --bounces 1
expect_ok verify open.btf.h5
expect_ok info open.btf.h5
grep -q "Open weave" out.log || fail "the dataset does not name its stitch"
grep -q "frames: given" out.log || fail "the dataset does not know its frames"
expect_ok compress open.btf.h5 --lobes 1 -o open.weft
cp open.btf.h5 bent.btf.h5
"$python" -c 'import h5py; h5py.File("bent.btf.h5", "r+")["frame"][1, 2, 0] = [0, 3, 4]' || exit 77
expect_error 1 "bent.btf.h5': frame of texel (2, 1)" verify bent.btf.h5
expect_error 1 "bent.btf.h5': frame of texel (2, 1)" compress bent.btf.h5 --lobes 1 -o no.weft
expect_no_file no.weft
expect_ok info "$stitch"
grep -q "triangles" out.log || fail "the triangles are not counted"

expect_ok simulate "$stitch" --obj open.obj --obj-tiles 2x1 --resolution 30
grep -q "^vn " open.obj || fail "the surface has no normals"

# The truth beside them; without OpenGL it is left out, and said so.
sed 's/resolution = [0-9]*/resolution = 24/' "$stitch" >coarse.stitch
expect_says "near light, compressed against truth: relative RMSE\|no truth: " compare open.btf.h5 open.weft --truth coarse.stitch --paths 4 --size 96 -o report
expect_page report
grep -q "<h2>Truth</h2>" report/index.html || fail "the page has no truth"
expect_error 1 absent.stitch compare open.btf.h5 open.weft --truth absent.stitch -o no
expect_error 1 "is a weave; FILE.stitch is needed here" compare open.btf.h5 open.weft --truth "$assets/weaves/cotton_twill.wv" -o no
expect_error 2 "paths" compare open.btf.h5 open.weft --truth coarse.stitch --paths 0 -o no
[ ! -e no ] || fail "a report without truth was begun"

expect_error 1 absent.stitch simulate absent.stitch -o no.btf.h5
expect_error 1 "expected 'stitch'" simulate "$assets/weaves/cotton_twill.wv" -o no.btf.h5
printf 'theta_deg,phi_deg\n95,0\n' >low.csv
expect_error 1 "low.csv:2: theta_deg = 95" simulate "$stitch" -o no.btf.h5 --directions low.csv
printf 'a,b\n1,0\n' >other.csv
expect_error 1 "other.csv: needs the columns" simulate "$stitch" -o no.btf.h5 --directions other.csv
expect_error 1 "a stitch, not a model" eval "$stitch" --at directions.csv
expect_error 2 "needs a stitch" simulate "$stitch"
expect_error 3 "'absent'" simulate "$stitch" --size 2x2 --noise 50 -o absent/no.btf.h5
expect_no_file no.btf.h5

# The same cloth as the sample of the virtual rig.
write_plan >plan.csv
printf '{"rig": "virtual", "samples_per_pixel": 2, "bounces": 1}' >rig.json
expect_ok capture --rig rig.json --sample "$stitch" --plan plan.csv -o open --truth-images 1 --truth-size 8
expect_ok info open
grep -q "Open weave" out.log || fail "the session does not name its stitch"
expect_ok capture --rig rig.json --sample "$stitch" --plan plan.csv -o open --truth-images 1 --truth-size 8
expect_says "4 of 4 viewpoints" register open --size 16x16 -o registered.btf.h5
expect_ok compress registered.btf.h5 --lobes 1 -o registered.weft
printf '{"rig": "virtual", "tiles_x": 3}' >tiles.json
expect_error 1 "tiles_x" capture --rig tiles.json --sample "$stitch" --plan plan.csv -o tiles
expect_error 1 "absent.stitch" capture --sample absent.stitch --plan plan.csv -o absent

# What is no stitch.
refuse_stitch() {
    expect_error 1 "$1" simulate bad.stitch -o no.btf.h5 --size 2x2
    [ "$(wc -l <err.log)" = 1 ] || fail "more than one line: $(cat err.log)"
    expect_error 1 "$1" capture --sample bad.stitch --plan plan.csv -o no
}
head -c 300 "$stitch" >bad.stitch && refuse_stitch "bad.stitch:"
: >bad.stitch && refuse_stitch "expected 'stitch'"
head -c 3000 /dev/urandom >bad.stitch && refuse_stitch "bad.stitch"
sed 's/radius = [^,]*,/radius = 0,/' "$stitch" >bad.stitch && refuse_stitch "zero"
sed 's/radius = [^,]*,/radius = nan,/' "$stitch" >bad.stitch && refuse_stitch "bad.stitch:"
head -c 1000000 /dev/zero | tr '\0' '{' >bad.stitch && refuse_stitch "bad.stitch:1:1"
mkdir folder.stitch && expect_error 1 folder.stitch simulate folder.stitch -o no.btf.h5
expect_no_file no.btf.h5
[ ! -e no ] || fail "a session of a bad stitch was begun"
