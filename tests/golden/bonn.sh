#!/bin/sh
# What weft import makes of the files of Bonn in good/bonn is what their generator put into them; those in bad/bonn get
# the message that they always got, and leave nothing. Usage: bonn.sh WEFT GOLDEN
set -eu
weft=$1
golden=$2
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../cli/expect.sh"
scratch=$(mktemp -d "$PWD/bonn-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
cp "$here"/good/bonn/* "$here"/bad/bonn/* .

# The provenance names the program.
for file in "$here"/good/bonn/*.btf; do
    name=$(basename "$file" .btf)
    expect_ok import "$name.btf" --heights off -o out.btf.h5
    "$golden" print out.btf.h5 | grep -v '^provenance: ' >found
    values=$name.values
    [ -e "$values" ] || values=pictures.values
    "$golden" compare "$values" found || fail "$name.btf does not hold what $values says"
    rm out.btf.h5 found
done

for file in "$here"/bad/bonn/*.btf; do
    name=$(basename "$file" .btf)
    status=0
    { echo "\$ weft import -q $name.btf -o out.btf.h5"; "$weft" import -q "$name.btf" -o out.btf.h5 2>&1 || status=$?; echo "exit code $status"; } >said
    cmp "$name.message" said || fail "$name.btf: $(cat said)"
    expect_no_file out.btf.h5
done
rm -f said out.log err.log
[ "$(ls -A | wc -l)" -eq "$(ls "$here"/good/bonn "$here"/bad/bonn | grep -c '\.')" ] || fail "something was left: $(ls -A)"
echo "$passed commands as expected"
