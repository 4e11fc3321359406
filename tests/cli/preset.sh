#!/bin/sh
# weft compress --preset, whole: what it predicts, keeps and refuses. Usage: preset.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/preset-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

simulate_knit
# A preset says before the work what it will cost, and keeps to it. Where frames can be drawn, a hundredth of one a second is no
# condition, and the file says how many there are.
fps='--fps 0.01'
if ! "$weft" compress knit.btf.h5 -o knit.weft --preset balanced $fps --json >out.log 2>err.log; then
    grep -q "frames cannot be timed" err.log || fail "$(cat err.log)"
    fps=
    expect_ok compress knit.btf.h5 -o knit.weft --preset balanced --json
fi
cp out.log events.log
expect_ok info knit.weft --json
fps=$fps "$python" - <<'PYTHON' || fail "the preset does not keep to what it says"
import json, os, re
events = [json.loads(line) for line in open("events.log")]
predicted = next(e for e in events if e["event"] == "predicted")
measured = next(e for e in events if e["event"] == "held_out")
first_fit = next(i for i, e in enumerate(events) if e.get("stage") == "fitting texels")
assert events.index(predicted) < first_fit, "it is said after the work"
size = os.path.getsize("knit.weft")
assert abs(predicted["bytes"] / size - 1) < 0.02, (predicted["bytes"], size)
assert abs(predicted["relative_rmse"] / measured["not_fitted"]["relative_rmse"] - 1) < 0.25, (predicted, measured)
notes = [e["text"] for e in events if e["event"] == "note"]
assert any(re.match(r"predicted [0-9.]+ MB, is [0-9.]+ MB", n) for n in notes), notes
kept = json.loads(open("out.log").read())["metadata"]["predicted"]
assert kept == {k: v for k, v in predicted.items() if k != "event"}, kept
assert ("frame_ms" in predicted) == bool(os.environ["fps"]) and predicted.get("frame_ms", 1) > 0, predicted
assert predicted["preset"] == "balanced" and predicted["options"].startswith("--"), predicted
PYTHON
[ "$(ls -A | grep -c held-out)" = 0 ] || fail "compress --preset leaves files behind"

# The same model without a preset is the same material but for what was predicted.
options=$("$python" - <<'PYTHON'
import json
events = [json.loads(line) for line in open("events.log")]
print(next(e for e in events if e["event"] == "predicted")["options"])
PYTHON
)
# shellcheck disable=SC2086
expect_ok compress knit.btf.h5 -o plain.weft $options
"$python" - <<'PYTHON' || fail "the preset does not compress as its options do"
import os
sizes = os.path.getsize("knit.weft"), os.path.getsize("plain.weft")
assert 0 < sizes[0] - sizes[1] < 400, sizes
PYTHON
# What each texel is given by itself is predicted, too; a budget holds with what is added to the file.
for asked in "--error 40" "--budget 0.03"; do
    # shellcheck disable=SC2086
    expect_ok compress knit.btf.h5 -o chosen.weft $asked --json
    cp out.log events.log
    expect_ok info chosen.weft --json
    asked=$asked "$python" - <<'PYTHON' || fail "compress $asked does not keep to what it says"
import json, os, re
events = [json.loads(line) for line in open("events.log")]
predicted = next(e for e in events if e["event"] == "predicted")
measured = next(e for e in events if e["event"] == "held_out")
assert events.index(predicted) < next(i for i, e in enumerate(events) if e.get("stage") == "fitting texels")
size = os.path.getsize("chosen.weft")
assert abs(predicted["bytes"] / size - 1) < 0.02, (predicted["bytes"], size)
# Of 64 texels and 49 photographs five are held out, others each time.
assert abs(predicted["relative_rmse"] / measured["not_fitted"]["relative_rmse"] - 1) < 0.4, (predicted, measured)
assert predicted["options"] == os.environ["asked"] and "preset" not in predicted, predicted
assert any(re.match(r"predicted [0-9.]+ MB, is [0-9.]+ MB", e["text"]) for e in events if e["event"] == "note")
kept = json.loads(open("out.log").read())["metadata"]["predicted"]
assert kept == {k: v for k, v in predicted.items() if k not in ("event", "frame_ms")}, kept
assert "--error" in os.environ["asked"] or size <= 30000, size
PYTHON
    [ "$(ls -A | grep -c held-out)" = 0 ] || fail "compress $asked leaves files behind"
done

for option in "--lobes 2" "--table off" "--components 8" "--light-table on" "--rounding on" "--frames off" "--error 5" "--budget 1"; do
    # shellcheck disable=SC2086
    expect_error 2 "choose the model" compress knit.btf.h5 -o none.weft --preset small $option
done
expect_error 2 "choose the model" compress knit.btf.h5 -o none.weft --fps 20 --components 8
expect_error 2 "--fps" compress knit.btf.h5 -o none.weft --fps 0
expect_error 2 "--preset" compress knit.btf.h5 -o none.weft --preset tiny
expect_no_file none.weft
expect_error 2 "--rounding is for layers" compress knit.btf.h5 -o none.weft --lobes 2 --rounding on
expect_error 2 "--rounding is for layers" compress knit.btf.h5 -o none.weft --components 0 --rounding on
