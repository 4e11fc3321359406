#!/bin/sh
# Bad input to whole commands: one clear line, the right exit code, nothing half-written. Usage: bad_input.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/bad-input-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

weave="$assets/weaves/polyester_lining.wv"
write_plan >plan.csv
expect_ok capture --sample "$weave" --plan plan.csv --truth-images 1 --truth-size 4 -o good

# A copy of the good session whose photographs may be spoilt.
spoil() {
    rm -rf spoilt spoilt.btf.h5 report
    cp -r good spoilt
}

# Bad photographs are named and do not sink the rest: missing, empty, cut, of another size, no picture, without the target.
stay=spoilt/tv030_pv090
spoil
rm $stay/tl030_pl060_tv030_pv090.tif
: >$stay/tl030_pl180_tv030_pv090.tif
truncate -s 20000 $stay/tl045_pl300_tv030_pv090.tif
convert -size 100x80 xc:gray $stay/tl060_pl000_tv030_pv090.tif
head -c 500 /dev/urandom >$stay/tl060_pl120_tv030_pv090.tif
convert -size 416x416 xc:black -depth 16 -type TrueColor $stay/tl060_pl240_tv030_pv090.tif
for each in spoilt/tv045_pv240/*.tif; do # a view whose target cannot be seen
    convert -size 416x416 xc:gray -depth 16 -type TrueColor "$each"
done
expect_ok register spoilt --size 16x16 -o spoilt.btf.h5 --report report
cat out.log err.log report/index.html >named
for name in tl030_pl060 tl030_pl180 tl045_pl300 tl060_pl000 tl060_pl120 tl060_pl240; do
    grep -q "${name}_tv030_pv090" named || fail "${name}_tv030_pv090 is not named"
done
grep -q tv045_pv240 named || fail "the view without a target is not named"
expect_ok compress spoilt.btf.h5 --lobes 1 --hold-out off -o spoilt.weft
spoil
find spoilt -name '*.tif' -delete
expect_error 1 spoilt register spoilt --size 16x16 -o spoilt.btf.h5
expect_no_file spoilt.btf.h5

spoil && rm spoilt/session.json && expect_error 1 session.json register spoilt -o spoilt.btf.h5
spoil && sed -i 's/"bits"/"bitz"/' spoilt/session.json && expect_error 1 session.json register spoilt -o spoilt.btf.h5
spoil && sed -i '3s/.*/garbage/' spoilt/journal.jsonl && expect_error 1 "line 3" register spoilt -o spoilt.btf.h5
spoil && sed -i '20,$d' spoilt/journal.jsonl && expect_error 1 spoilt register spoilt -o spoilt.btf.h5
expect_no_file spoilt.btf.h5
expect_error 1 absent register absent -o spoilt.btf.h5
mkdir folder
expect_error 2 "a folder" register good --size 16x16 -o folder
expect_error 2 "would overwrite" register good --size 16x16 -o good
expect_error 2 "does not name a file" register good --size 16x16 -o absent/
expect_error 3 "'absent'" register good --size 16x16 -o absent/good.btf.h5

# Datasets.
expect_ok register good --size 16x16 -o good.btf.h5
"$python" - <<'PYTHON' || exit 77
import h5py, numpy, shutil
shutil.copy("good.btf.h5", "nan.btf.h5")
with h5py.File("nan.btf.h5", "r+") as f:
    f["samples"][3, 4, 5, 1] = numpy.nan
    f["mask"][3, 4, 5] = 0
PYTHON
expect_error 1 nan.btf.h5 compress nan.btf.h5 -o nan.weft
expect_error 1 nan.btf.h5 verify nan.btf.h5
expect_no_file nan.weft
size=$(stat -c %s good.btf.h5)
for part in 0 10 100 2000 $((size / 2)) $((size - 1)); do
    head -c "$part" good.btf.h5 >cut.btf.h5
    expect_error 1 cut.btf.h5 compress cut.btf.h5 -o cut.weft
    expect_no_file cut.weft
done
expect_error 1 plan.csv compress plan.csv -o cut.weft
expect_error 1 absent.btf.h5 compress absent.btf.h5 -o cut.weft

# Materials: cut at every section boundary.
expect_ok compress good.btf.h5 --lobes 2 --hold-out off -o good.weft
"$python" - <<'PYTHON' >boundaries
import struct
data = open("good.weft", "rb").read()
count = struct.unpack_from("<I", data, 12)[0]
edges = {0, 64, 64 + 40 * count}
for i in range(count):
    offset, stored = struct.unpack_from("<QQ", data, 64 + 40 * i + 16)
    edges |= {offset, offset + stored - 1, offset + stored}
print(*sorted(edge for edge in edges if edge < len(data)))
PYTHON
for edge in $(cat boundaries); do
    head -c "$edge" good.weft >cut.weft
    expect_error 1 cut.weft verify cut.weft
done
expect_error 1 cut.weft render cut.weft -o cut.png
expect_error 1 cut.weft compare good.btf.h5 cut.weft -o cut-report
expect_no_file cut.png

# A full disk, here a limit on the size of files.
limited() {
    limit=$1
    shift
    (
        ulimit -f "$limit"
        "$weft" "$@" >out.log 2>err.log
    ) && fail "weft $* did not notice the full disk"
    tail -n 1 err.log | grep -q "^weft " || fail "weft $*: no clear line: $(tail -n 1 err.log)"
    passed=$((passed + 1))
}
limited 100 capture --sample "$weave" --plan plan.csv -o full
limited 100 register good --size 32x32 -o full.btf.h5
expect_no_file full.btf.h5
limited 8 compress good.btf.h5 --lobes 2 --hold-out off -o full.weft
expect_no_file full.weft
limited 8 render good.weft --size 400x400 -o full.png
expect_no_file full.png
limited 4 compare good.btf.h5 good.weft --size 64 -o full-report

# Photographs of which all is clipped: named as the user knows them, and nothing is kept of work that is of no use.
mkdir white
echo "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg" >white/directions.csv
for theta in 10 20 30 40; do
    convert -size 8x8 "xc:#ffffff" -type TrueColor "white/$theta.png"
    echo "$theta.png,$theta,0,0,0" >>white/directions.csv
done
expect_ok import white -o white.btf.h5
expect_error 1 "'white.btf.h5' holds no valid sample" compress white.btf.h5 -o white.weft
grep -q "held-out.btf.h5" out.log err.log && fail "a file that nobody knows is named: $(cat out.log err.log)"
expect_no_file white.weft
expect_no_file white.weft.partial

# Weaves and plans.
sed 's/tileWidth = /tileWidht = /' "$weave" >typo.wv
expect_error 1 typo.wv capture --sample typo.wv --plan plan.csv -o typo
printf 'theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n0,0,0,0\n0,zero,0,0\n' >bad.csv
expect_error 1 bad.csv capture --sample "$weave" --plan bad.csv -o bad
expect_error 2 "" capture
expect_error 2 lobes compress good.btf.h5 -o x.weft --lobes 7
status=0
"$weft" nonsense 2>err.log || status=$?
[ "$status" = 2 ] || fail "an unknown command exits with $status"
echo "$passed passed, 0 failed"
