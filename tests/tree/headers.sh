#!/bin/sh
# Each public header compiles by itself, as C17 and as C++17, with each compiler that is there.
# Usage: headers.sh INCLUDE
set -eu
passed=0
for compiler in "gcc -x c -std=c17" "g++ -x c++ -std=c++17" "clang -x c -std=c17" "clang++ -x c++ -std=c++17"; do
    command -v "${compiler%% *}" >/dev/null || continue
    for header in "$1"/weft/*.h; do
        # shellcheck disable=SC2086
        echo "#include <weft/$(basename "$header")>" | $compiler -Wall -Wextra -pedantic -Werror -I "$1" -fsyntax-only - || {
            echo "$header does not compile by itself: $compiler"
            exit 1
        }
        passed=$((passed + 1))
    done
done
[ "$passed" -ge 24 ] || { echo "only $passed compilations"; exit 1; }
echo "$passed passed, 0 failed"
