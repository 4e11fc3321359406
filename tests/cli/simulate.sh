#!/bin/sh
# From a stitch to a material, and what is refused on the way. Usage: simulate.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
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

expect_ok simulate "$stitch" -o open.btf.h5 --size 8x8 --noise 20 --directions directions.csv --bounces 1
expect_ok verify open.btf.h5
expect_ok info open.btf.h5
grep -q "Open weave" out.log || fail "the dataset does not name its stitch"
expect_ok compress open.btf.h5 --lobes 1 -o open.weft
expect_ok info "$stitch"
grep -q "triangles" out.log || fail "the triangles are not counted"

expect_ok simulate "$stitch" --obj open.obj --tiles 2x1 --resolution 30
grep -q "^vn " open.obj || fail "the surface has no normals"

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
