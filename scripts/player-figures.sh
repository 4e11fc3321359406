#!/bin/sh
# The pictures of the player in docs/images, for the docs and the README: from what `make demo` left, and from stitches.
# The stitches are simulated into WORK unless their materials are there (plain_knit.weft, two_colour_loops.weft: about 15
# minutes of processor time). The window needs Xvfb and xdotool.
# Usage: player-figures.sh WEFT DEMO-OUT WORK
set -eu

weft=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
demo=$(cd "$2" && pwd)
mkdir -p "$3"
work=$(cd "$3" && pwd)
source_dir=$(cd "$(dirname "$0")/.." && pwd)
images="$source_dir/docs/images"
weave="$source_dir/assets/weaves/wool_gabardine.wv"
cd "$work"

for stitch in plain_knit two_colour_loops; do
    [ -e $stitch.weft ] && continue
    "$weft" simulate "$source_dir/assets/stitches/$stitch.stitch" -o $stitch.btf.h5
    "$weft" compress $stitch.btf.h5 -o $stitch.weft
done

# A photographer's studio: a large soft box, a cool window opposite, grey walls, a warm floor.
python3 - <<'PYTHON' >studio.pfm
import array, math, sys
W, H = 256, 128

def toward(theta_deg, phi_deg):
    t, p = math.radians(theta_deg), math.radians(phi_deg)
    return math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)

LIGHTS = [(toward(42, -115), 9, 17, (20, 18, 15.5)), (toward(70, 20), 14, 28, (2.2, 2.7, 3.6))]

def radiance(d):
    rgb = [c * (0.35 + 0.65 * d[2]) for c in (.24, .25, .27)] if d[2] > 0 else [.11, .10, .09]
    for axis, full_deg, none_deg, colour in LIGHTS:
        angle_deg = math.degrees(math.acos(max(-1, min(1, sum(a * b for a, b in zip(d, axis))))))
        t = max(0, min(1, (none_deg - angle_deg) / (none_deg - full_deg)))
        rgb = [r + t * t * (3 - 2 * t) * c for r, c in zip(rgb, colour)]
    return rgb

values = array.array('f')
for row in range(H - 1, -1, -1):
    theta = math.pi * (row + .5) / H
    for column in range(W):
        phi = 2 * math.pi * (.75 - (column + .5) / W)
        values.extend(radiance((math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))))
sys.stdout.buffer.write(b'PF\n%d %d\n-1.0\n' % (W, H) + values.tobytes())
PYTHON
oiiotool studio.pfm -o studio.exr

studio="--environment studio.exr --light 42,-115,1.2,1.15,1.05 --shadows --exposure 1.1 --tone soft --camera -75,24,3.5"
draw() { # NAME, then options
    name=$1
    shift
    "$weft" render "$@" -o "$name.png" --quiet
    convert "$name.png" -strip -define png:compression-level=9 "$images/$name.png"
}
small="--size 640x420"
gabardine="$demo/gabardine.weft --raw $demo/gabardine.btf.h5"
# shellcheck disable=SC2086 # lists of options
{
    # The rig photographed the cloth magnified, so that its camera resolves yarns. Here it is nearer to its size.
    draw side-by-side $gabardine --weave "$weave" --mode split --repeat 40 --size 1110x390
    draw player-wipe $gabardine --layout wipe $studio $small
    draw player-difference $gabardine --layout difference $studio $small
    draw player-levels "$demo/gabardine.weft" $studio $small --repeat 20 --show level
    draw player-extrapolation "$demo/gabardine.weft" --light 50,-20 --exposure 2 --camera -75,32,3.5 $small --show extrapolation
    draw player-environment plain_knit.weft --repeat 24 $studio --light 42,-115,0.6 $small
    draw player-shadows two_colour_loops.weft --repeat 24 --light 48,-150,1.7,1.6,1.45 --light 62,10,0.25,0.32,0.5 --shadows \
        --exposure 1.3 --tone soft --camera -75,24,3.5 $small
}

# Analytic cloths: a weave without and with its noise, microcylinders.
light="--light 42,-115,1.2,1.15,1.05 --light 70,20,0.3,0.35,0.45 --shadows --tone soft --size 320x280 --quiet"
charmeuse="--weave $source_dir/assets/weaves/silk_charmeuse.wv --repeat 22 --exposure 0.8 --camera -75,35,1.8"
drape="--exposure 1.1 --camera -75,24,3.5"
# shellcheck disable=SC2086 # lists of options
{
    "$weft" render $charmeuse $light -o plain.png
    "$weft" render $charmeuse $light --noise 1 -o noisy.png
    "$weft" render --weave "$source_dir/assets/microcylinder/shot.mc" $drape $light -o shot.png
    "$weft" render --weave "$source_dir/assets/microcylinder/satin_face.mc" $drape $light -o satin.png
}
convert plain.png noisy.png shot.png satin.png +append -strip -define png:compression-level=9 "$images/player-cloths.png"

# What errors of lobes count for: raw, even weights, weights of a screen.
"$weft" compress "$demo/gabardine.btf.h5" --lobes 2 -o even.weft --quiet
"$weft" compress "$demo/gabardine.btf.h5" --lobes 2 --weights screen -o screen.weft --quiet
for pane in raw even screen; do
    case $pane in
    raw) files="$gabardine --mode raw" ;;
    even) files="even.weft" ;;
    screen) files="screen.weft" ;;
    esac
    # shellcheck disable=SC2086 # a list of options
    "$weft" render $files --environment none --size 480x420 -o weights-$pane.png --quiet
done
convert weights-raw.png weights-even.png weights-screen.png +append -strip -define png:compression-level=9 "$images/weights.png"

export weft demo weave images
xvfb-run -a -s '-screen 0 1280x800x24' sh -eu -c '
    "$weft" play "$demo/gabardine.weft" --raw "$demo/gabardine.btf.h5" --weave "$weave" --layout wipe --mode raw,compressed --quiet &
    player=$!
    window=$(xdotool search --sync --onlyvisible --name "^Weft" | head -n 1)
    xdotool windowmove --sync "$window" 0 0 windowfocus --sync "$window" mousemove 880 250
    sleep 40 # until the mean of its frames is finished, and its error measured
    import -window root window.png
    kill $player'
convert window.png -strip -define png:compression-level=9 "$images/window.png"
