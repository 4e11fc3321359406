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
    rm -rf session && "$make" test_render session
    exec timeout 500 xvfb-run -a -s "-screen 0 1000x800x24" "$0" "$weft" "$make" "$drop" "$weaves" inside
fi

cd session
panel=330
table=160x40+145+200 # of a picture of 450 x 720: the top of the drape
"$weft" compress cloth.btf.h5 -o other.weft --lobes 1 --quiet
head -c 100 cloth.weft >broken.weft
open_window cloth.weft --environment none --raw cloth.btf.h5 --weave "$weaves/cotton_twill.wv" --size 780x720 --samples 1 --no-labels

fail() {
    import -window root failed.png
    echo "$*; the screen is in session/failed.png"
    exit 1
}

# The picture that the window shows, $next, once it is as it is expected to be: how soon depends on what runs beside.
shoot_when() { # CONDITION...
    for _ in $(seq 30); do
        sleep 0.2
        save_picture || fail "no picture $next"
        ! "$@" || return 0
    done
    fail "not so: $*"
}

mean() { # PICTURE WIDTHxHEIGHT+X+Y: of the grey values, in thousandths
    convert "$1" -crop "$2" +repage -colorspace gray -format '%[fx:round(1000*mean)]' info:
}

# Conditions.
seen_before=none
is_as_before() {
    last_seen=$seen_before
    seen_before=$next
    cmp -s "$last_seen" "$next"
}
is() { cmp -s "$1" "$next"; }
is_not() { ! cmp -s "$1" "$next"; }
is_of_size() { [ "$(identify -format '%wx%h' "$next")" = "$1" ]; }
is_twice_as_dark_at() { [ $((2 * $(mean "$next" "$1"))) -lt "$(mean "$2" "$1")" ]; }
has_line_at() { [ "$(mean "$next" "2x600+$(($1 - 1))+60")" -gt 900 ]; }
tells_an_error() {
    import -window root told.png
    [ "$(convert told.png -crop 570x80+$panel+520 +repage -fuzz 8% -fill black +opaque '#db784d' -fill white \
        -opaque '#db784d' -format '%[fx:round(100000*mean)]' info:)" -gt 50 ]
}

# As fast as no hand is: nothing of it may be lost.
drag() { # BUTTON X Y DX DY: from a point of the window
    xdotool mousemove --window "$window" "$2" "$3" mousedown "$1"
    xdotool mousemove_relative -- "$4" "$5" mouseup "$1"
}

click() { # X Y: of the window
    xdotool mousemove --window "$window" "$1" "$2" click 1
}

shoot_when is_of_size 450x720
start=$next

# Where the pointer rests on a widget, a hint lies over the picture beside it: letters on a dark ground.
has_hint() {
    import -window root hint.png
    [ "$(mean hint.png 200x16+350+113)" -lt 300 ] && [ "$(convert hint.png -crop 200x16+350+113 +repage -colorspace gray \
        -format '%[fx:round(1000*maxima)]' info:)" -gt 700 ]
}
! has_hint || fail "a hint where the pointer is not"
xdotool mousemove --window "$window" 262 99
for _ in $(seq 30); do
    ! has_hint || break
    sleep 0.2
done
has_hint || fail "no hint over 'Difference'"
xdotool mousemove --window "$window" 555 360
drag 1 $((panel + 225)) 360 60 20
shoot_when is_not "$start"

# The map of directions: light from straight above, then along the table.
moved=$next
drag 1 72 236 0 -30
shoot_when is_not "$moved"
before=$next
drag 1 72 206 0 57
shoot_when is_twice_as_dark_at $table "$before"
drag 1 72 263 0 -57
shoot_when is "$before"

compressed=$next
xdotool key 1
shoot_when is_not "$compressed"
raw=$next
xdotool key space
shoot_when is "$compressed"
xdotool keydown b
shoot_when is "$raw"
xdotool keyup b
shoot_when is "$compressed"

xdotool key w
shoot_when has_line_at 225
convert "$next" -crop 200x720+0+0 +repage left.png
convert "$raw" -crop 200x720+0+0 +repage alone.png
[ "$(compare -metric AE -fuzz 1% left.png alone.png null: 2>&1)" = 0 ] || fail "left of the line is not raw alone"
drag 1 $((panel + 225)) 600 100 0
shoot_when has_line_at 325
! has_line_at 225 || fail "the line is where it was, too"

# Folded sections make room: light, pointer, material; then the weave opens.
xdotool key 3
shoot_when is_not "$next"
analytic=$next
click 50 131
click 50 164
click 50 197
click 50 230
drag 1 200 340 60 0
shoot_when is_not "$analytic"
import -window root edited.png
sleep 1 # the exact scale follows
shoot_when is_as_before
edited=$next
click 25 650
shoot_when is_not "$edited" # the noise is on
click 25 650
shoot_when is "$edited"
xdotool key ctrl+z # the noise goes on again
shoot_when is_not "$edited"
xdotool key ctrl+y
shoot_when is "$edited"
xdotool key q
shoot_when is "$edited"
kill -0 $player || fail "an edited weave is lost by one key"
click 60 678
for _ in $(seq 100); do
    [ -s weft-001.wv ] && break
    sleep 0.1
done
"$weft" info weft-001.wv | grep -q "^kind: weave" || fail "the weave was not saved"

# At rest the window is not drawn: it wakes ten times a second to look at its files, and a frame wakes every thread that draws.
wakes() { cat /proc/$player/task/*/status | awk '/^voluntary/ { sum += $2 } END { print sum }'; }
wakes_for_files() {
    before=$(wakes)
    sleep 2
    woken=$(($(wakes) - before))
    [ "$woken" -lt 60 ]
}
for _ in $(seq 30); do
    ! wakes_for_files || break
done
[ "$woken" -lt 60 ] || fail "a window at rest wakes $woken times in two seconds"

xdotool windowsize "$window" 900 600
shoot_when is_of_size 570x600
last=$next

"$drop" "$window" broken.weft
for _ in $(seq 50); do
    ! tells_an_error || break
    sleep 0.1
done
tells_an_error || fail "a broken file is not told in the window"
shoot_when is "$last"
"$drop" "$window" other.weft
xdotool key 2
shoot_when is_not "$last"

# It was measured when it was made, and says so over the picture where that is wide enough.
tells_its_error() {
    import -window root told.png
    [ "$(mean told.png 200x20+770+560)" -lt 300 ] && [ "$(convert told.png -crop 200x20+770+560 +repage -colorspace gray \
        -format '%[fx:round(1000*maxima)]' info:)" -gt 700 ]
}
! tells_its_error || fail "a note where there is no room for it"
xdotool windowsize "$window" 1000 600
for _ in $(seq 50); do
    ! tells_its_error || break
    sleep 0.2
done
tells_its_error || fail "the material does not say its error"

xdotool key q
for _ in $(seq 300); do
    kill -0 $player 2>/dev/null || break
    sleep 0.1
done
trap - EXIT
wait $player
echo "$shots pictures as expected"
