#!/bin/sh
# What a user gets wrong is said before any work is done: one line, the right exit code, no file. Usage: bad_usage.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/bad-usage-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

weave="$assets/weaves/polyester_lining.wv"
write_plan >plan.csv
expect_ok capture --sample "$weave" --plan plan.csv --truth-images 1 --truth-size 4 -o good
expect_ok register good --size 8x8 -o good.btf.h5
expect_ok compress good.btf.h5 --lobes 1 -o good.weft

# One line of weft's own; argp adds where help is to be had.
expect_one_line() {
    expect_error "$@"
    [ "$(grep -c "^weft " err.log)" = 1 ] || fail "more than one line: $(cat err.log)"
}

# One file in the place of another.
expect_one_line 1 "'good.weft' is a material" compress good.weft -o out.weft
expect_one_line 1 "'good.weft' is a material" compare good.weft good.btf.h5 -o report
expect_one_line 1 "'good.weft' is a material" tile good.weft -o out.btf.h5
expect_one_line 1 "'good.btf.h5' is not a material" tile good.btf.h5 --blend -o out.weft
expect_one_line 1 "8 x 8 texels; at least 16 x 16" tile good.weft --blend -o out.weft
expect_one_line 2 "--blend needs none" tile good.weft --blend --weave "$weave" -o out.weft
expect_one_line 1 "'good.weft' is a material" render --raw good.weft -o out.png
expect_one_line 1 "'good.btf.h5' is a dataset" compare good.btf.h5 good.btf.h5 -o report
expect_no_file out.weft
expect_no_file out.btf.h5
expect_no_file report

# A file of the wrong kind is named as what it is, by the command that was given it. CODE WORD | ARGUMENTS
mkdir folder empty_files
head -c 200 good.weft >cut.weft
mkdir left && echo '{' >left/cameras.json
: >empty
: >zero.png
: >empty_files/a.jpg
: >empty_files/b.jpg
: >empty_files/c.jpg
convert -size 32x32 xc:gray picture.png
cp "$weave" cloth.wv
cp "$assets/stitches/plain_knit.stitch" knit.stitch
while IFS='|' read -r code word arguments; do
    # shellcheck disable=SC2086
    expect_one_line "$code" "$word" $arguments </dev/null
    expect_no_file out
done <<'TABLE'
1|'cloth.wv' is a weave; NAME.btf.h5 is needed here|compress cloth.wv -o out
1|'knit.stitch' is a stitch|compress knit.stitch -o out
1|'picture.png' is a picture|compress picture.png -o out
1|'empty' is empty|compress empty -o out
1|'plan.csv' is neither|compress plan.csv -o out
1|'folder' is a folder|compress folder -o out
1|'good' is a folder|compress good -o out
2|not 'many'|compress good.btf.h5 --components many -o out
2|not a regular file|compress good.btf.h5 -o /dev/full
2|unexpected argument|compress good.weft good.btf.h5 -o out
2|would overwrite|compress good.btf.h5 -o good.btf.h5
3|'empty' is a file|compress good.btf.h5 -o empty/out
1|'picture.png' is a picture; NAME.weft is needed here|compare good.btf.h5 picture.png -o out
1|'knit.stitch' is a stitch; CLOTH.wv or CLOTH.mc is needed here|compare good.btf.h5 good.weft --weave knit.stitch -o out
1|'cloth.wv' is a weave; FILE.stitch is needed here|compare good.btf.h5 good.weft --truth cloth.wv -o out
1|'good' is a folder|compare good good.weft -o out
3|'/dev/full' is a file|compare good.btf.h5 good.weft -o /dev/full
1|'good.btf.h5' is no prediction|compare good.btf.h5 good.weft --bard good.btf.h5 -o out
2|needs --weave|compare good.btf.h5 good.weft --fit -o out
1|'picture.png' is a picture; NAME.btf.h5 or NAME.weft is needed here|tile picture.png -o out
2|'out.btf.h5' names a dataset|tile good.weft --blend -o out.btf.h5
2|'out.weft' names a material|tile good.btf.h5 -o out.weft
1|'cloth.wv' is a weave|relief cloth.wv -o out
1|'cloth.wv' is a weave|bard cloth.wv -o out
1|'knit.stitch' is a stitch; START.wv is needed here|fit-weave good.btf.h5 --weave knit.stitch -o out
1|'good.weft' is a material|tradeoff good.weft -o out
1|'good.btf.h5' is a dataset; SESSION is needed here|register good.btf.h5 -o out
1|'folder' is not a session|register folder -o out
1|'folder' is a folder, but no session|info folder
1|'folder' is not a session|calibrate folder -o out
1|left/cameras.json|register left -o out
2|WxH|register good --size 5 -o out
2|unexpected argument|register good folder -o out
1|'good.btf.h5' is a dataset; FOLDER is needed here|photographs good.btf.h5 -o out
1|holds no photograph|photographs folder -o out
1|can be read|photographs empty_files -o out
1|'picture.png' is a picture; LENS.json is needed here|photographs empty_files --lens picture.png -o out
1|'cloth.wv' is a weave; CHART.jpg or SESSION is needed here|colour cloth.wv -o out
1|not a folder of photographs|import picture.png -o out
1|use `weft register`|import good -o out
1|expected 'stitch'|simulate cloth.wv -o out
2|--noise needs|simulate knit.stitch --noise -1 -o out
1|'good.weft' is a material; CLOTH.wv or .stitch... is needed here|truth good.weft -o out
1|'picture.png' is not text|truth cloth.wv --plan picture.png -o out
1|no file 'absent.wv'|truth cloth.wv absent.wv -o out
1|'picture.png' is a picture; DIRECTIONS.csv is needed here|eval good.weft --at picture.png
1|'empty' is empty|eval good.weft --at empty
1|'cloth.wv' is a weave; PATH.csv is needed here|render good.weft --path cloth.wv -o out-%d.png
1|'cloth.wv' is a weave; PATH.csv is needed here|prune good.weft --path cloth.wv -o out
1|'picture.png' is no .weft file|render picture.png -o out.png
1|'zero.png' is no .weft file|render zero.png -o out.png
1|twice as wide as high|render good.weft --environment picture.png -o out.png
1|carries no settings|render good.weft --settings picture.png -o out.png
2|not 'nan,0'|render good.weft --light nan,0 -o out.png
2|not '0x0'|render good.weft --size 0x0 -o out.png
2|one place for a number|render good.weft --path plan.csv -o out.png
1|none of|info picture.png
2|needs a file|verify
TABLE

