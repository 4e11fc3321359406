#!/bin/sh
# A session with `weft play` in a real window on a virtual display, with the panel: orbit, drag the light, flip, wipe, edit a weave,
# resize, drop a broken file and a good one, close. Pictures are held against what must be in them; the player ends with an error where
# OpenGL has one.
# Usage: test_session.sh WEFT TEST_RENDER DROP_FILE WEAVES
set -eu

weft=$1 make=$2 drop=$3 weaves=$4
. "$(dirname "$0")/window.sh"
need xvfb-run xdotool cmp convert import

if [ "${5-}" != inside ]; then
    rm -rf session && "$make" --make session
    exec timeout 500 xvfb-run -a -s "-screen 0 1000x800x24" "$0" "$weft" "$make" "$drop" "$weaves" inside
fi

cd session
panel=330
table=160x40+145+200 # of a picture of 450 x 720: the top of the drape
"$weft" compress cloth.btf.h5 -o other.weft --lobes 1 --table off --quiet
head -c 100 cloth.weft >broken.weft
open_window cloth.weft --environment none --raw cloth.btf.h5 --weave "$weaves/cotton_twill.wv" --size 780x720 --no-labels

fail() {
    import -window root failed.png
    echo "$*; the screen is in session/failed.png"
    exit 1
}

shoot() { # draws what the window shows into $next
    sleep 0.5
    save_picture || fail "no picture $next"
}

mean() { # PICTURE WIDTHxHEIGHT+X+Y: of the grey values, in thousandths
    convert "$1" -crop "$2" +repage -colorspace gray -format '%[fx:round(1000*mean)]' info:
}

drag() { # BUTTON X Y DX DY: from a point of the window
    xdotool mousemove --window "$window" "$2" "$3" sleep 0.3 mousedown "$1" sleep 0.3
    xdotool mousemove_relative -- "$4" "$5" sleep 0.3 mouseup "$1" sleep 0.3
}

click() { # X Y: of the window
    xdotool mousemove --window "$window" "$1" "$2" sleep 0.3 mousedown 1 sleep 0.2 mouseup 1 sleep 0.3
}

expect() { # WHAT, then an arithmetic condition
    [ $(($2)) -ne 0 ] || fail "$1: not $2"
}

same() { cmp -s "$1" "$2" || fail "$3: $1 and $2 differ"; }
differ() { ! cmp -s "$1" "$2" || fail "$3: $1 and $2 are equal"; }

shoot && start=$next
[ "$(identify -format '%wx%h' "$start")" = 450x720 ] || fail "the panel takes another width than $panel"

drag 1 555 360 60 20
shoot && differ "$start" "$next" "orbit"

# The map of directions: light from straight above, then along the table.
drag 1 72 236 0 -30
shoot && before=$next
drag 1 72 206 0 57
shoot
expect "light along the table" "2 * $(mean "$next" $table) < $(mean "$before" $table)"
drag 1 72 263 0 -57
shoot && same "$before" "$next" "light moved there and back"

compressed=$next
xdotool key 1
shoot && raw=$next && differ "$compressed" "$raw" "raw"
xdotool key space
shoot && same "$compressed" "$next" "flipped back"

xdotool keydown b
shoot && same "$raw" "$next" "raw while its key is held"
xdotool keyup b
shoot && same "$compressed" "$next" "compressed again when it is released"

xdotool key w
shoot
expect "line of the wipe in the middle" "$(mean "$next" 2x600+224+60) > 900"
convert "$next" -crop 200x720+0+0 +repage left.png
convert "$raw" -crop 200x720+0+0 +repage alone.png
[ "$(compare -metric AE -fuzz 1% left.png alone.png null: 2>&1)" = 0 ] || fail "left of the line is not raw alone"
drag 1 $((panel + 225)) 600 100 0
shoot
expect "line where it was dragged" "$(mean "$next" 2x600+324+60) > 900"
expect "no line where it was" "$(mean "$next" 2x600+224+60) < 900"

# Folded sections make room: light, pointer, material; then the weave opens.
xdotool key 3
shoot && analytic=$next
click 50 131
click 50 164
click 50 197
click 50 230
drag 1 200 340 60 0
shoot && differ "$analytic" "$next" "a slider of the weave"
import -window root edited.png
sleep 1 # the exact scale follows
shoot && edited=$next
click 25 650
shoot && differ "$edited" "$next" "noise"
click 25 650
shoot && same "$edited" "$next" "without noise again"
click 60 678
for _ in $(seq 100); do
    [ -s weft-001.wv ] && break
    sleep 0.1
done
"$weft" info weft-001.wv | grep -q "^kind: weave" || fail "the weave was not saved"
sleep 2

xdotool windowsize "$window" 900 600
shoot && last=$next
[ "$(identify -format '%wx%h' "$last")" = 570x600 ] || fail "the picture did not follow the window"

"$drop" "$window" broken.weft
sleep 2
import -window root told.png
expect "a broken file is told in the window" "$(convert told.png -crop 570x80+$panel+520 +repage -fuzz 8% -fill black \
    +opaque '#db784d' -fill white -opaque '#db784d' -format '%[fx:round(100000*mean)]' info:) > 50"
shoot && same "$last" "$next" "a broken file changes nothing"
"$drop" "$window" other.weft
sleep 2
xdotool key 2
shoot && differ "$last" "$next" "another material"

xdotool key q
for _ in $(seq 300); do
    kill -0 $player 2>/dev/null || break
    sleep 0.1
done
trap - EXIT
wait $player
echo "$shots pictures as expected"
