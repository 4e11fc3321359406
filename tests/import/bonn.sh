#!/bin/sh
# A file of Bonn from the laboratory to the picture: import, compress, render. Usage: bonn.sh WEFT PYTHON
set -eu
weft=$1
python=$2
. "$(dirname "$0")/../cli/expect.sh"
generate=$(cd "$(dirname "$0")/../data/generate" && pwd)/bonn_files.py
scratch=$(mktemp -d "$PWD/bonn-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$python" -c 'import numpy' 2>/dev/null || { echo "no numpy: skipped"; exit 77; }

"$python" "$generate" --cloth cloth.btf
expect_says "16 x 16 texels, 169 images from 13 views" import cloth.btf --heights off -o cloth.btf.h5
expect_says "texel_pitch_mm: 0.5" info cloth.btf.h5
expect_ok compress cloth.btf.h5 --hold-out off -o cloth.weft

# The red corner is at the top left, the blue one at the bottom right: of the flat material, seen from above.
# expect_colour PICTURE AT red|blue: there this channel is three times as bright as the two others.
expect_colour() {
    convert "$1" -crop "3x3+$2" +repage -scale 1x1! -format '%[fx:int(255*r)] %[fx:int(255*g)] %[fx:int(255*b)]\n' info: >colour
    read -r red green blue <colour
    case $3 in
    red) [ "$red" -gt $((3 * green)) ] && [ "$red" -gt $((3 * blue)) ] ;;
    blue) [ "$blue" -gt $((3 * green)) ] && [ "$blue" -gt $((3 * red)) ] ;;
    esac || fail "$1 is $red $green $blue at $2, not $3"
}
for source in cloth.weft cloth.btf.h5; do
    expect_ok render "$source" --repeat 1 --size 200x200 --samples 1 -o picture.png
    expect_colour picture.png 35+35 red
    expect_colour picture.png 162+162 blue
done

# Reduced, told what it holds, and refused where it does not belong.
expect_ok import cloth.btf --heights off --size 4 --pitch 3 --values reflectance_cosine -o small.btf.h5
expect_says "texel_pitch_mm: 3" info small.btf.h5
echo "1" >dirs.lp
echo "a.png 0 0 1" >>dirs.lp
expect_error 2 "--lights" import cloth.btf --lights dirs.lp -o small.btf.h5
expect_error 2 "--colours" import cloth.btf --colours xyz -o small.btf.h5
expect_error 2 "17 texels asked for" import cloth.btf --size 17 -o five.btf.h5
expect_error 1 "weft import" compress cloth.btf -o small.weft
expect_error 1 "weft import" info cloth.btf
expect_error 1 "weft import" render cloth.btf -o small.png
expect_no_file five.btf.h5
head -c 10000 cloth.btf >cut.btf
expect_error 1 "'cut.btf' ends in its channel" import cut.btf -o cut.btf.h5
expect_no_file cut.btf.h5
echo "$passed commands as expected"
