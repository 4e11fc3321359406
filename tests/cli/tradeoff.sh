#!/bin/sh
# The command weft tradeoff, whole: what it says, writes and refuses. Usage: tradeoff.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/tradeoff-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

simulate_knit
cp knit.btf.h5 before.btf.h5

# Frames of so many models would take long: the page says that it has none.
export __EGL_VENDOR_LIBRARY_DIRS=/nonexistent
expect_ok tradeoff knit.btf.h5 --weave "$assets/microcylinder/crepe.mc" -o prices
cmp -s knit.btf.h5 before.btf.h5 || fail "the dataset is changed"
for model in "1 lobe" "2 lobes" "32 components" "analytic cloth" "the photographs, interpolated"; do
    grep -q "^$model  *[0-9]" out.log || fail "there is no price of $model: $(cat out.log)"
done
expect_page prices
for preset in small balanced best; do
    grep -q "<td><b>$preset</b></td>" prices/index.html || fail "the page does not show the preset $preset"
done
grep -q "no times of frames: " out.log || fail "it does not say why there are no times of frames"
grep -q "There are no times of frames: " prices/index.html || fail "the page does not say why there are none"
[ "$(grep -c '<svg class="plot"' prices/index.html)" = 2 ] || fail "there are not two plots: of size and of the fit"
if ls prices | grep -v '^index.html$\|^tradeoff.csv$\|^model-[0-9]*\(-photograph\)\?.png$'; then
    fail "something is left behind"
fi
"$python" - <<'PYTHON' || fail "the table is not what it should be"
import csv
rows = list(csv.DictReader(open("prices/tradeoff.csv")))
by_name = {row["model"]: row for row in rows}
assert len(by_name) == len(rows) > 8
raw, lobe = by_name["the photographs; interpolated"], by_name["1 lobe"]
assert float(raw["bytes"]) == 8 * 8 * 49 * 6 and raw["photographs"] == "49", raw
assert 500 < float(lobe["bytes"]) < 20000 and lobe["options"] == "--lobes 1", lobe
for row in rows:
    most = 9 if row["model"] == "analytic cloth" else 2
    assert 0 < float(row["not_fitted_all_relative_rmse"]) < most and 0 <= float(row["flip"]) < 1, row
    assert 0.1 < float(row["interval_width"]) < 6, row
    assert row["frame_ms"] == "", row
    if row["family"] != "matrices":  # of which there is no file
        assert float(row["flicker"]) >= 0 and float(row["evaluations_a_second"]) > 0, row
cloth = by_name["analytic cloth"]
assert cloth["family"] == "analytic cloth" and cloth["options"] == "" and 100 < float(cloth["bytes"]) < 3000, cloth
best = [row for row in rows if "best" in row["presets"]]
least = min(float(row["not_fitted_all_relative_rmse"]) for row in rows if row["options"])
assert len(best) == 1 and float(best[0]["not_fitted_all_relative_rmse"]) <= 1.01 * least, best
PYTHON

# Refused in one line, before the work.
expect_error 2 "needs a dataset and -o REPORT/" tradeoff knit.btf.h5
expect_error 1 "absent.btf.h5" tradeoff absent.btf.h5 -o none
expect_error 1 "directions.csv" tradeoff directions.csv -o none
expect_error 1 "directions.csv" tradeoff knit.btf.h5 --weave directions.csv -o none
expect_error 3 "knit.btf.h5/none" tradeoff knit.btf.h5 -o knit.btf.h5/none
[ ! -e none ] || fail "a folder is left of a study that was refused"

[ "${4-}" = long ] || exit 0

# Of a material of more texels than are measured the list says the error that weft compress says of it: of the same texels, with
# the same directions held out, as often.
awk 'BEGIN {
    print "theta_deg,phi_deg"
    for (i = 0; i < 10; i++) { z = 1 - (i + 0.5) / 10 * 0.8; print atan2(sqrt(1 - z * z), z) * 57.29578 "," i * 137.50776 }
}' >ten.csv
expect_ok simulate "$assets/stitches/plain_knit.stitch" -o wide.btf.h5 --plane top --heights off --size 26x4 --noise 10 --bounces 0 \
    --resolution 20 --directions ten.csv --seed 3
expect_says "times, on 96 of 104 texels, lobes on 64:" tradeoff wide.btf.h5 -o wide
for options in "--lobes 1" "--components 8"; do
    # shellcheck disable=SC2086
    expect_ok compress wide.btf.h5 -o wide.weft $options --json
    cp out.log events.log
    options=$options "$python" - <<'PYTHON' || fail "the list and weft compress do not say the same of $options"
import csv, json, os
row = next(r for r in csv.DictReader(open("wide/tradeoff.csv")) if r["options"] == os.environ["options"])
events = [json.loads(line) for line in open("events.log")]
said = next(e for e in events if e["event"] == "held_out")["not_fitted"]["relative_rmse"]
listed = float(row["not_fitted_all_relative_rmse"])
# The list takes the samples of all splits together, weft compress means over the splits.
assert abs(listed / said - 1) < 0.03, (listed, said)
print(os.environ["options"], listed, said)
PYTHON
done
