#!/bin/sh
# Every symbol that the library of a room defines for others begins with weft_, so that it meets no name of another library.
# What the compiler names itself is let through: C++, references to its type information, locks of OpenMP, marks of
# AddressSanitizer.
# Usage: symbols.sh NM LIBRARY...
set -eu

nm=$1
shift
[ $# -gt 0 ] || {
    echo "no library was named, so this test would pass in any case"
    exit 1
}
found=$("$nm" --extern-only --defined-only --print-file-name "$@" | awk '
    $NF !~ /^(weft_|_Z|DW\.ref\.|\.gomp_critical_user_weft_|__odr_asan\.weft_)/ && NF > 2 { print $1, $NF }')
[ -z "$found" ] || {
    echo "$found"
    echo "these names do not begin with weft_"
    exit 1
}
