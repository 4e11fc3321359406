#!/bin/sh
# A real camera on USB, from its recording: libgphoto2 knows it, and knows that it cannot be released. Usage:
# recorded_camera.sh WEFT ASSETS
set -eu
cameras=${WEFT_SHARED:-/nonexistent}/real/camera-usb/umockdev/cameras
recorded=$cameras/canon-powershot-sx200
command -v umockdev-run >/dev/null || { echo "skipped: needs umockdev-run" && exit 77; }
[ -r "$recorded.noint.umockdev" ] || { echo "skipped: no recordings in $cameras" && exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp "$2/rigs/nominal.lens.json" "$scratch"
sed -e 's/backend = folder/backend = gphoto2/; s/device = "incoming"/device = ""/; s/trigger = hand/trigger = none/' \
    "$2/rigs/photographs.conf" >"$scratch/rig.conf"
cd "$scratch"

# expect TEXT RUNNER...: the capture ends at once, in one line that has TEXT, and begins no session.
expect() {
    text=$1
    shift
    code=0
    timeout 20 "$@" -- "$weft" capture --rig rig.conf --sample scarf -o session >out.log 2>&1 </dev/null || code=$?
    { [ "$code" = 3 ] && grep -q "^weft capture: camera: .*$text" out.log && [ "$(wc -l <out.log)" = 1 ] && [ ! -e session ]; } ||
        { echo "exit code $code, and not '$text': $(cat out.log)" && exit 1; }
}
weft=$1
expect "cannot release the shutter of a Canon PowerShot SX200 IS" umockdev-run -d "$recorded.noint.umockdev" \
    -i "/dev/bus/usb/001/011=$recorded.libgphoto2-2.5.30.ioctl"
expect "finds no camera" umockdev-run
echo sound
