#!/bin/sh
# Formatting, static analysis, and every test under AddressSanitizer and UndefinedBehaviorSanitizer.
set -eu
cd "$(dirname "$0")/.."

sources=$(git ls-files '*.c' '*.h' '*.cpp')
# shellcheck disable=SC2086
clang-format --dry-run --Werror $sources

cmake --preset asan-ubsan -Wno-dev --log-level=WARNING
cmake --build --preset asan-ubsan
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS=suppressions=$PWD/tests/support/lsan.supp
ctest --preset asan-ubsan

# shellcheck disable=SC2046
clang-tidy --quiet --extra-arg=-Wno-ignored-optimization-argument -p build/asan-ubsan $(git ls-files '*.c' ':!tests' ':!bench')
