#!/bin/sh
# Man pages of what the program says of itself. Usage: manual.sh WEFT FOLDER COMMAND...
set -eu
weft=$1
folder=$2
shift 2
# The same sources give the same bytes: pages carry a date.
: "${SOURCE_DATE_EPOCH:=$(git -C "$(dirname "$0")" log -1 --format=%ct 2>/dev/null || date +%s)}"
export SOURCE_DATE_EPOCH

version=$("$weft" --version)

# help2man takes the name of the page from the line of the version.
page() { # NAME SUMMARY SECTIONS [COMMAND]
    printf '#!/bin/sh\nexec "%s" %s "$@"\n' "$weft" "${4-}" >"$folder/$1"
    chmod +x "$folder/$1"
    printf '%s\n' "$3" >"$folder/sections"
    help2man --no-info --section 1 --source Weft --manual "Weft" --version-string "$1 ${version#weft }" --name "$2" \
        --include "$folder/sections" --output "$folder/$1.1" "$folder/$1"
    rm -f "$folder/$1" "$folder/sections"
}

exit_codes="[exit status]
0 done; 1 bad input; 2 bad usage; 3 device or system failure.
"
see_also=""
for command in "$@"; do
    see_also="$see_also, weft-$command(1)"
    summary=$("$weft" --complete "$command" | awk -F '\t' -v name="$command" '$1 == name { print $2 }')
    page "weft-$command" "$summary" "$exit_codes
[see also]
weft(1)" "$command"
done
page weft "photographs of a material to something that plays in real time" "$exit_codes
[see also]
${see_also#, }"
