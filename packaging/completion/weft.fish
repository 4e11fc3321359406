# fish completion of weft: the program itself knows its options.
function __weft_complete
    set -l words (commandline -opc) (commandline -ct)
    for line in (command $words[1] --complete $words[2..-1] 2>/dev/null)
        set -l part (string split -m 1 \t -- $line)
        switch $part[1]
            case ':folder'
                __fish_complete_directories (commandline -ct)
            case ':file'
                __fish_complete_suffix "$part[2]"
            case '*'
                echo $line
        end
    end
end
complete -c weft -f -a '(__weft_complete)'
