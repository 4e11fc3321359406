# Helpers of the whole-command tests. Source it; needs $weft and a scratch folder as working directory.

passed=0

fail() {
    echo "FAILED: $*" >&2
    exit 1
}

# expect_ok COMMAND...: exit code 0.
expect_ok() {
    "$weft" "$@" >out.log 2>err.log || fail "weft $* exited with $?: $(cat err.log)"
    passed=$((passed + 1))
}

# expect_error CODE WORD COMMAND...: this exit code, and a line of weft's on stderr that names WORD.
expect_error() {
    code=$1
    word=$2
    shift 2
    status=0
    "$weft" "$@" >out.log 2>err.log || status=$?
    [ "$status" = "$code" ] || fail "weft $* exited with $status, not $code: $(cat err.log)"
    grep "^weft " err.log | grep -qF -- "$word" || fail "weft $* does not name '$word': $(cat err.log)"
    passed=$((passed + 1))
}

# expect_says WORD COMMAND...: exit code 0 and WORD in the output.
expect_says() {
    word=$1
    shift
    expect_ok "$@"
    grep -q -- "$word" out.log err.log || fail "weft $* does not say '$word': $(cat out.log err.log)"
}

expect_no_file() {
    [ ! -e "$1" ] || fail "'$1' was left behind"
    for leftover in $(ls -A "$(dirname "$1")" | grep "^\.$(basename "${1%%.*}")" || true); do
        fail "half-written '$leftover' was left behind"
    done
}

# expect_page FOLDER: a report whose charts have the colours of the page, light or dark, and whose relative errors are percent.
expect_page() {
    [ -s "$1/index.html" ] || fail "there is no page in $1"
    sed '1,/<\/style>/d; /^<script>/,$d' "$1/index.html" >page.body
    ! grep -oE "(fill|stroke|color|background)[=:]['\"]?(#|rgb|white|black).*" page.body || fail "a chart in $1 has a colour of its own"
    ! grep -oE '<svg.*' page.body | grep -v '^<svg class="plot' || fail "a chart in $1 has a style of its own"
    ! grep -oE 'relative RMSE -?[0-9.]+([^0-9. ]| [^%]).*' page.body || fail "an error in $1 is no percentage"
}

write_plan() {
    echo "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg"
    for view in 0,0 30,90 45,240 75,105; do
        for light in 0,0 30,60 30,180 45,300 60,0 60,120 60,240 75,30; do
            echo "$light,$view"
        done
    done
}

# The dataset knit.btf.h5 of 8 x 8 texels, 7 views and 7 lights; needs $assets.
simulate_knit() {
    awk 'BEGIN {
        print "theta_deg,phi_deg"
        print "0,0"
        for (i = 0; i < 6; i++)
            print 40 "," 60 * i + 7
    }' >directions.csv
    expect_ok simulate "$assets/stitches/plain_knit.stitch" -o knit.btf.h5 --plane top --heights off --size 8x8 --noise 10 --bounces 0 \
        --resolution 20 --directions directions.csv
}
