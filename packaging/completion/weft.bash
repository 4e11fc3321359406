# bash completion of weft: the program itself knows its options.
_weft() {
    local candidate rest current=${COMP_WORDS[COMP_CWORD]}
    [[ $current == = ]] && current=
    COMPREPLY=()
    while IFS=$'\t' read -r candidate rest; do
        case $candidate in
        :folder)
            compopt -o filenames
            mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -d -- "$current")
            ;;
        :file)
            compopt -o filenames
            mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -X "!*$rest" -- "$current"; compgen -d -- "$current")
            ;;
        *=*) COMPREPLY+=("${candidate#*=}") ;;
        *) COMPREPLY+=("$candidate") ;;
        esac
    done < <("${COMP_WORDS[0]}" --complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
    # Folders come once for each kind of file.
    [ ${#COMPREPLY[@]} = 0 ] || mapfile -t COMPREPLY < <(printf '%s\n' "${COMPREPLY[@]}" | sort -u)
}
complete -F _weft weft
