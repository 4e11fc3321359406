# What the tests of the window share. Sourced; $weft is the program.

need() { # TOOL...
    for tool; do
        if ! command -v "$tool" >/dev/null; then
            echo "skipped: $tool is not installed"
            exit 77
        fi
    done
}

open_window() { # arguments of `weft play`: sets $player and $window
    "$weft" play "$@" &
    player=$!
    trap 'kill $player 2>/dev/null || true' EXIT
    window=$(xdotool search --sync --onlyvisible --name '^Weft' | head -n 1)
    xdotool windowmove --sync "$window" 0 0 windowfocus --sync "$window"
}

shots=0
save_picture() { # lets the player save what it shows: $next; false where none comes in half a minute
    xdotool key F12
    shots=$((shots + 1))
    next=$(printf 'weft-%03d.png' "$shots")
    for _ in $(seq 300); do
        [ -s "$next" ] && return
        sleep 0.1
    done
    return 1
}
