#!/bin/sh
# Puts one fault after another into a copy of the tree and expects the test that the fault names to fail. The checkout is only read.
# Usage: mutants.sh [ROOM|PATCH...]    all faults of tests/mutants, those of some of its folders, or some of its files
# Exit code 1 where a fault survives, no longer applies, does not build, or names a test that does not pass without it.
# docs/guide/mutants.md says what a fault looks like.
set -eu
cd "$(dirname "$0")/.."
work=$PWD/build/mutants
tree=$work/tree
build=$work/build
least_limit_s=60
jobs=$(nproc)
began=$(date +%s)

# The faults that the arguments name, one a line.
list_faults() {
    [ $# -gt 0 ] || set -- tests/mutants
    for name in "$@"; do
        [ ! -e "tests/mutants/$name" ] || name=tests/mutants/$name # rooms are folders of the checkout, too
        [ -n "$(find "$name" -name '*.patch' 2>/dev/null)" ] || { echo "there is neither a fault nor a room '$name'" >&2; return 2; }
        find "$name" -name '*.patch' | sort
    done
}

# field NAME PATCH: the rest of the line "NAME: ..." above the difference.
field() {
    sed -n "/^--- /q; s/^$1: *//p" "$2"
}

# The copy gets what differs, so that later runs build little. Times are not copied: a fault that an interrupted run has left
# behind is then older than what undoes it.
copy_tree() {
    mkdir -p "$tree"
    git ls-files -co --exclude-standard | sort >"$work/files"
    while read -r file; do
        if [ -f "$file" ] && ! cmp -s "$file" "$tree/$file"; then
            mkdir -p "$(dirname "$tree/$file")"
            cp "$file" "$tree/$file"
        fi
    done <"$work/files"
    (cd "$tree" && find . -type f | sed 's|^\./||' | sort) | comm -13 "$work/files" - | while read -r file; do rm "$tree/$file"; done
}

# The targets of the tests that the faults name.
targets_of() {
    for fault in "$@"; do
        sed -n "s/^$(field 'Caught by' "$fault") //p" "$work/targets"
    done | tr ' ' '\n' | sort -u
}

build() {
    cmake --build "$build" --target "$@" >"$work/log" 2>&1
}

# run_tests REGEX LIMIT_S: runs the tests and leaves what became of them in the log.
run_tests() {
    ctest --test-dir "$build" -j "$jobs" -R "$1" --timeout "$2" >"$work/log" 2>&1 || true
}

# limit_s TEST: four times what it took without a fault. A busy machine must not look like a fault that is caught.
limit_s() {
    awk -v test="$1" -v least="$least_limit_s" '$1 == test { limit = 4 * $2 } END { print int(limit > least ? limit : least) }' "$work/seconds"
}

# Says how a test ended: passed, failed, or missing where it was skipped or does not exist.
outcome_of() {
    run_tests "^$1\$" "$(limit_s "$1")"
    if grep -qE '\*\*\*(Failed|Timeout|Exception)' "$work/log"; then
        echo failed
    elif grep -q ' Passed ' "$work/log"; then
        echo passed
    else
        echo missing
    fi
}

# Builds and runs all named tests without any fault: only then does a failure tell something. Keeps the seconds of each.
expect_health() {
    cmake -S "$tree" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -Wno-dev --log-level=WARNING >/dev/null
    scripts/test_targets.py "$build" >"$work/targets"
    # shellcheck disable=SC2046
    if ! build $(targets_of "$@"); then
        grep -E 'error|ninja:' "$work/log" >&2
        echo "the tree does not build without a fault" >&2
        return 1
    fi
    printf 'built after %d s\n' $(($(date +%s) - began))
    tests=$(for fault in "$@"; do field 'Caught by' "$fault"; done | sort -u)
    run_tests "^($(echo "$tests" | paste -sd '|'))\$" 1000
    sed -n 's/^ *[0-9]*\/[0-9]* Test *#[0-9]*: \([^ ]*\) .* Passed *\([0-9.]*\) sec.*/\1 \2/p' "$work/log" | sort >"$work/seconds"
    ill=$(echo "$tests" | while read -r test; do grep -q "^$test " "$work/seconds" || echo "$test"; done)
    [ -z "$ill" ] || { echo "without a fault these tests do not pass, or there are none: $ill" >&2; return 1; }
}

change() {
    patch -d "$tree" -p1 -F0 -s -r - --no-backup-if-mismatch "$@" >/dev/null 2>&1
}

# Takes a fault out again by the files of the checkout: a difference without context may find another place on its way back.
undo() {
    sed -n 's|^+++ b/||p' "$1" | while read -r file; do cp "$file" "$tree/$file"; done
}

# Says what became of a fault.
try() {
    change --dry-run <"$1" || { echo "does not apply"; return; }
    change <"$1"
    # shellcheck disable=SC2046
    if ! build $(targets_of "$1"); then
        verdict="does not build"
    else
        case $(outcome_of "$(field 'Caught by' "$1")") in
        failed) verdict=caught ;;
        passed) verdict=SURVIVED ;;
        *) verdict="names no test" ;;
        esac
    fi
    undo "$1"
    echo "$verdict"
}

# What a reader needs to know of a fault that was not caught.
explain() {
    printf '               %s\n' "$(field Fault "$1")"
    [ "$2" != 'does not build' ] || grep -m 1 -E 'error:' "$work/log" | cut -c1-160
}

faults=$(list_faults "$@")
for fault in $faults; do
    if [ -z "$(field Fault "$fault")" ] || [ -z "$(field 'Caught by' "$fault")" ]; then
        echo "$fault: needs a line 'Fault: ...' and a line 'Caught by: TEST'" >&2
        exit 1
    fi
done
copy_tree
# shellcheck disable=SC2086
expect_health $faults
printf 'ready after %d s\n' $(($(date +%s) - began))

: >"$work/verdicts"
for fault in $faults; do
    start=$(date +%s)
    verdict=$(try "$fault")
    echo "$verdict" >>"$work/verdicts"
    printf '%-14s %4d s  %-52s %s\n' "$verdict" $(($(date +%s) - start)) "${fault#tests/mutants/}" "$(field 'Caught by' "$fault")"
    [ "$verdict" = caught ] || explain "$fault" "$verdict"
done
all=$(grep -c . "$work/verdicts" || true)
caught=$(grep -cx caught "$work/verdicts" || true)
survived=$(grep -cx SURVIVED "$work/verdicts" || true)
printf '%d faults: %d caught, %d survived, %d do not apply, build or name a test; %d s\n' "$all" "$caught" "$survived" \
    $((all - caught - survived)) $(($(date +%s) - began))
[ "$caught" = "$all" ]
