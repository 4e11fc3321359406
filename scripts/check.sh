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

# Sources that changed in the last day of work, and those that include a header that did.
tidy_changed() {
    last=$(git log -1 --format=%ct)
    base=$(git rev-list -1 --before="$((last - 86400))" HEAD)
    changed=$(git diff --name-only --diff-filter=d "${base:-$(git rev-list --max-parents=0 HEAD | tail -n 1)}" -- '*.c' '*.h' ':!tests' ':!bench')
    {
        printf '%s\n' "$changed" | grep '\.c$'
        printf '%s\n' "$changed" | sed -n 's/\(.*\)\.h$/\1.c/p' | while read -r source; do [ ! -e "$source" ] || echo "$source"; done
    } | sort -u | analyse
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
