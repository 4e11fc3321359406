#!/bin/sh
# What a user gets wrong is said before any work is done: one line, the right exit code, no file. Usage: bad_usage.sh WEFT ASSETS PYTHON
set -eu
weft=$1
assets=$2
. "$(dirname "$0")/expect.sh"
scratch=$(mktemp -d "$PWD/bad-usage-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

weave="$assets/weaves/polyester_lining.wv"
write_plan >plan.csv
expect_ok capture --sample "$weave" --plan plan.csv -o good
expect_ok register good --size 8x8 -o good.btf.h5
expect_ok compress good.btf.h5 --lobes 1 -o good.weft

# One line of weft's own; argp adds where help is to be had.
expect_one_line() {
    expect_error "$@"
    [ "$(grep -c "^weft " err.log)" = 1 ] || fail "more than one line: $(cat err.log)"
}

# One file in the place of another.
expect_one_line 1 "'good.weft' is a material" compress good.weft -o out.weft
expect_one_line 1 "'good.weft' is a material" compare good.weft good.btf.h5 -o report
expect_one_line 1 "'good.weft' is a material" tile good.weft -o out.btf.h5
expect_one_line 1 "'good.btf.h5' is no material" tile good.btf.h5 --blend -o out.weft
expect_one_line 1 "8 x 8 texels; at least 16 x 16" tile good.weft --blend -o out.weft
expect_one_line 2 "--blend needs none" tile good.weft --blend --weave "$weave" -o out.weft
expect_one_line 1 "'good.weft' is a material" render --raw good.weft -o out.png
expect_one_line 1 "'good.btf.h5' is a dataset" compare good.btf.h5 good.btf.h5 -o report
expect_no_file out.weft
expect_no_file out.btf.h5
expect_no_file report

# Outputs that cannot be.
expect_one_line 2 "'out.gif' names no kind of picture" render good.weft -o out.gif
expect_one_line 2 "'out' names no kind of picture" render good.weft -o out
expect_one_line 3 "folder 'absent'" render good.weft -o absent/out.png
for command in compress tile; do
    expect_one_line 3 "folder 'absent'" "$command" good.btf.h5 -o absent/out
done
expect_one_line 3 "folder 'absent'" photographs good -o absent/out.btf.h5
expect_one_line 3 "'good.weft' is a file" compare good.btf.h5 good.weft -o good.weft/report
expect_one_line 3 "'good.weft' is a file" capture --sample "$weave" --plan plan.csv -o good.weft
expect_one_line 3 "'good.weft' is a file" hand checker -o good.weft/new
for command in "register good" "photographs good" "compress good.btf.h5 --error 20"; do
    # shellcheck disable=SC2086
    expect_one_line 3 "'good.weft' is a file" $command -o out --report good.weft
    expect_no_file out
done
if [ "$(id -u)" != 0 ]; then
    mkdir locked
    chmod 555 locked
    expect_one_line 3 "folder 'locked'" compress good.btf.h5 -o locked/out.weft
    expect_one_line 3 "folder 'locked'" compare good.btf.h5 good.weft -o locked/new/report
fi
expect_one_line 1 "no file 'absent.btf.h5'" render --raw absent.btf.h5 -o out.png

# Lights and meshes.
expect_one_line 2 "below the horizon" render good.weft --light 120,0 -o out.png
expect_ok render good.weft --light 90,0 --size 32x32 -o dark.png
expect_one_line 1 "drape, sphere, plane" render good.weft --mesh cube -o out.png
expect_no_file out.png

# A window is not opened for what is not there: no display is needed to say so.
expect_one_line 1 "no file 'absent'" play --raw absent
expect_one_line 1 "no file 'absent.weft'" play absent.weft
expect_one_line 1 "drape, sphere, plane" play good.weft --mesh cube

# What can be shown is shown, whatever it is.
for file in good.btf.h5 "$weave" good.weft; do
    rm -f shown.png
    expect_ok render "$file" --size 32x32 -o shown.png
    [ -s shown.png ] || fail "$file is not shown"
done
expect_ok render good.btf.h5 --size 32x32 --samples 1 -o by-place.png
expect_ok render --raw good.btf.h5 --size 32x32 --samples 1 -o by-name.png
[ "$(convert by-place.png rgb:- | cksum)" = "$(convert by-name.png rgb:- | cksum)" ] || fail "a dataset by its place is another picture"
expect_one_line 2 "of one kind" render --raw good.btf.h5 good.btf.h5 -o out.png
echo "bad_usage.sh: $passed checks"
