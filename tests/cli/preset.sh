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
cp out.log preset.log
expect_ok info knit.weft --json
fps=$fps "$python" - <<'PYTHON' || fail "the preset does not keep to what it says"
import json, os, re
events = [json.loads(line) for line in open("events.log")]
predicted = next(e for e in events if e["event"] == "predicted")
measured = next(e for e in events if e["event"] == "held_out")
first_fit = next(i for i, e in enumerate(events) if e.get("stage") in ("fitting texels", "learning components"))
assert events.index(predicted) < first_fit, "it is said after the work"
size = os.path.getsize("knit.weft")
assert abs(predicted["bytes"] / size - 1) < 0.02, (predicted["bytes"], size)
assert abs(predicted["relative_rmse"] / measured["not_fitted"]["relative_rmse"] - 1) < 0.25, (predicted, measured)
notes = [e["text"] for e in events if e["event"] == "note"]
assert any(re.match(r"predicted [0-9.]+ MB, measured [0-9.]+ MB", n) for n in notes), notes
kept = json.loads(open("out.log").read())["metadata"]["predicted"]
assert kept == {k: v for k, v in predicted.items() if k != "event"}, kept
assert ("frame_ms" in predicted) == bool(os.environ["fps"]) and predicted.get("frame_ms", 1) > 0, predicted
assert predicted["preset"] == "balanced" and predicted["options"].startswith("--"), predicted
PYTHON
[ "$(ls -A | grep -c held-out)" = 0 ] || fail "compress --preset leaves files behind"

for option in "--lobes 2" "--components 8" "--error 5" "--budget 1"; do
    # shellcheck disable=SC2086
    expect_error 2 "choose the model" compress knit.btf.h5 -o none.weft --preset small $option
done
expect_error 2 "choose the model" compress knit.btf.h5 -o none.weft --fps 20 --components 8
expect_error 2 "--fps" compress knit.btf.h5 -o none.weft --fps 0
expect_error 2 "--preset" compress knit.btf.h5 -o none.weft --preset tiny
expect_no_file none.weft

[ "${4-}" = long ] || exit 0

# An error and a budget choose the number of components, and say what they chose before the work; a budget holds with
# what is added to the file.
for asked in "--error 40" "--budget 0.04"; do
    # shellcheck disable=SC2086
    expect_ok compress knit.btf.h5 -o chosen.weft $asked --json
    cp out.log events.log
    asked=$asked "$python" - <<'PYTHON' || fail "compress $asked does not keep to what it says"
import json, os, re
events = [json.loads(line) for line in open("events.log")]
chosen = next(e for e in events if e["event"] == "chosen")
measured = next(e for e in events if e["event"] == "held_out")
assert events.index(chosen) < next(i for i, e in enumerate(events) if e.get("stage") == "learning components")
assert 4 <= chosen["components"] <= 64 and chosen["components"] % 4 == 0, chosen
if "--error" in os.environ["asked"]:
    assert chosen["met"] == (chosen["relative_rmse"] <= 0.4), chosen
    assert chosen["relative_rmse"] == measured["not_fitted"]["relative_rmse"], (chosen, measured)
else:
    size = os.path.getsize("chosen.weft")
    assert size <= 40000 and abs(chosen["predicted_bytes"] / size - 1) < 0.05, (chosen, size)
    assert any(re.match(r"predicted [0-9.]+ MB, measured [0-9.]+ MB", e["text"]) for e in events if e["event"] == "note")
PYTHON
    [ "$(ls -A | grep -c held-out)" = 0 ] || fail "compress $asked leaves files behind"
done

# The same model without a preset is the same material but for what was predicted.
options=$("$python" - <<'PYTHON'
import json
events = [json.loads(line) for line in open("preset.log")]
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
