#!/bin/sh
# `weft play` in a real window on a virtual display: every drag and key must change the picture.
# Usage: test_play.sh WEFT TEST_RENDER WEAVES
set -eu

weft=$1 make=$2 weaves=$3
. "$(dirname "$0")/window.sh"
need xvfb-run xdotool cmp

if [ "${4-}" != inside ]; then
    rm -rf play && "$make" test_render play
    "$weft" play --help | grep -q '^Example: weft play' || { "$weft" play --help; exit 1; }
    # No window can be opened twice by accident: the counted run ends by itself.
    xvfb-run -a -s "-screen 0 800x600x24" "$weft" play play/cloth.weft --environment none --size 160x120 --frames 5 | grep "5 frames"
    exec timeout 300 xvfb-run -a -s "-screen 0 800x600x24" "$0" "$weft" "$make" "$weaves" inside
fi

cd play
open_window cloth.weft --environment none --raw cloth.btf.h5 --weave "$weaves/cotton_twill.wv" --size 160x120 --samples 1

next=none
shoot() { # WHAT: takes a screenshot that must differ from the one before, within ten seconds
    last=$next
    for _ in $(seq 20); do
        sleep 0.4
        save_picture || { echo "no screenshot after: $1"; exit 1; }
        cmp -s "$last" "$next" || return 0
    done
    echo "nothing changed: $1"
    exit 1
}

drag() { # BUTTON DX DY
    xdotool mousemove --window "$window" 80 60
    sleep 0.1
    xdotool mousedown "$1"
    sleep 0.1
    xdotool mousemove_relative -- "$2" "$3"
    sleep 0.1
    xdotool mouseup "$1"
}

shoot "start"
drag 1 40 10
shoot "left drag"
drag 3 60 20
shoot "right drag"
xdotool click 4
shoot "wheel"
for key in 1 3 s w x 2 m n bracketright c o; do
    xdotool key $key
    shoot "key $key"
done
"$weft" render --settings "$next" -o again.png --quiet
cmp "$next" again.png || { echo "the last screenshot cannot be drawn again"; exit 1; }
"$weft" compress cloth.btf.h5 -o other.weft --lobes 1 --quiet
mv other.weft cloth.weft
sleep 2
shoot "the material was written again"
head -c 100 cloth.weft >cut.weft && mv cut.weft cloth.weft
sleep 2
kill -0 $player || { echo "a material that was cut while it was shown ended the player"; exit 1; }
xdotool windowsize "$window" 200 150
shoot "resize"
xdotool key q
for _ in $(seq 300); do
    kill -0 $player 2>/dev/null || break
    sleep 0.1
done
trap - EXIT
wait $player
"$weft" play --settings "$next" --frames 3 | grep -q "3 frames" || { echo "no window from a screenshot"; exit 1; }
echo "$shots screenshots, all different from the one before"