# What may be a word is not taken for the file of that name.
mkdir virtual
expect_ok capture --rig virtual --sample "$weave" --plan plan.csv --dry-run -o named
rmdir virtual

# Outputs that cannot be.
expect_one_line 2 "'out.gif' names no kind of picture" render good.weft -o out.gif
expect_one_line 2 "'out' names no kind of picture" render good.weft -o out
expect_one_line 3 "folder 'absent'" render good.weft -o absent/out.png
for command in compress tile; do
    expect_one_line 3 "folder 'absent'" "$command" good.btf.h5 -o absent/out
done
expect_one_line 3 "folder 'absent'" photographs good -o absent/out.btf.h5
expect_one_line 3 "'good.weft' is a file" compare good.btf.h5 good.weft -o good.weft/report
expect_one_line 3 "'good.weft' is a file" capture --sample "$weave" --plan plan.csv -o good.weft
expect_one_line 3 "'good.weft' is a file" synthetic checker -o good.weft/new
for command in "register good" "photographs good"; do
    # shellcheck disable=SC2086
    expect_one_line 3 "'good.weft' is a file" $command -o out --report good.weft
    expect_no_file out
done
expect_one_line 3 "folder '/proc'" compress good.btf.h5 -o /proc/out.weft
expect_one_line 3 "folder '/proc'" compare good.btf.h5 good.weft -o /proc/report
[ -z "$(find . -name '.weft-*')" ] || fail "what was tried is left"
if [ "$(id -u)" != 0 ]; then
    mkdir locked
    chmod 555 locked
    expect_one_line 3 "folder 'locked'" compress good.btf.h5 -o locked/out.weft
    expect_one_line 3 "folder 'locked'" compare good.btf.h5 good.weft -o locked/new/report
fi
expect_one_line 1 "no file 'absent.btf.h5'" render --raw absent.btf.h5 -o out.png

# A failure is told from a measurement of errors.
expect_ok compare good.btf.h5 good.weft --size 32 --json -o report
grep -q '"event":"measurement","model":"compressed"' out.log || fail "no measurement: $(cat out.log)"
! grep '"event":"error"' out.log || fail "a measurement is called a failure"
expect_one_line 1 "'cut.weft' is cut" compare good.btf.h5 cut.weft --json -o other-report
grep -q '"event":"error","code":1,"text":".*cut.weft' out.log || fail "no failure: $(cat out.log)"
expect_no_file other-report

# Lights and meshes.
expect_one_line 2 "below the horizon" render good.weft --light 120,0 -o out.png
expect_ok render good.weft --light 90,0 --size 32x32 --samples 1 -o dark.png
expect_one_line 1 "drape, sphere, plane" render good.weft --mesh cube -o out.png
expect_no_file out.png

# A window is not opened for what is not there: no display is needed to say so.
expect_one_line 1 "no file 'absent'" play --raw absent
expect_one_line 1 "no file 'absent.weft'" play absent.weft
expect_one_line 1 "'good.weft' is a material; NAME.btf.h5 is needed here" play --raw good.weft
expect_one_line 1 "'good.weft' is a material; CLOTH.wv or CLOTH.mc is needed here" play --weave good.weft
for file in picture.png plan.csv folder zero.png knit.stitch; do
    expect_one_line 1 "'$file' is no .weft file" play "$file"
done
expect_one_line 1 "drape, sphere, plane" play good.weft --mesh cube
expect_one_line 1 "drape, sphere, plane" play good.weft --mesh folder

# What can be shown is shown, whatever it is.
for file in good.btf.h5 "$weave" good.weft; do
    rm -f shown.png
    expect_ok render "$file" --environment none --size 32x32 --samples 1 -o shown.png
    [ -s shown.png ] || fail "$file is not shown"
done
expect_ok render good.btf.h5 --environment none --size 32x32 --samples 1 -o by-place.png
expect_ok render --raw good.btf.h5 --environment none --size 32x32 --samples 1 -o by-name.png
[ "$(convert by-place.png rgb:- | cksum)" = "$(convert by-name.png rgb:- | cksum)" ] || fail "a dataset by its place is another picture"
expect_one_line 2 "of one kind" render --raw good.btf.h5 good.btf.h5 -o out.png
echo "bad_usage.sh: $passed checks"
