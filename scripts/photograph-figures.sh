#!/bin/sh
# The photographs of docs/guide/photograph-your-cloth.md, made by weft synthetic. Usage: photograph-figures.sh WEFT FOLDER
set -eu
weft=$(realpath "$1")
images=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$weft" synthetic checker --opening 40 -o taken --photographs 36 --rubbish 4 --width 1500 --truth-size 8

# strip NAME PHOTOGRAPH...: side by side, upright, as tall as each other.
strip() {
    name=$1
    shift
    for photograph in "$@"; do
        set -- "$@" "$photograph.png"
        convert "taken/$photograph" -auto-orient -resize x360 "$photograph.png"
        shift
    done
    convert "$@" -bordercolor white -border 4 +append -colors 128 "$images/$name.png"
}
strip photographs-good IMG_7132.JPG IMG_7139.JPG IMG_7160.JPG
strip photographs-left-out IMG_7137.jpg IMG_7146.JPG IMG_7164.JPG
