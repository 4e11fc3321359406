#!/bin/sh
# Checks every page of the repository that is written in Markdown: relative links and their anchors lead somewhere, no line
# outside a table is longer than 160 characters, and docs/README.md links to every page of docs/. Checks also that the pages
# exist that comments, scripts and messages name by their path. Usage: check-docs.sh
set -eu
cd "$(dirname "$0")/.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
: >"$scratch/anchors"
: >"$scratch/links"
: >"$scratch/problems"

find . -path ./build -prune -o -path ./demo-out -prune -o -path ./.git -prune -o -name '*.md' -print | sed 's|^\./||' | sort >"$scratch/pages"

# Writes PAGE#ANCHOR for every heading, and PAGE:LINE TARGET ANCHOR for every relative link.
while read -r page; do
    awk -v page="$page" -v anchors="$scratch/anchors" -v links="$scratch/links" -v problems="$scratch/problems" '
        function normal(path,    part, kept, count, n, i) {
            n = split(path, part, "/")
            count = 0
            for (i = 1; i <= n; i++)
                if (part[i] == "..") count--
                else if (part[i] != "." && part[i] != "") kept[++count] = part[i]
            path = kept[1]
            for (i = 2; i <= count; i++) path = path "/" kept[i]
            return path
        }
        /^```/ { fenced = !fenced }
        length($0) > 160 && !/^\|/ { print page ":" NR ": the line has " length($0) " characters, more than 160" >>problems }
        fenced || /^    / { next }
        /^#+ / {
            slug = tolower($0)
            sub(/^#+ +/, "", slug)
            gsub(/[^a-z0-9 _-]/, "", slug)
            gsub(/ /, "-", slug)
            print page "#" slug (seen[slug]++ ? "-" (seen[slug] - 1) : "") >>anchors
        }
        {
            folder = page
            if (!sub(/[^\/]*$/, "", folder)) folder = ""
            text = $0
            gsub(/`[^`]*`/, "", text)
            while (match(text, /\]\([^)]*\)/)) {
                target = substr(text, RSTART + 2, RLENGTH - 3)
                text = substr(text, RSTART + RLENGTH)
                if (target ~ /^[a-z]+:/) continue
                anchor = "-"
                if (match(target, /#/)) {
                    anchor = substr(target, RSTART + 1)
                    target = substr(target, 1, RSTART - 1)
                }
                print page ":" NR, target == "" ? page : normal(folder target), anchor >>links
            }
        }' "$page"
done <"$scratch/pages"

while read -r from target anchor; do
    if [ ! -e "$target" ]; then
        echo "$from: there is no $target"
    elif [ "$anchor" != - ] && ! grep -qxF "$target#$anchor" "$scratch/anchors"; then
        echo "$from: $target has no heading #$anchor"
    fi
done <"$scratch/links" >>"$scratch/problems"

while read -r page; do
    case $page in
    docs/README.md) ;;
    docs/*) grep -q "^docs/README.md:[0-9]* $page " "$scratch/links" || echo "docs/README.md: does not link to $page" ;;
    esac
done <"$scratch/pages" >>"$scratch/problems"

grep -rnoIE --exclude-dir=.git --exclude-dir=build --exclude-dir=demo-out 'docs/[a-z/-]+\.md' . | sed 's|^\./||' >"$scratch/named"
while IFS=: read -r file line page; do
    [ -e "$page" ] || echo "$file:$line: there is no $page"
done <"$scratch/named" >>"$scratch/problems"

if [ -s "$scratch/problems" ]; then
    cat "$scratch/problems" >&2
    exit 1
fi
echo "$(wc -l <"$scratch/pages") pages, $(wc -l <"$scratch/links") links: sound"
