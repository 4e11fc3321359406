#!/bin/sh
# The first picture of photographs from few directions: seen and lit from there, neither black nor clipped.
# Usage: first_look.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/first-look-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# Grey photographs under the lights and views of a list, all of one value, and a material of them: NAME VALUE [OPTION...], angles on
# stdin. The options are those of compress.
photograph() {
    mkdir "$1"
    echo "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg" >"$1/directions.csv"
    convert -size 16x16 "xc:gray($2)" -depth 16 -type TrueColor grey.png
    while read -r angles; do
        cp grey.png "$1/$(echo "$angles" | tr , _).png"
        echo "$(echo "$angles" | tr , _).png,$angles" >>"$1/directions.csv"
    done
    expect_says "^no heights: " import "$1" -o "$1.btf.h5"
    name=$1
    shift 2
    expect_ok compress "$name.btf.h5" "$@" -o "$name.weft"
    grep -q "does not tile" out.log && fail "grey paper is said to have a seam: $(cat out.log)"
    true
}

# Largest value of the middle of a picture, 0 to 255; nothing of the background is there.
bright() {
    convert "$1" -gravity center -crop 20x20+0+0 +repage -colorspace Gray -format '%[fx:round(255*maxima)]' info:
}

# expect_setting PICTURE KEY VALUE: its settings say so.
expect_setting() {
    grep -a -A12 "\"$2\"" "$1" | tr -d '\n ' | grep -qaF -- "$3" || fail "$1 does not say $2 $3"
}

# From above, by flash, and dark: 15 degrees about the normal.
photograph dark "10%" --hold-out off <<ANGLES
3,0,3,0
12,0,12,0
12,72,12,72
12,144,12,144
12,216,12,216
12,288,12,288
15,30,15,30
15,150,15,150
15,270,15,270
ANGLES
for source in dark.weft dark.btf.h5; do
    expect_ok render "$source" --size 120x80 --samples 1 -o dark.png
    grep -q "^exposure" out.log || fail "nobody says how $source is exposed"
    expect_setting dark.png mesh plane
    value=$(bright dark.png)
    [ "$value" -gt 180 ] && [ "$value" -lt 255 ] || fail "$source is $value bright"
    # The camera stands inside of the cone, but sees the corners of the sheet from 18 degrees more to all sides.
    grep -q "beyond the photographs: [0-5]. % of the lit cloth is seen, 0 % is lit" out.log || fail "$source begins outside of its range: $(cat out.log)"
done

# What the user says is done.
expect_ok render dark.weft --exposure 1 --size 120x80 --samples 1 -o plain.png
grep -q "^exposure" out.log && fail "an exposure that was given was changed"
[ "$(bright plain.png)" -lt 120 ] || fail "an exposure of 1 shows $(bright plain.png)"
expect_ok render dark.weft --size 120x80 --samples 1 -o linear.exr
grep -q "^exposure" out.log && fail "linear numbers were exposed"
expect_says "beyond the photographs: 100 % of the lit cloth is seen" render dark.weft --camera=-90,20,3 --size 120x80 --samples 1 -o slant.png
expect_says "100 % is lit from where none was taken" render dark.weft --light 70,0 --size 120x80 --samples 1 -o lit.png
expect_ok render dark.weft --mesh drape --size 120x80 --samples 1 -o drape.png
expect_setting drape.png mesh drape

# The hemisphere, and bright: the picture of before.
photograph wide "80%" --hold-out off <<ANGLES
0,0,0,0
60,0,70,0
60,90,70,90
60,180,70,180
60,270,70,270
70,45,70,225
70,135,70,315
70,225,70,45
30,0,30,180
ANGLES
expect_ok render wide.weft --size 120x80 --samples 1 -o wide.png
expect_setting wide.png mesh drape
expect_setting wide.png azimuth_deg -70
value=$(bright wide.png)
[ "$value" -gt 100 ] && [ "$value" -lt 255 ] || fail "the bright one is $value bright"
# What is asked of lobes where components draw is said to be idle, and whose errors the levels have.
expect_ok render dark.weft --lobes-on none --size 60x40 --samples 1 -o idle.png
grep -q "drawn by its components: --lobes-on" out.log || fail "nobody says that --lobes-on changes nothing beside components"
expect_error 2 "'dark.weft' has no lobes: --components 0 cannot draw it" render dark.weft --components 0 --size 60x40 --samples 1 -o lobes.png
expect_no_file lobes.png
expect_ok info dark.weft
grep -q "fitted_level_0:" out.log || fail "info does not say the error of components: $(cat out.log)"
grep -q "errors_of: components" out.log || fail "info does not say whose errors the levels of a material of components have"

