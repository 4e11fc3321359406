#!/bin/sh
# The command weft truth, whole: what it says, writes and refuses. Usage: truth.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/truth-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

cat >rig.json <<'JSON'
{"rig": "virtual", "width_px": 112, "height_px": 112, "focal_length_px": 500, "samples_per_pixel": 2, "bounces": 0}
JSON
awk 'BEGIN {
    print "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg"
    for (view = 0; view < 5; view++)
        for (light = 0; light < 13; light++)
            print 40 * (light > 0) "," 30 * light - 180 "," 35 * (view > 0) "," 90 * view - 180
}' >plan.csv

wool="$assets/weaves/wool_gabardine.wv"
weave="$assets/stitches/plain_weave.stitch"
set -- --rig rig.json --plan plan.csv --texels 8 --components 8 --queries 100 --paths 16
expect_ok truth "$wool" "$weave" "$@" -o report --json --threads 1
cp out.log events
"$python" - <<'PYTHON' || fail "the results are not what they should be"
import csv, json, math
rows = list(csv.DictReader(open("report/sources.csv")))
events = [e for e in map(json.loads, open("events")) if e["event"] == "sources"]
assert [e["cloth"] for e in events] == ["Wool gabardine", "Plain weave"], events
for event in events:
    mine = {r["source"]: r for r in rows if r["cloth"] == event["cloth"]}
    parts = ["directions", "registration", "model", "storage"]
    whole = float(mine["whole"]["squared_relative_error"])
    assert abs(sum(float(mine[p]["squared_relative_error"]) for p in parts) - whole) < 1e-4 * whole, mine
    for p in parts:
        assert math.isclose(event[p]["value"], float(mine[p]["squared_relative_error"]), rel_tol=1e-4), (p, mine)
        assert event[p]["low"] <= event[p]["value"] <= event[p]["high"], event
    assert math.isclose(event["relative_rmse"] ** 2, whole, rel_tol=1e-4) and 0.001 < whole < 1, event
    assert event["queries"] + event["queries_unseen"] == 100 and event["photographs"] == 65, event
    assert event["components"] == 8 and math.isclose(event["outermost_deg"], 35, rel_tol=1e-6), event
assert math.isclose(events[1]["opening_mm"], 2, rel_tol=1e-9) and events[0]["opening_mm"] == 32, events
PYTHON
[ "$(ls -A report | tr '\n' ' ')" = "index.html sources.csv " ] || fail "something is left behind: $(ls -A report)"
expect_page report
[ "$(grep -o '<rect class="bar' report/index.html | wc -l)" = 8 ] || fail "there are not two stacks of four parts"
for word in "Plain weave" "65 photographs" "8 × 8 texels" "fitted by 8 components" "up to 35°"; do
    grep -q "$word" report/index.html || fail "the page does not say '$word'"
done

# Refused in one line.
expect_error 2 "needs one cloth or more" truth -o report
expect_error 2 "needs one cloth or more" truth "$wool"
expect_error 2 "--components" truth "$wool" --components 36 -o report
expect_error 1 "absent.wv" truth absent.wv -o none
expect_error 1 "rig.json" truth rig.json -o none
expect_error 1 "absent.json" truth "$wool" --rig absent.json -o none
expect_error 1 "absent.csv" truth "$wool" --rig rig.json --plan absent.csv -o none
expect_error 3 "rig.json/none" truth "$wool" -o rig.json/none
[ ! -e none ] || [ -z "$(ls -A none)" ] || fail "something is left of what was refused"
