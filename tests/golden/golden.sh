#!/bin/sh
# The good files of a kind hold what they always held, the bad ones get the message that they always got.
# Usage: golden.sh WEFT GOLDEN KIND
set -eu
weft=$1
golden=$2
kind=$3
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../cli/expect.sh"
scratch=$(mktemp -d "$PWD/golden-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
mkdir good bad
cp -R "$here/good/$kind/." good
cp -R "$here/bad/$kind/." bad

"$golden" good good || fail "a good file is not what it was"
"$golden" bad bad || fail "a bad file does not get the message that it got"

# The first line of a transcript, without "$ weft".
command_of() {
    sed -n '1s/^\$ weft //p' "$1"
}

cd good
for transcript in *.said; do
    [ -e "$transcript" ] || continue
    set -- $(command_of "$transcript")
    expect_ok "$@"
    rm err.log
    { sed -n 1p "$transcript"; cat out.log; } >../said
    rm out.log
    "$golden" compare "$transcript" ../said || fail "$transcript is not what it was"
done
for file in *.weft *.h5 *.wv *.stitch *.mc */; do
    file=${file%/}
    [ ! -e "$file" ] || [ -e "$file.values" ] || cat ./*.said | grep -q "^\$ weft .* $file " || fail "nothing is known of $file"
done
diff -r "$here/good/$kind" . || fail "a file was changed by reading it"

# What the program says of bad files is what the library says; once for each kind.
cd ../bad
for file in *; do
    [ "${file%.message}" != "$file" ] || [ -e "$file.message" ] || fail "nothing is known of $file"
done
transcript=$(ls -- *_unknown*.message newer_version*.message | tail -n 1)
set -- $(command_of "$transcript")
status=0
{ sed -n 1p "$transcript"; "$weft" "$@" 2>&1 || status=$?; echo "exit code $status"; } >../said
cmp "$transcript" ../said || fail "weft $* says $(cat ../said)"
echo "$passed commands as expected"
