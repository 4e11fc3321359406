#!/bin/sh
# What the include paths cannot refuse: an include that climbs out of its folder, or a bare name that belongs to another folder; and
# the order of the stages along the corridor. And that nothing lies beside the rooms: what a test left behind was once committed. And
# that a folder can be taken in at a glance.
set -eu
cd "$(dirname "$0")/.."

rooms='base btf reflectance geometry capture registration import relief compress player study cli'
beside='[.]ci assets bench cmake docs packaging scripts tests'
faults=$(mktemp)
trap 'rm -f "$faults"' EXIT

# shellcheck disable=SC2086
git ls-files $rooms | grep -E '\.(c|h|cpp)$' | xargs grep -nE '^[[:space:]]*#[[:space:]]*include[[:space:]]+"' |
    awk -F: -v rooms="$rooms" '
    BEGIN {
        count = split(rooms, name, " ")
        for (i = 1; i <= count; i++)
            rank[name[i]] = i
        # Stages that do not know each other, though one stands before the other in the list.
        stranger["capture registration"] = stranger["capture import"] = stranger["registration import"] = 1
        stranger["capture compress"] = stranger["registration compress"] = stranger["import compress"] = 1
        stranger["capture player"] = stranger["registration player"] = stranger["import player"] = stranger["compress player"] = 1
        stranger["geometry registration"] = stranger["geometry import"] = stranger["geometry compress"] = stranger["geometry player"] = 1
        stranger["capture relief"] = stranger["registration relief"] = stranger["import relief"] = stranger["geometry relief"] = 1
        stranger["relief compress"] = stranger["relief player"] = 1
        stranger["reflectance registration"] = stranger["reflectance import"] = 1
    }
    {
        match($0, /"[^"]*"/)
        header = substr($0, RSTART + 1, RLENGTH - 2)
        from = $1
        sub(/\/.*/, "", from)
        to = header
        sub(/\/.*/, "", to)
        if (header ~ /(^|\/)\.\.\//)
            print $1 ":" $2 ": \"" header "\" climbs out of its folder"
        else if (header ~ /^\//)
            print $1 ":" $2 ": \"" header "\" is an absolute path"
        else if (header !~ /\//)
            print $1 ":" $2 ": \"" header "\" is named without its folder"
        else if (!(to in rank))
            print $1 ":" $2 ": \"" header "\" is in no room"
        else if (rank[to] > rank[from] || (to " " from) in stranger)
            print $1 ":" $2 ": " from " may not include " to
    }' >"$faults"
git ls-files | grep -v / | grep -vxE '[.](clang-format|clang-tidy|gitignore)|CMake(Lists[.]txt|Presets[.]json)|LICENSE|Makefile|README[.]md' |
    sed 's|$|: lies beside the rooms|' >>"$faults" || true
git ls-files | grep / | cut -d/ -f1 | sort -u | grep -vxE "$(echo $rooms $beside | tr ' ' '|')" |
    sed 's|$|/: is no room|' >>"$faults" || true
for room in $rooms; do
    grep -qE "^HeaderFilterRegex:.*[(|]$room[|)]" .clang-tidy || echo "$room/: .clang-tidy does not look at its headers" >>"$faults"
done
# Golden files and mutants are lists of cases, which nobody reads as a whole.
git ls-files | grep / | grep -vE '^tests/(golden|mutants)/' | sed 's|/[^/]*$||' | sort | uniq -c |
    awk '$1 > 40 { print $2 "/: holds " $1 " files, more than 40" }' >>"$faults"
cat "$faults"
[ ! -s "$faults" ]
