#!/bin/sh
# same_numbers.sh PROGRAM COMMAND...: both print lines that end in a number. Each line must be the same but for 1e-5 in that number.
# One line in twenty may differ by 2e-4: a fit stops where the next step promises little, and where that is at the brink, one
# instruction set takes a step more than another.
# PROGRAM runs with the baseline instruction set; an exit code of 77 (skipped) of COMMAND is passed on.
set -eu
program=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

WEFT_ISA=baseline "$program" >"$folder/expected"
"$@" >"$folder/found"
paste -d '\n' "$folder/expected" "$folder/found" | awk '
    { number = $NF; $NF = "" }
    NR % 2 { name = $0; expected = number; next }
    {
        difference = number > expected ? number - expected : expected - number
        if ($0 == name && difference <= 1e-5)
            next
        print "expected " name expected ", found " $0 number
        others++
        failed = failed || $0 != name || !(difference <= 2e-4)
    }
    END {
        print NR / 2 " numbers compared, " 0 + others " differ"
        exit failed || 20 * others > NR / 2 || NR < 2
    }'
