#!/bin/sh
# The command weft relief, whole: what it says, writes and refuses. Usage: relief.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/relief-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

awk 'BEGIN {
    print "theta_deg,phi_deg"
    print "0,0"
    for (theta = 15; theta <= 75; theta += 20)
        for (i = 0; i < 6; i++)
            print theta "," 60 * i + theta
}' >directions.csv
expect_ok simulate "$assets/stitches/plain_knit.stitch" -o knit.btf.h5 --plane top --heights off --size 20x16 --noise 10 --bounces 0 \
    --resolution 40 --directions directions.csv
cp knit.btf.h5 before.btf.h5

expect_ok relief knit.btf.h5 -o deep.btf.h5 --report page --obj surface.obj --normal normals.png
cmp -s knit.btf.h5 before.btf.h5 || fail "-o does not leave the dataset as it was"
grep -q "^relief: " out.log || fail "the knit is refused: $(cat out.log)"
for file in page/index.html page/height.png page/confidence.png normals.png; do
    [ -s "$file" ] || fail "there is no $file"
done
expect_page page
grep -q "Error by view" page/index.html || fail "the page does not show the errors"
[ "$(grep -c '^v ' surface.obj)" = 1280 ] || fail "the surface does not have 40 x 32 vertices"
[ "$(grep -c '^f ' surface.obj)" = 2418 ] || fail "the surface does not have 2 x 39 x 31 triangles"
expect_ok verify deep.btf.h5
expect_ok info deep.btf.h5
grep -q "verdict: relief" out.log || fail "the dataset does not say what was decided"

# A command that writes a dataset looks for them by itself; its texels lie where the views agree, so that no plane helps any more.
expect_says "^texels lie 0.[12]" simulate "$assets/stitches/plain_knit.stitch" -o best.btf.h5 --size 20x16 --noise 10 --bounces 0 \
    --resolution 40 --directions directions.csv
grep -q "^relief: " out.log || fail "weft simulate does not look for heights: $(cat out.log)"
expect_says "plane_below_top_mm: 0.[12]" info best.btf.h5
expect_says "^plane  *-*0.0" relief best.btf.h5 -o again.btf.h5
"$python" - <<'PYTHON' || fail "weft simulate keeps other heights than weft relief"
import h5py
best, again, flat = (h5py.File(name + ".btf.h5") for name in ("best", "again", "knit"))
assert (best["height"][:] == again["height"][:]).all() and "height" not in flat
assert best.attrs["plane_mm"] == again.attrs["plane_mm"]
PYTHON

# Another search keeps in mind that texels were moved.
expect_ok relief knit.btf.h5 --move on -o moved.btf.h5
expect_ok relief moved.btf.h5
expect_says "moved_mm: -0.[12]" info moved.btf.h5

# In place, as events, without what was there before.
expect_ok relief knit.btf.h5 --json --range=-0.5,0.125
grep -q '"event":"relief"' out.log || fail "there is no event"
grep -q '"range_mm":\[-0.5,0.125' out.log || fail "the range is not kept"
"$python" - <<'PYTHON' || fail "the heights are not in the file"
import h5py, numpy
f = h5py.File("knit.btf.h5")
h = f["height"][:]
assert h.shape == (32, 40) and numpy.isfinite(h).all(), h.shape
assert -0.5 <= h.min() and h.max() <= 0.125, (h.min(), h.max())
assert -0.4 < f.attrs["plane_mm"] < 0 and f.attrs["height_levels"] >= 1
PYTHON

# What is compressed keeps the heights for its layers, where held-out photographs say so.
expect_ok compress deep.btf.h5 -o deep.weft --components 16
grep -q "; through the heights [.0-9]* %, without them [.0-9]* %" out.log || fail "nothing is said of the heights: $(cat out.log)"
grep -q "they are left out" out.log && fail "the heights of a knit are left out: $(cat out.log)"
expect_ok info deep.weft
grep -A1 "^heights:" out.log | grep -q "range_mm: \[-0" || fail "the material does not say that it has heights"
expect_ok verify deep.weft
expect_ok render deep.weft --environment none --mesh plane --repeat 2 --size 64x48 -o through.png
expect_ok render deep.weft --environment none --mesh plane --repeat 2 --size 64x48 --relief off -o flat.png
expect_ok compress before.btf.h5 -o before.weft --components 16 --hold-out off
expect_ok render before.weft --environment none --mesh plane --repeat 2 --size 64x48 -o off.png
"$python" - <<'PYTHON' || fail "the heights are not what is switched"
import struct

def pixels(path):
    data, at, found = open(path, "rb").read(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        found += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += 12 + size
    return found

assert pixels("off.png") == pixels("flat.png")
assert pixels("through.png") != pixels("flat.png")
PYTHON
expect_ok info before.weft
grep -q "heights" out.log && fail "there are heights that nothing has found"

# Refused in one line, and nothing is written.
expect_error 2 "needs NAME.btf.h5" relief
expect_error 2 "--range needs LOW,HIGH" relief knit.btf.h5 --range 1,0
expect_error 2 "--repeat" relief knit.btf.h5 --repeat perhaps
expect_error 1 "absent.btf.h5" relief absent.btf.h5
expect_error 3 "'absent'" relief knit.btf.h5 -o absent/out.btf.h5
head -c 3000 knit.btf.h5 >cut.btf.h5
expect_error 1 "cut.btf.h5" relief cut.btf.h5
"$python" - <<'PYTHON'
import h5py, shutil
shutil.copy("knit.btf.h5", "bad.btf.h5")
h5py.File("bad.btf.h5", "r+")["height"][3, 4] = float("nan")
PYTHON
expect_error 1 "bad.btf.h5': height (4, 3) is nan mm" render --raw bad.btf.h5 --mode raw -o no.png
expect_no_file no.png
