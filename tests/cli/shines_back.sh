#!/bin/sh
# Cloth that shines back in a narrow beam: layers fail, and compress asks lobes. Usage: shines_back.sh WEFT ASSETS PYTHON
set -eu
weft=$1
python=$3
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/shines-back-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# photograph NAME PEAK: 37 views x 37 lights of 2 x 2 pixels, a Gaussian of 10 degrees about the way back over a matt ground.
photograph() {
    "$python" - "$1" "$2" <<'PYTHON'
import math, os, struct, sys, zlib
name, peak = sys.argv[1], float(sys.argv[2])
directions = [(theta, 360 * i // count) for theta, count in ((0, 1), (20, 6), (40, 12), (60, 18)) for i in range(count)]

def vector(theta, phi):
    t, p = math.radians(theta), math.radians(phi)
    return math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)

def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))

def png(value):
    rows = b''.join(b'\0' + b''.join(struct.pack('>H', round(65535 * value * share)) * 3 for share in row)
                    for row in ((1, .9), (.8, .95)))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 2, 2, 16, 2, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))

for tv, pv in directions:
    folder = '%s/tv%03d_pv%03d' % (name, tv, pv)
    os.makedirs(folder)
    for tl, pl in directions:
        cosine = sum(a * b for a, b in zip(vector(tv, pv), vector(tl, pl)))
        angle = math.degrees(math.acos(max(-1, min(1, cosine))))
        value = math.cos(math.radians(tl)) * (.05 + peak * math.exp(-(angle / 10) ** 2 / 2))
        with open('%s/tl%03d_pl%03d_tv%03d_pv%03d.png' % (folder, tl, pl, tv, pv), 'wb') as file:
            file.write(png(value))
PYTHON
    expect_ok import "$1" --linear -o "$1.btf.h5"
}

photograph tape .9
expect_says "one lobe" compress tape.btf.h5 -o tape.weft
cat out.log err.log | grep "one lobe"
expect_ok compress tape.btf.h5 --components 16 -o tape.weft
! grep -q "one lobe" out.log err.log || fail "who asks for layers is told of lobes"
photograph matt 0
expect_ok compress matt.btf.h5 -o matt.weft
! grep -q "one lobe" out.log err.log || fail "lobes are asked where layers do well"
echo "$passed passed, 0 failed"
