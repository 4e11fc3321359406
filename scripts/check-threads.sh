#!/bin/sh
# Everything that starts threads of its own, under ThreadSanitizer (the tests with the label "threads").
set -eu
cd "$(dirname "$0")/.."

cmake --preset tsan -Wno-dev --log-level=WARNING
cmake --build --preset tsan --target threads_tests
# ThreadSanitizer does not see the barriers of libgomp and takes what its threads share for races: no team has more than one, but
# where a test asks for more and has none of its regions.
export OMP_NUM_THREADS=1
export TSAN_OPTIONS="suppressions=$PWD/tests/sanitizers/tsan.supp:halt_on_error=1"
ctest --preset tsan
