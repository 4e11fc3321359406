#!/bin/sh
# From photographs to pictures with every command, on a small plan. Usage: corridor.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/corridor-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

write_plan >plan.csv
expect_ok capture --rig virtual --sample "$assets/weaves/wool_gabardine.wv" --plan plan.csv --seed 3 --truth-images 1 --truth-size 4 -o session
[ "$(wc -l <session/journal.jsonl)" = 32 ] || fail "the journal does not hold 32 photographs"
expect_ok capture --rig virtual --sample "$assets/weaves/wool_gabardine.wv" --plan plan.csv --seed 3 --truth-images 1 --truth-size 4 -o session
[ "$(wc -l <session/journal.jsonl)" = 32 ] || fail "a finished session was photographed again"
expect_says "32" info session
expect_ok verify session

expect_says "^no heights: \|^nothing: " register session --size 32x32 -o cloth.btf.h5 --report registration
expect_page registration
grep -q "75" registration/index.html || fail "the report does not list the grazing view"
expect_says "32 x 32" info cloth.btf.h5
expect_ok verify cloth.btf.h5

expect_ok compress cloth.btf.h5 --lobes 2 -o cloth.weft
grep -q "does not tile" out.log && fail "whole repeats are said to have a seam: $(cat out.log)"
expect_ok verify cloth.weft
expect_ok compress cloth.btf.h5 --lobes 2 --threads 1 -o again.weft
cmp cloth.weft again.weft || fail "the number of threads changes the material"

echo "lx,ly,lz,vx,vy,vz,u,v,level" >at.csv
echo "0,0,1,0,0,1,0.25,0.75,0" >>at.csv
for model in cloth.weft cloth.btf.h5 "$assets/weaves/wool_gabardine.wv"; do
    expect_ok eval "$model" --at at.csv
    [ "$(wc -l <out.log)" = 2 ] || fail "eval $model did not print one row"
done

expect_ok render cloth.weft --raw cloth.btf.h5 --weave "$assets/weaves/wool_gabardine.wv" --mode split --environment none --samples 1 --size 300x120 -o picture.png
grep -q "^from raw: compressed [0-9.]* % .*, analytic [0-9.]* %" out.log || fail "render does not say how far the models are from the data"
expect_ok render cloth.weft --mesh sphere --samples 1 --size 64x64 -o sphere.exr
expect_ok compare cloth.btf.h5 cloth.weft --weave "$assets/weaves/wool_gabardine.wv" --size 100 -o report
expect_page report
grep -q "<img" report/index.html || fail "the comparison has no pictures"
for model in compressed analytic; do
    printed=$(sed -n "s/^$model, mean BRDF: relative RMSE \([0-9.]* %\),.*/\1/p" out.log)
    grep -q "<td>$model</td>.*<td>$printed</td>" report/index.html || fail "page and command differ on the error of $model"
done
shown=$(sed -n "s/.*compressed beside raw: PSNR \([0-9.]*\) dB.*/\1/p" out.log | awk '{ printf "%.0f dB", $1 }')
grep -q "$shown" report/index.html || fail "page and command differ on the drape: $shown"
# The table of the slices goes through eval as it is: columns 7 to 9 are the data, the next threes the models.
slices_agree() {
    expect_ok eval "$1" --at report/slices.csv
    awk -F, -v first="$2" 'NR > 1 {
        for (c = 0; c < 3; c++) {
            difference = $(first + c) - $(NF - 2 + c)
            if (difference > 1e-6 || difference < -1e-6) exit 1
        }
    } END { if (NR < 1000) exit 1 }' out.log || fail "eval $1 does not say what the slices say"
}
slices_agree cloth.btf.h5 7
slices_agree cloth.weft 10
slices_agree "$assets/weaves/wool_gabardine.wv" 13
# A weave found from 32 photographs, started off the truth, is nearer to the data and reads back.
sed 's/psi = 30/psi = 38/; s/umax = 30/umax = 24/' "$assets/weaves/wool_gabardine.wv" >start.wv
expect_says "median" fit-weave cloth.btf.h5 --weave start.wv -o fitted.wv
sed -n 's|.*percentile: \([0-9.]*\) % / .* before, \([0-9.]*\) % .*|\1 \2|p' out.log | awk '{ exit !($2 < 0.5 * $1) }' ||
    fail "the fitted weave is no better than its start"
grep -q "sample: rotated by\|sample: assumed to lie straight; " out.log || fail "fit-weave does not say how the sample lies"
grep -q "Fitted to the mean of 32 images" fitted.wv || fail "the fitted weave does not say what it was fitted to"
error_of_analytic() {
    sed -n "s/^analytic, mean BRDF: relative RMSE \([0-9.]*\) %,.*/\1/p" out.log
}
expect_says "fitted to no dataset" compare cloth.btf.h5 cloth.weft --weave start.wv --size 64 -o report
before=$(error_of_analytic)
# The comparison fits by itself, to the same weave, and says so.
expect_says "fitted to this dataset, the mean of 32 images" compare cloth.btf.h5 cloth.weft --weave start.wv --fit --size 64 -o report
# That of the whole material counts the texels beside the frame, too: the true weave has 0.87 of the error of the start.
awk "BEGIN { exit !($(error_of_analytic) < 0.9 * $before) }" || fail "the fitted weave compares no better than its start"
cmp fitted.wv report/fitted.wv || fail "compare --fit and fit-weave find different weaves"
grep -q "before the fit" report/index.html || fail "the page does not say what the fit changed"
expect_error 2 "--weave" compare cloth.btf.h5 cloth.weft --fit -o report
expect_error 1 "absent.wv" fit-weave cloth.btf.h5 --weave absent.wv -o none.wv
expect_error 1 "cloth.weft" fit-weave cloth.weft --weave start.wv -o none.wv
expect_error 2 "needs" fit-weave cloth.btf.h5 -o none.wv
expect_no_file none.wv

for command in capture register import compress bard tile fit-weave render play compare eval info verify; do
    expect_says "xample" "$command" --help
done
echo "$passed passed, 0 failed"