# Of one photograph nothing can be left out, and nothing is said of what the others say.
echo "30,0,0,0" | photograph alone "30%"
grep -q "one photograph says nothing about other directions" out.log || fail "a photograph alone is said to be predicted: $(cat out.log)"
grep -q "by the others" out.log && fail "there are no others"
# Paper that is brighter on the right: where it is repeated a line is seen.
mkdir slope
cp alone/directions.csv slope/directions.csv
convert -size 16x16 -define gradient:angle=90 gradient:gray30-gray50 -depth 16 -type TrueColor "slope/30_0_0_0.png"
expect_ok import slope -o slope.btf.h5
expect_says "does not tile: .*(.weft tile slope.weft --blend -o TILE.weft. mends that)" compress slope.btf.h5 --hold-out off -o slope.weft
expect_says '{"event":"seam","pairs":32,"above_99th":0.5,' compress slope.btf.h5 --hold-out off --json -o slope.weft
expect_ok tile slope.weft --blend -o tile.weft

# All of one view, and all of one light: nearly everything lies beyond, and the share tells nothing.
expect_says "beyond the photographs: every view but one, every light but one" render alone.weft --size 60x40 --samples 1 -o alone.png
printf '10,0,0,0\n40,0,0,0\n40,120,0,0\n40,240,0,0\n' | photograph above "30%" --hold-out off
expect_says "beyond the photographs: every view but one, [0-9]* % of the lit cloth is lit" render above.weft --size 60x40 --samples 1 -o above.png
printf '10,0,0,0\n10,0,40,0\n10,0,40,120\n10,0,40,240\n' | photograph below "30%" --hold-out off
expect_says "beyond the photographs: [0-9]* % of the lit cloth is seen, every light but one" render below.weft --size 60x40 --samples 1 -o below.png

# A wide picture from one place under four lamps, red above green: the plane shows it once, twice as wide as high.
mkdir wide-lamps
printf '4\n' >wide-lamps/lamps.lp
convert -size 32x8 "xc:rgb(200,40,40)" "xc:rgb(40,200,40)" -append -depth 8 -type TrueColor half.png
for light in "0.1 0 0.99" "0.6 0 0.8" "0 0.6 0.8" "-0.6 0 0.8"; do
    cp half.png "wide-lamps/$(echo "$light" | tr ' ' _).png"
    echo "$(echo "$light" | tr ' ' _).png $light" >>wide-lamps/lamps.lp
done
expect_ok import wide-lamps -o lamps.btf.h5 --values reflectance
expect_ok compress lamps.btf.h5 --hold-out off -o lamps.weft

# A line through the middle of a picture, as run lengths of r, g and - (neither): GEOMETRY.
runs() {
    convert lamps.png -crop "$1" +repage -depth 8 rgb:- | od -An -v -tu1 -w3 |
        awk '{print ($1 > $2 + 40 ? "r" : $2 > $1 + 40 ? "g" : "-")}' | uniq -c | awk '{printf "%s%s ", $2, $1}'
}
for source in lamps.weft lamps.btf.h5; do
    expect_ok render "$source" --size 120x80 --samples 1 -o lamps.png
    expect_setting lamps.png mesh plane
    column=$(runs 1x80+60+0) row=$(runs 120x1+0+30)
    echo "$column" | grep -qx -- "-[0-9]* r[0-9]* g[0-9]* -[0-9]* " || fail "$source is not shown once from above: $column"
    echo "$row" | grep -qx -- "-[0-9]* r[0-9]* -[0-9]* " || fail "$source is not shown once across: $row"
    high=$(echo "$column" | sed 's/.*r\([0-9]*\) g\([0-9]*\).*/\1 + \2/') wide=$(echo "$row" | sed 's/.*r\([0-9]*\).*/\1/')
    [ $((2 * ($high) - $wide)) -le 3 ] && [ $((2 * ($high) - $wide)) -ge -3 ] || fail "$source: $wide wide and $high high"
done
echo "first_look.sh: $passed checks"
