#!/bin/sh
# From photographs of a hand to a dataset, as a user does it, held against what is true of the photographs. The virtual
# hand that takes them shares no formula with what registers them (docs/reference/synthetic.md).
set -eu
weft=$1
python=$3
here=$(cd "$(dirname "$0")" && pwd)
. "$here/expect.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM
cd "$work"

# One line on stderr that holds the words given, exit code 1, and no dataset.
refused() {
    words=$1
    shift
    if "$weft" photographs "$@" -o refused.btf.h5 -q >out 2>err; then
        fail "accepted: $*"
    fi
    [ "$(wc -l <err)" = 1 ] && grep -q "$words" err || fail "'$words' is not said of $*: $(cat err)"
    [ ! -e refused.btf.h5 ] || fail "a dataset was left behind"
}

"$weft" synthetic checker --opening 40 -o free --photographs 9 --rubbish 4 --width 750 --truth-size 32 -q
echo nothing >free/broken.jpg
"$weft" photographs free -o free.btf.h5 --opening 40 --size 32x32 --report report >said 2>/dev/null
"$python" "$here/photographs.py" free || fail "set free is wrong"
for fault in "blurred" "something else" "lens covered" "covered" "broken.jpg"; do
    grep -q "left out .*$fault" said || fail "nobody said '$fault'"
done
[ "$(grep -c "left out '" said)" = 5 ] || fail "not five are left out: $(cat said)"
expect_page report

# Other ways to find the lamps: tests/registration has them in parts.
if [ "${4-}" = long ]; then
    "$weft" synthetic checker --opening 40 -o tripod --photographs 8 --set tripod --width 900 --truth-size 32 -q
    # The list of lamps has one row that is wrong, other case and the folders of another computer.
    awk 'NR == 1 || NR != 4 { if (NR > 1) $1 = "C:\\RTI\\" toupper($1); print } NR == 4 { print $1, -$2, -$3, $4 }' tripod.lp >dome.lp
    "$weft" photographs tripod -o tripod.btf.h5 --opening 40 --size 32x32 --lights dome.lp >said 2>/dev/null
    [ "$(grep -c "its lamp is .* degrees from that in dome.lp:" said)" = 1 ] || fail "not one row is doubted: $(cat said)"
    grep -q "dome.lp:4," said || fail "another row is doubted: $(cat said)"
    "$python" "$here/photographs.py" tripod || fail "set tripod is wrong"

    # The pin alone, with no list.
    "$weft" synthetic checker --opening 40 -o pin --photographs 8 --set tripod --no-balls --seed 9 --width 900 --truth-size 32 -q
    "$weft" photographs pin -o pin.btf.h5 --opening 40 --size 32x32 --balls 0 -q 2>/dev/null
    "$python" "$here/photographs.py" pin || fail "set pin is wrong"

    # Neither, but three views photographed twice: they tell the tone curve, and so the lamps.
    "$weft" synthetic checker --opening 40 -o series --photographs 10 --series 3 --no-balls --no-pin --seed 6 --width 900 --truth-size 32 -q
    "$weft" photographs series -o series.btf.h5 --opening 40 --size 32x32 --balls 0 --pin 0 --report series-report >said 2>/dev/null
    "$python" "$here/photographs.py" series || fail "set series is wrong"
    for where in said series-report/index.html; do
        grep -q "in 3 pairs of photographs that differ in exposure alone" $where || fail "$where has no pairs: $(cat said)"
        grep -q "are too dark to be read" $where || fail "$where does not tell what is masked"
    done
    grep -q "focal length.*standard error" series-report/index.html || fail "the report does not tell how well the lens is known"

    # Photographs of an independent renderer, where there are any.
    independent=${WEFT_SHARED:+$WEFT_SHARED/photographs}
    [ -d "$independent" ] || echo "skipped: the photographs of an independent renderer are not here"
    for set in ${independent:+paper-alone bowed flash}; do
        [ -d "$independent/$set" ] || continue
        case $set in paper-alone) told="--balls 0 --pin 0" ;; flash) told="--flash --balls 0 --pin 0" ;; *) told= ;; esac
        # shellcheck disable=SC2086 # options, or none
        "$weft" photographs "$independent/$set" -o "$set.btf.h5" --size 32x32 $told -q 2>/dev/null
        "$python" "$here/photographs.py" "$set" "$independent/$set/truth.json" || fail "set $set is wrong"
    done
    if [ -d "$independent/flash" ]; then
        refused "the lamp stood beside the camera" "$independent/flash" --size 32x32 --balls 0 --pin 0
    fi
