#!/bin/sh
# same_numbers.sh PROGRAM COMMAND...: both print lines that end in a number. Each line must be the same but for 1e-5 in that number.
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
        if ($0 != name || !(difference <= 1e-5)) {
            print "expected " name expected ", found " $0 number
            failed = 1
        }
    }
    END {
        print NR / 2 " numbers compared"
        exit failed || NR < 2
    }'
