#!/bin/sh
# What the commands say of themselves. Usage: help.sh WEFT ASSETS PYTHON
set -eu
weft=$1
page="$2/../docs/reference/commands.md"
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/help-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

expect_ok --help
sed -n 's/^  \([a-z-]*\)  *\(.*\)$/\1|\2/p' out.log >commands
[ "$(wc -l <commands)" -ge 14 ] || fail "weft --help lists too few commands"
while IFS='|' read -r name summary; do
    grep -qF "| $name | $summary" "$page" || fail "docs/reference/commands.md lacks '$name', or says other words than '$summary'"
    expect_ok "$name" --help
    grep -q "^Example: weft $name " out.log || fail "weft $name --help has no example"
    for option in --quiet --json --threads; do
        grep -q -- " $option" out.log || fail "weft $name --help lacks $option"
    done
    expect_error 2 "unrecognized option" "$name" --no-such-option
done <commands
[ "$(grep -c '^| [a-z-]* | [a-z]' "$page")" = "$(wc -l <commands)" ] || fail "docs/reference/commands.md lists a command that is none"

# What is not given, given twice, or both read and written.
expect_error 2 "needs NAME.btf.h5 and -o NAME.weft" compress cloth.btf.h5
expect_error 2 "needs NAME.btf.h5 and -o TILE.btf.h5" tile -o tile.btf.h5
expect_error 2 "one session at a time" register one two -o no.btf.h5
expect_error 2 "one dataset at a time" bard one.btf.h5 two.btf.h5 -o no.btf.h5
touch same.btf.h5
for name in compress tile bard; do
    expect_error 2 "would overwrite" "$name" same.btf.h5 -o ./same.btf.h5
done
touch same.wv same.exr same.csv
expect_error 2 "would overwrite" fit-weave cloth.btf.h5 --weave same.wv -o ./same.wv
expect_error 2 "would overwrite" tile cloth.btf.h5 --weave same.wv -o ./same.wv
expect_error 2 "would overwrite" eval cloth.wv --at same.csv -o ./same.csv
expect_error 2 "would overwrite" simulate cloth.stitch --directions same.csv -o ./same.csv
expect_error 2 "would overwrite" simulate cloth.stitch --directions same.csv --obj ./same.csv
expect_error 2 "would overwrite" render "$(dirname "$0")/../golden/good/material/example.weft" --environment same.exr -o ./same.exr
expect_error 2 "needs -o NAME.pdf or NAME.svg" target
expect_error 2 "the largest that fits is 51.6" target -o no.pdf --opening 52
expect_error 2 "--paper needs A4, A3, A5, letter, legal, tabloid or WxH" target -o no.pdf --paper B9
expect_error 2 "does not end in .pdf or .svg" target -o no.png
expect_error 2 "--board has no opening" target -o no.pdf --board --opening 40
expect_error 2 "needs photographs, --board BOARD" lens -o no.json --board plate:50
expect_error 2 "needs photographs, --board BOARD" lens one.jpg two.jpg -o no.json
expect_error 2 "--board needs charuco:COLUMNSxROWS:SQUARE_MM,MARKER_MM" lens one.jpg -o no.json --board charuco:7x9:28
expect_error 2 "would overwrite" lens one.jpg same.csv -o ./same.csv --board plate:50
expect_error 2 "needs a photograph of a colour chart and -o COLOUR.json" colour one.jpg
expect_error 2 "would overwrite" colour same.csv -o ./same.csv
expect_error 2 "classic-2005" colour one.jpg -o no.json --chart vinyl
expect_error 1 "one.jpg" colour one.jpg -o no.json
expect_error 2 "needs SESSION and -o POSES.json" calibrate -o no.json
expect_error 2 "one session at a time" calibrate one two -o no.json
expect_error 2 "would overwrite" calibrate session --plan same.csv -o ./same.csv
expect_error 2 "--poses needs the virtual rig" capture --rig my.conf --poses rig.poses.json --sample scarf -o no
expect_error 1 "there is no 'one.jpg'" lens one.jpg two.jpg -o no.json --board plate:50
expect_error 2 "--size needs WxH" register session -o no.btf.h5 --size 64
expect_error 2 "--tiles needs two numbers above 0" render --weave cloth.wv --tiles 0,3 -o no.png
expect_error 2 "--tiles needs two numbers above 0" compare a.btf.h5 a.weft --tiles 2,-1 -o report
expect_error 2 "--tiles needs --weave" compare a.btf.h5 a.weft --tiles 2,1 -o report
expect_error 2 "--paths needs --truth" compare a.btf.h5 a.weft --paths 16 -o report
expect_error 2 "--obj-tiles needs WxH" simulate cloth.stitch --obj cloth.obj --obj-tiles 2,1
expect_error 2 "needs CLOTH.wv" synthetic -o folder
expect_error 2 "one cloth at a time" synthetic checker cloth.wv -o folder
expect_error 2 "--rubbish 5 leaves no photograph" synthetic checker -o folder --photographs 5 --rubbish 5
expect_error 2 "--set" synthetic checker -o folder --set handheld
expect_error 2 "--format" synthetic checker -o folder --format png
expect_error 1 "cloth.wv" synthetic cloth.wv -o folder
[ ! -e folder ] || fail "weft synthetic made a folder for nothing"
expect_error 2 "is not empty" synthetic checker -o .
"$weft" hand --help >former 2>note || fail "the former name of a command is refused"
"$weft" synthetic --help >now
cmp -s former now || fail "the former name of a command runs another one"
[ "$(cat note)" = "weft: 'hand' is now called 'synthetic'" ] || fail "the note on a former name reads '$(cat note)'"
for seed in 0 -1 2147483648; do
    for command in "eval cloth.wv --at directions.csv" "render --weave cloth.wv -o no.png" "play --weave cloth.wv"; do
        expect_error 2 "--noise needs a whole number from 1 to 2147483647, not '$seed'" $command "--noise=$seed"
    done
done
expect_error 1 "cloth.wv" eval cloth.wv --at directions.csv --noise 2147483647
expect_error 1 "cloth.wv" eval cloth.wv --at directions.csv --noise off
echo "$passed commands as expected"
