#!/bin/sh
# The command weft prune, whole: what it writes, says and refuses. Usage: prune.sh WEFT ASSETS
set -eu
weft=$1
assets=$2
export LIBGL_ALWAYS_SOFTWARE=1
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/prune-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

simulate_knit
expect_ok compress knit.btf.h5 -o knit.weft --components 8 --hold-out off
expect_ok compress knit.btf.h5 -o lobes.weft --lobes 1 --hold-out off
printf 'time_s,azimuth_deg,elevation_deg,distance,light_phi_deg\n0,-90,80,3,-110\n0.3,-70,70,3.2,-80\n' >path.csv
set -- --mesh plane --light 30,-110 --repeat 12 --size 64x48 --samples 1

# A far camera: finer levels and most views are gone, and pictures stay.
for name in knit lobes; do
    expect_ok prune $name.weft "$@" --path path.csv -o small.weft
    grep -q "^measured  RMSE 0\.[0-4]" out.log || fail "pictures of $name.weft differ: $(cat out.log)"
    # Of 8 x 8 texels lobes take less room than the maps of what is seen.
    [ $name = lobes ] || [ "$(wc -c <small.weft)" -lt "$(wc -c <$name.weft)" ] || fail "$name.weft is not smaller"
    expect_ok verify small.weft
    expect_says "pruned" info small.weft
    grep -q "rmse_of_255" out.log || fail "weft info does not show the measured error"
done
expect_ok render small.weft "$@" --camera=-90,20,1.3 -o outside.png --show extrapolation

# The same is found again; a path of one key, and none, are scenes that stand still.
head -n 2 path.csv >one.csv
expect_ok prune knit.weft "$@" --path one.csv -o again.weft
expect_ok prune knit.weft "$@" --path one.csv -o twice.weft
cmp again.weft twice.weft || fail "the same scene gives another file"
expect_ok prune knit.weft "$@" --error 0 -o still.weft
grep -q "nothing moves" out.log || fail "a still scene has other moments: $(cat out.log)"
! grep -q "more than was allowed" out.log || fail "rounding counts as an error: $(cat out.log)"
expect_ok prune knit.weft "$@" --error 0 -o told.weft --json
grep -q '"event":"pruned"' out.log || fail "there is no event"
# The sizes are those of the files; that of the new one does not count what it says of the pruning.
before=$(sed -n 's/.*"bytes":\[[0-9]*,\([0-9]*\)\].*/\1/p' out.log)
after=$(sed -n 's/.*"bytes":\[\([0-9]*\),.*/\1/p' out.log)
added=$(($(wc -c <told.weft) - after))
[ "$before" -eq "$(wc -c <knit.weft)" ] || fail "knit.weft is said to have $before bytes"
[ "$added" -gt 0 ] && [ "$added" -lt 1024 ] || fail "told.weft has $added bytes more than was said"

# A picture is a scene.
expect_ok render knit.weft "$@" -o shot.png
expect_ok prune knit.weft --settings shot.png --error 0 -o shot.weft

expect_error 1 "already pruned for a scene" prune again.weft "$@" -o no.weft
printf 'time_s,pan_right\n0,30\n' >aside.csv
expect_error 1 "nothing of the mesh" prune knit.weft "$@" --path aside.csv -o no.weft
printf 'v 0 0 0\nv 1 0 0\nv 0 0 1\nvt 0.5 0.5\nf 1/1 2/1 3/1\n' >flat.obj
expect_error 1 "texture coordinates" prune knit.weft --mesh flat.obj --repeat 2 --light 20,0 -o no.weft
printf 'v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n' >bare.obj
expect_error 1 "texture coordinates" prune knit.weft --mesh bare.obj --repeat 2 --light 20,0 -o no.weft
printf 'time_s,distance\n0,nan\n' >nan.csv
expect_error 1 "nan.csv:2" prune knit.weft "$@" --path nan.csv -o no.weft
expect_error 2 "needs a material" prune --raw knit.btf.h5 -o no.weft
expect_error 2 "-o SMALL.weft" prune knit.weft
expect_error 2 "overwrite" prune knit.weft -o knit.weft
expect_no_file no.weft
echo "$passed commands as expected"
