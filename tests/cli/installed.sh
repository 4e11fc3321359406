#!/bin/bash
# Weft as it is installed: moved elsewhere it runs, its pages say what --help says, the shell completes what a user begins to type.
# Usage: installed.sh WEFT ASSETS PYTHON
set -eu
assets=$2
build=$(cd "$(dirname "$1")/.." && pwd)
scratch=$(mktemp -d "$PWD/installed-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
weft=$scratch/moved/bin/weft
. "$(dirname "$0")/expect.sh"
cd "$scratch"
[ -e "$build/packaging/weft.1" ] || exit 77

DESTDIR=$scratch/stage cmake --install "$build" --prefix /opt/weft >/dev/null
mv stage/opt/weft moved
expect_ok render --weave moved/share/weft/weaves/cotton_denim.wv --size 32x32 --samples 1 -o picture.exr
[ -s picture.exr ] || fail "no picture from the installed program"
mv moved/lib gone
expect_error 3 "weft_image_library.so" render --weave "$assets/weaves/cotton_denim.wv" --size 32x32 --samples 1 -o none.exr
expect_no_file none.exr
expect_ok info "$assets/weaves/cotton_denim.wv"
mv gone moved/lib

# Every option of every command stands on its page.
commands=$("$weft" --complete "" | grep -v '^-' | cut -f 1)
[ "$(echo "$commands" | wc -l)" -ge 19 ] || fail "few commands are completed: $commands"
for command in $commands; do
    page=moved/share/man/man1/weft-$command.1
    [ -s "$page" ] || fail "no page of $command"
    for option in $("$weft" --complete "$command" -- | cut -f 1); do
        sed 's/\\//g' "$page" | grep -q -- "$option" || fail "$option is not on the page of $command"
    done
    summary=$("$weft" --help | sed -n "s/^  $command  *//p")
    [ -n "$summary" ] || fail "$command is not in --help"
    sed 's/\\//g' "$page" | grep -qF -- "weft-$command - $summary" || fail "the page of $command is not headed '$summary'"
    grep -q "weft-$command(1)" moved/share/man/man1/weft.1 || fail "weft.1 does not lead to $command"
done

# What bash makes of a line: completes LINE... and compares with the candidates.
# shellcheck source=/dev/null
. moved/share/bash-completion/completions/weft
compopt() { :; } # there is no line to complete
touch silk.btf.h5 silk.weft sky.exr
mkdir night
expect_completed() {
    wanted=$1
    shift
    COMP_WORDS=("$weft" "$@")
    COMP_CWORD=$#
    _weft
    got=$(printf '%s\n' "${COMPREPLY[@]}" | sort | tr '\n' ' ')
    [ "$got" = "$wanted " ] || fail "'$*' becomes '$got', not '$wanted'"
    passed=$((passed + 1))
}
expect_completed "calibrate capture colour compare compress" c
expect_completed "--lobes" compress --l
expect_completed "even screen" compress silk.btf.h5 --weights = ""
expect_completed "screen" compress silk.btf.h5 --weights = s
expect_completed "silk.btf.h5" compress silk.b
expect_completed "moved night silk.btf.h5 stage" compress ""
expect_completed "moved night silk.weft stage" compare silk.btf.h5 ""
expect_completed "moved night silk.weft stage" compress silk.btf.h5 -o ""
expect_completed "silk.btf.h5 silk.weft stage" play s
expect_completed "night" register ni
expect_completed "" nonsense ""
expect_completed "" compress --lobes = ""
expect_completed "silk.btf.h5" compress --lobes = 2 silk.b
echo "$passed passed, 0 failed"
