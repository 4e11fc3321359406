#!/bin/sh
# The certificate of a material, whole: that it is made, shown, kept to and left out. Usage: certificate.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/certificate-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# A grid to fit, and directions on no grid to be tested on: another seed, other paths of light.
spread() {
    awk -v count="$1" -v turn="$2" 'BEGIN {
        print "theta_deg,phi_deg"
        for (i = 0; i < count; i++) {
            z = 1 - (i + 0.5) / count * 0.8
            print atan2(sqrt(1 - z * z), z) * 57.29578 "," i * 137.50776 + turn
        }
    }'
}
spread 24 0 >grid.csv
spread 7 50 >between.csv
for set in grid between; do
    seed=$([ $set = grid ] && echo 1 || echo 2)
    expect_ok simulate "$assets/stitches/plain_knit.stitch" -o $set.btf.h5 --plane top --heights off --size 12x12 --noise 10 --bounces 0 \
        --resolution 20 --directions $set.csv --seed "$seed"
done

for model in "--lobes 1" "--components 8"; do
    # shellcheck disable=SC2086
    expect_says "certificate: 95 % of the pixels of images not seen" compress grid.btf.h5 -o grid.weft $model
    # shellcheck disable=SC2086
    expect_ok compress grid.btf.h5 -o plain.weft $model --hold-out off
    expect_says "view_45_deg: +-" info grid.weft
    expect_ok info grid.weft --json
    cp out.log info.log
    expect_ok info plain.weft --json
    "$python" - <<'PYTHON' || fail "weft info does not show the certificate of $model"
import json
info = json.loads(open("info.log").read())
kept = info["metadata"]["certificate"]
assert kept["probability"] == 0.95 and kept["over"] == "images" and kept["images"] > 50, kept
split = info["metadata"]["held_out"]  # two of 24 views and two lights, as often as ten directions take
assert split["splits"] == 3 and split["views_of"] == split["lights_of"] == [2, 24], split
assert kept["directions"] == 12 and "registration" not in kept, kept
# 12 x 12 texels are all measured, and so are means over 2 x 2 and 4 x 4 of them.
assert info["certificate"]["levels"] == "measured on levels 0 to 2", info["certificate"]
assert kept["measured_levels"] == 3 == len(kept["quantiles"]), kept
assert kept["quantiles"][0] > kept["quantiles"][1] > kept["quantiles"][2] > 0, kept
assert "registration not known" in info["certificate"]["view_30_deg"], info["certificate"]
PYTHON
    # All sections but the metadata are those of a material without it.
    "$python" - <<'PYTHON' || fail "a certificate changes more than the metadata"
import struct
def sections(path):
    data = open(path, "rb").read()
    count, = struct.unpack_from("<I", data, 12)
    entries = [struct.unpack_from("<4sIIIQQQ", data, 64 + 40 * i) for i in range(count)]
    return {(e[0], e[1]): data[e[4]:e[4] + e[5]] for e in entries if e[0] != b"META"}
assert sections("grid.weft") == sections("plain.weft")
PYTHON
done

# Directions that were on no photograph lie in their intervals as often as is said.
expect_ok compare between.btf.h5 grid.weft --size 64 -o report --json
cp out.log compare.log
"$python" - <<'PYTHON' || fail "the certificate does not keep to what it says"
import json
events = map(json.loads, open("compare.log").read().splitlines())
covered = next(e for e in events if e["event"] == "coverage")
assert 0.92 < covered["covered"] < 0.98, covered
assert covered["width"] < covered["even_width"], covered
assert covered["measured_levels"] == 3, covered
PYTHON
grep -q "The interval is measured on levels 0 to 2[.]<" report/index.html || fail "the page does not say which levels are measured"
grep -q 'id="certificate"' report/index.html || fail "the page of weft compare does not show the certificate"

# The ends of the interval stand about the value, as far as the certificate says.
cat >places.csv <<'CSV'
lx,ly,lz,vx,vy,vz,u,v
0,0,1,0.5,0,0.8660254,0.25,0.25
0.6,0,0.8,0,0,1,0.7,0.1
CSV
expect_ok eval grid.weft --at places.csv --interval
"$python" - <<'PYTHON' || fail "weft eval --interval does not print intervals"
import csv
rows = list(csv.DictReader(open("out.log")))
assert len(rows) == 2
for row in rows:
    for c in "rgb":
        low, value, high = float(row[c + "_low"]), float(row[c]), float(row[c + "_high"])
        assert 0 <= low <= value < high, row
        assert low == 0 or abs((value - low) - (high - value)) < 1e-6 * high, row
PYTHON
echo "lx,ly,lz,vx,vy,vz
0,0,1,0,0,1" >means.csv
expect_error 1 "no columns u and v" eval grid.weft --at means.csv --interval
expect_error 1 "has no certificate" eval plain.weft --at places.csv --interval
expect_error 1 "only a .weft has a certificate" eval grid.btf.h5 --at places.csv --interval
expect_error 2 "has components alone, no lobes" eval grid.weft --at places.csv --interval --lobes
echo "$passed commands"