fi

"$weft" synthetic checker --opening 40 -o linear --photographs 5 --format exr --width 800 --truth-size 32 -q
"$weft" photographs linear -o linear.btf.h5 --opening 40 --size 32x32 -q 2>/dev/null
"$python" "$here/photographs.py" linear || fail "set linear is wrong"

# A colour is applied to reflectance, once.
residual='{"mean": 1, "worst": 2}'
echo "{\"weft_colour\": 1, \"model\": \"linear\", \"ciede2000\": {\"fitted\": $residual, \"left_out\": $residual}," \
    "\"matrix\": [[1.5, -0.4, -0.1], [-0.2, 1.3, -0.1], [0, -0.5, 1.5]]}" >colour.json
"$weft" photographs linear -o coloured.btf.h5 --opening 40 --size 32x32 --colour colour.json >said 2>/dev/null
grep -q "colours: linear sRGB" said || fail "nobody spoke of colours: $(cat said)"
"$python" "$here/coloured.py" linear.btf.h5 coloured.btf.h5 colour.json || fail "the colour is not that of colour.json"

# Of files that say Display P3 the colours are turned into sRGB, unless the colours of the camera are known better.
cp -r linear wide
"$python" "$here/../import/exr_primaries.py" wide/*.exr
echo "{\"matrix\": [[1.22494, -0.22494, 0], [-0.04206, 1.04206, 0], [-0.01964, -0.07864, 1.09828]]}" >wide.json
"$weft" photographs wide -o wide.btf.h5 --opening 40 --size 32x32 >said 2>/dev/null
grep -q "chromaticities say .*; turned into sRGB ([0-9] of [0-9] photographs)" said || fail "nobody spoke of Display P3: $(cat said)"
"$python" "$here/coloured.py" linear.btf.h5 wide.btf.h5 wide.json file || fail "Display P3 was not turned into sRGB"
if [ "${4-}" = long ]; then
    "$weft" photographs wide -o known.btf.h5 --opening 40 --size 32x32 --colour colour.json >said 2>/dev/null
    ! grep -q "turned into sRGB" said || fail "two colours were applied: $(cat said)"
    "$python" "$here/coloured.py" linear.btf.h5 known.btf.h5 colour.json || fail "colour.json counts less than the files"
fi

mkdir empty
touch file
refused "cannot create folder" free --report file/report
printf '1\nfree.jpg 0 0 up\n' >bad.lp
refused "bad.lp:2" free --lights bad.lp
printf '1\nfree.jpg 0 0 1\n' >other.lp
refused "none of the photographs" free --lights other.lp
refused "holds no photograph .*: it is empty" empty
mkdir same
for i in 1 2 3; do cp "$(find linear -name '*.exr' | head -1)" same/$i.exr; done
refused "all 3 photographs that can be used show one view under one light" same --opening 40
mkdir few
find free -iname "IMG*" | head -2 | xargs -I{} cp {} few/
refused "holds 2 photographs, 3 are needed and 20 do better: take more" few
mkdir raw
for i in 1 2 3; do echo noise >raw/$i.CR2; done
refused "none of the 3 images in 'raw' can be read: .*; save them as JPEG" raw
mkdir other
for name in free/*; do
    cp report/000_sample.png "other/$(basename "$name").png"
done
refused "show the target, 3 are needed; .*; photograph the whole sheet that weft target prints" other
