#!/bin/sh
# Every fault of `make mutants` finds its place, and no second one that it could be taken for; the test that it names exists.
# Usage: check-faults.sh
# docs/guide/mutants.md says what a fault looks like.
set -eu
cd "$(dirname "$0")/.."
cmake --preset release -Wno-dev --log-level=WARNING >/dev/null
names=$(scripts/test_targets.py build/release | sed 's/ .*//')
lost=0

# field NAME PATCH: the rest of the line "NAME: ..." above the difference.
field() {
    sed -n "/^--- /q; s/^$1: *//p" "$2"
}

# Says which of a fault's changes fit in several places of their file: the line numbers of the patch age.
find_twins() {
    awk '
        function count_places(   file, line, i, k, places) {
            file = name
            count = 0
            while ((getline line <file) > 0) text[++count] = line
            close(file)
            for (i = 1; i + wanted - 1 <= count; i++) {
                for (k = 1; k <= wanted && text[i + k - 1] == old[k]; k++) ;
                places += k > wanted
            }
            if (wanted > 0 && places > 1) print FILENAME ": a change fits in " places " places of " file
            wanted = 0
        }
        /^--- a\// { count_places(); name = substr($0, 7); inside = 0; next }
        /^\+\+\+ / { next }
        /^@@/ { count_places(); inside = 1; next }
        inside && /^[- ]/ { old[++wanted] = substr($0, 2) }
        END { count_places() }' "$1"
}

for fault in tests/mutants/*/*.patch; do
    # As mutants.sh puts it in: patch takes a change without a line after it for one at the end of its file.
    patch -p1 -F0 -s -r - --dry-run <"$fault" >/dev/null 2>&1 || { echo "$fault: does not apply" >&2; lost=1; }
    twins=$(find_twins "$fault")
    [ -z "$twins" ] || { echo "$twins" >&2; lost=1; }
    caught_by=$(field 'Caught by' "$fault")
    printf '%s\n' "$names" | grep -qx "$caught_by" || { echo "$fault: there is no test '$caught_by'" >&2; lost=1; }
done
exit $lost
