#!/bin/sh
# Everything that starts threads of its own, under ThreadSanitizer (the tests with the label "threads").
set -eu
cd "$(dirname "$0")/.."

cmake --preset tsan -Wno-dev --log-level=WARNING
cmake --build --preset tsan --target threads_tests
export TSAN_OPTIONS="suppressions=$PWD/tests/support/tsan.supp:halt_on_error=1"
ctest --preset tsan
