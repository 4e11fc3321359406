#!/bin/sh
# Checks what a reviewer would check. Every part runs, whatever the others found; the last lines say which failed.
# Usage: check.sh [PART...]    all parts, or some of: format includes docs faults benches sanitizers threads tidy tidy-changed
set -u
cd "$(dirname "$0")/.."
jobs=$(nproc)

format() {
    git ls-files -z '*.c' '*.h' '*.cpp' | xargs -0 clang-format --dry-run --Werror
}

includes() {
    scripts/check_includes.py
}

docs() {
    scripts/check-docs.sh
}

faults() {
    scripts/check-faults.sh
}

# The benches, which no test builds.
benches() {
    cmake --preset release -Wno-dev --log-level=WARNING >/dev/null && cmake --build --preset release --target benches
}

# Every test under AddressSanitizer and UndefinedBehaviorSanitizer.
sanitizers() {
    cmake --preset asan-ubsan -Wno-dev --log-level=WARNING >/dev/null && cmake --build --preset asan-ubsan &&
        UBSAN_OPTIONS=print_stacktrace=1 LSAN_OPTIONS=suppressions=$PWD/tests/sanitizers/lsan.supp:print_suppressions=0 ctest --preset asan-ubsan -j "$jobs"
}

# What has threads of its own, under ThreadSanitizer.
threads() {
    scripts/check-threads.sh
}

# Static analysis of the sources named on standard input.
analyse() {
    cmake --preset release -Wno-dev --log-level=WARNING >/dev/null &&
        xargs -r -n 4 -P "$jobs" clang-tidy --quiet --extra-arg=-Wno-ignored-optimization-argument -p build/release
}

tidy() {
    git ls-files '*.c' ':!tests' ':!bench' | analyse
}

# As many as two minutes allow, or WEFT_TIDY_MINUTES, of the sources that changed in the last day of work, and of those that include a header that did: those that
# changed last come first.
tidy_changed() {
    minutes=${WEFT_TIDY_MINUTES:-2}
    last=$(git log -1 --format=%ct)
    base=$(git rev-list -1 --before="$((last - 86400))" HEAD)
    : "${base:=$(git rev-list --max-parents=0 HEAD | tail -n 1)}"
    sources=$(git log --format= --name-only "$base..HEAD" -- '*.c' '*.h' ':!tests' ':!bench' | sed 's/\.h$/.c/' | awk '!seen[$0]++' |
        while read -r source; do [ ! -e "$source" ] || echo "$source"; done)
    # Files are made while building that some include.
    cmake --preset release -Wno-dev --log-level=WARNING >/dev/null || return 1
    end=$(($(date +%s) + 60 * minutes))
    printf '%s\n' "$sources" | xargs -r -n 4 -P "$jobs" sh -c '
        end=$1
        shift
        [ "$(date +%s)" -lt "$end" ] || exit 0
        clang-tidy --quiet --extra-arg=-Wno-ignored-optimization-argument -p build/release "$@" && echo "$# analysed"' sh "$end" >build/tidy.log 2>&1
    status=$?
    grep -vE '^[0-9]+ (analysed|warnings)|^Suppressed|^Use -header-filter' build/tidy.log || true
    echo "$(awk '/ analysed$/ { sum += $1 } END { print sum + 0 }' build/tidy.log) of $(printf '%s\n' "$sources" | wc -l) changed sources analysed"
    return $status
}

failed=""
for part in "${@:-format includes docs faults benches sanitizers threads tidy}"; do
    for name in $part; do
        printf '\n== %s\n' "$name"
        $(printf %s "$name" | tr - _) || failed="$failed $name"
    done
done
if [ -n "$failed" ]; then
    printf '\nFailed:%s\n' "$failed"
    exit 1
fi
printf '\nAll is well.\n'
