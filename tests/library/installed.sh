#!/bin/bash
# The installed library in somebody else's program: the example by pkg-config and by CMake, and the module for Python, give the values of
# `weft eval`; stages.c goes from a session to a picture.
# Usage: installed.sh WEFT ASSETS TREE PYTHON
set -eu
weft=$1
# shellcheck disable=SC2034
assets=$2 # of simulate_knit
tree=$3
python=$4
build=$(cd "$(dirname "$1")/.." && pwd)
scratch=$(mktemp -d "$PWD/installed-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
. "$(dirname "$0")/../cli/expect.sh"
cd "$scratch"
cmake --install "$build" --prefix "$scratch/first" >/dev/null
mv first stage # what is installed may be moved
libdir=$(dirname "$(find stage -name libweft.so.0)")
PKG_CONFIG_PATH=$PWD/$libdir/pkgconfig
LD_LIBRARY_PATH=$PWD/$libdir
export PKG_CONFIG_PATH LD_LIBRARY_PATH

simulate_knit
expect_ok compress knit.btf.h5 -o cloth.weft --components 4 --hold-out off

# The example, by pkg-config and by CMake
# shellcheck disable=SC2046
cc -std=c17 -Wall -Wextra -Werror "$tree/examples/evaluate.c" $(pkg-config --cflags --libs weft) -lm -o by_pkg_config
cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(somebody_else LANGUAGES C)
find_package(weft 0.2 REQUIRED)
add_executable(by_cmake evaluate.c)
target_link_libraries(by_cmake weft::weft m)
END
cp "$tree/examples/evaluate.c" .
cmake -S . -B other -DCMAKE_PREFIX_PATH="$PWD/stage" >/dev/null
cmake --build other >/dev/null
./by_pkg_config cloth.weft >values
[ "$(wc -l <values)" = 8 ] || fail "the example prints $(cat values)"
other/by_cmake cloth.weft | cmp - values || fail "by CMake the example prints other values"
code=0
./by_pkg_config absent.weft 2>message || code=$?
[ "$code" = 1 ] || fail "of an absent file the example has the exit code $code"
grep -q "absent.weft" message || fail "of an absent file the example says $(cat message)"

# weft eval says the same
{
    echo lx,ly,lz,vx,vy,vz,u,v,level
    awk '{ theta = 1.4 * (NR - 1) / 8; gsub(/[,:]/, " "); printf "0,0.6,0.8,0,%.17g,%.17g,%s,%s,%s\n", -sin(theta), cos(theta), $3, $4, $6 }' values
} >at.csv
"$weft" eval cloth.weft --at at.csv | tail -n +2 | awk -F, '{ printf "%.5f %.5f %.5f\n", $10, $11, $12 }' >expected
paste -d ' ' values expected | tr ':,' '  ' | awk '
    { for (i = 0; i < 3; i++) if (($(7 + i) - $(11 + i)) ^ 2 > 1e-8) { print; bad = 1 } }
    END { exit bad || NR != 8 }' || fail "weft eval and the example differ"

# Every stage, in a program that sees the public headers alone
printf 'theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n0,0,0,0\n40,60,0,0\n0,0,30,90\n40,60,30,90\n' >plan.csv
expect_ok capture --sample "$assets/weaves/polyester_lining.wv" --plan plan.csv --truth-images 1 --truth-size 4 -o session
cp -r session unfinished
sed -i '$d' unfinished/journal.jsonl
# shellcheck disable=SC2046
cc -std=c17 -Wall -Wextra -Werror "$tree/tests/library/stages.c" $(pkg-config --cflags --libs weft) -o stages
./stages session unfinished || fail "the stages of the library"

if ! "$python" -c 'import numpy' 2>/dev/null; then
    echo "skipped the module for Python: there is no NumPy"
    exit 0
fi
PYTHONPATH=$(dirname "$(find "$PWD/stage" -name weft.py)") "$python" "$tree/tests/library/check_module.py" cloth.weft values
echo "passed"
