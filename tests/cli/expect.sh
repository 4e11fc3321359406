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

write_plan() {
    echo "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg"
    for view in 0,0 30,90 45,240 75,105; do
        for light in 0,0 30,60 30,180 45,300 60,0 60,120 60,240 75,30; do
            echo "$light,$view"
        done
    done
}
