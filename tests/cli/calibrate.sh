#!/bin/sh
# The axes of a rig out of a series of small photographs, and a capture that knows them. Usage: calibrate.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/calibrate-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

weave="$assets/weaves/polyester_lining.wv"
cat >off.json <<'JSON'
{"rig": "virtual", "width_px": 176, "height_px": 176, "focal_length_px": 810, "samples_per_pixel": 4, "axes": 1,
 "axis_tilt_deg": 0.5, "axis_zero_deg": 0.5, "aim_rotation_deg": 0.3}
JSON
sed -n '1,12p' "$assets/plans/calibration.csv" >plan.csv
expect_ok capture --rig off.json --sample "$weave" --plan plan.csv --truth-images 1 --truth-size 4 -o series

# What cannot be used is named and left out; the rest is enough. Words and figures, as events.
truncate -s 20000 series/tv000_pv000/*.tif
convert -size 176x176 xc:gray -depth 16 -type TrueColor series/tv020_pv030/tl030_pl150_tv020_pv030.tif
expect_ok calibrate series --plan plan.csv --json -o rig.poses.json
"$python" - out.log <<'PYTHON' || fail "the events are not what they should be"
import json, re, sys
events = [json.loads(line) for line in open(sys.argv[1])]
notes = "\n".join(e["text"] for e in events if e["event"] == "note")
for words in ("left out tv000_pv000/", "left out tv020_pv030/", "the target", "9 of 11 shots",
              "predicted before registration refines them, 11 poses", "cannot see the axes of the light"):
    assert words in notes, (words, notes)
poses = [e for e in events if e["event"] == "poses"][0]
known = re.search(r"lines are known to (\S+) degrees by these 9 shots; to (\S+) by 18, to (\S+) by 36 like them", notes)
worst = max(joint["direction_error_deg"] for joint in poses["joints"]) * 2 ** 0.5
for number, share in zip(known.groups(), (1, 0.5 ** 0.5, 0.5)):
    assert worst > 0.005 and abs(float(number) - worst * share) < 0.0006, (known[0], worst)
assert poses["good_enough"] is True and poses["unreachable"] == 0, poses
assert poses["used"] == 9 and poses["shots"] == 11 and poses["poses"] == 11, poses
assert 0 < poses["held_out_rms_px"] < 1.5 and poses["expected_worst_texels"] >= poses["expected_median_texels"] > 0
file = json.load(open("rig.poses.json"))
assert len(file["left_out"]) == 2 and len(file["used"]) == 9
PYTHON

# A capture that knows them records where they put the camera, and goes on with the same alone.
printf '%s\n' theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg 30,0,0,0 >one.csv
expect_ok capture --rig off.json --sample "$weave" --plan one.csv --poses rig.poses.json --truth-images 1 --truth-size 4 -o night
grep -q '"pose"' night/session.json || fail "the session does not know the poses"
expect_error 1 "begun with other poses" capture --rig off.json --sample "$weave" --plan one.csv -o night

# Several cameras: each is calibrated by itself, and has poses of its own.
sed 's/"axes": 1,/"axes": 1, "cameras": 2,/' off.json >two.json
printf '%s\n' theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg 30,0,30,90 30,0,30,270 >pair.csv
mkdir poses
cp rig.poses.json poses/camera1.json
two="capture --rig two.json --sample $weave --plan pair.csv --truth-images 1 --truth-size 4"
# shellcheck disable=SC2086
{
    expect_error 1 "'poses/camera2.json'" $two --poses poses -o no
    cp rig.poses.json poses/camera2.json
    expect_ok $two --poses poses -o alike
    "$python" - <<'PYTHON'
import json
poses = json.load(open("rig.poses.json"))
poses["home"]["translation_mm"][0] += 1
json.dump(poses, open("poses/camera2.json", "w"))
PYTHON
    expect_error 1 "'rig.poses.json' must be a folder with one file for each camera, such as 'camera1.json'" $two --poses rig.poses.json -o no
    expect_ok $two --poses poses -o pair
}
"$python" - <<'PYTHON' || fail "the cameras do not have poses of their own"
import json
pose = {(night, camera): json.load(open(f"{night}/camera{camera}/session.json"))["plan"][0]["pose"]
        for night in ("alike", "pair") for camera in (1, 2)}
assert pose["pair", 1] == pose["alike", 1] and pose["pair", 2] != pose["alike", 2], pose
PYTHON
expect_error 1 "name one of them, such as 'pair/camera1'" calibrate pair -o no.poses.json
expect_error 1 "'poses' is a folder; there is one camera" capture --rig off.json --sample "$weave" --plan one.csv --poses poses -o no

# Poses that are not of this rig, whatever is asked of it.
sed 's/176/96/g' off.json >small.json
for what in "" --dry-run --check; do
    expect_error 1 "'rig.poses.json' is for photographs of 176 x 176" capture --rig small.json --sample "$weave" --plan one.csv --poses rig.poses.json -o no $what
done
"$python" - <<'PYTHON'
import json
poses = json.load(open("rig.poses.json"))
poses["home"]["translation_mm"][2] *= -1
json.dump(poses, open("behind.poses.json", "w"))
poses["home"]["translation_mm"][2] *= -1
poses["camera"]["k1"] += 0.1
json.dump(poses, open("lens.poses.json", "w"))
PYTHON
expect_error 1 "'behind.poses.json' puts the camera" capture --rig off.json --sample "$weave" --plan one.csv --poses behind.poses.json -o no
expect_error 1 "'lens.poses.json' has another lens" capture --rig off.json --sample "$weave" --plan one.csv --poses lens.poses.json -o no

# A night that the shots say nothing of, or not all, is not called good.
view() { printf '%s\n' theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg "$@"; }
view 30,180,0,0 30,180,10,0 30,180,20,0 30,180,30,0 30,180,40,0 30,180,50,0 30,180,60,0 30,180,70,0 >arc.csv
expect_ok capture --rig off.json --sample "$weave" --plan arc.csv --truth-images 1 --truth-size 4 -o arc
view 30,0,45,90 >beside.csv
view 30,0,45,90 30,180,45,0 >both.csv
expect_ok calibrate arc --plan both.csv --json -o arc.poses.json
grep -q '"unreachable":1,.*"good_enough":false' out.log || fail "one view of two is good enough: $(cat out.log)"
grep -q "good enough for 1 of the 2 views" out.log || fail "not said: $(cat out.log)"
expect_ok calibrate arc --plan beside.csv --json -o arc.poses.json
grep -q '"unreachable":1,.*"good_enough":false' out.log || fail "no view is good enough: $(cat out.log)"
grep -q "NOT good enough: no view of the plan is reached" out.log || fail "not said: $(cat out.log)"

# What cannot be.
sed 's/"weft_poses": 1/"weft_poses": 3/' rig.poses.json >new.poses.json
expect_error 1 "poses of version 3" capture --rig off.json --sample "$weave" --poses new.poses.json -o no
head -c 300 rig.poses.json >cut.poses.json
expect_error 1 cut.poses.json capture --rig off.json --sample "$weave" --poses cut.poses.json -o no
expect_error 1 absent calibrate absent -o no.poses.json
expect_error 1 "the target is found in 1 of 1 shots: at least 8 are needed" calibrate night -o no.poses.json
sed 's/"axes": 1,/"axes": 0,/' off.json >flat.json
expect_error 1 "calibrated poses need a rig with axes" capture --rig flat.json --sample "$weave" --plan plan.csv --poses rig.poses.json -o no
expect_ok capture --sample "$weave" --rig flat.json --plan one.csv --truth-images 1 --truth-size 4 -o flat
expect_error 1 "does not record the turns of its axes" calibrate flat -o no.poses.json
expect_error 1 absent.csv calibrate series --plan absent.csv -o no.poses.json
expect_no_file no
expect_no_file no.poses.json
echo sound
