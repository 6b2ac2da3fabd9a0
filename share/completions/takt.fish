# Completion of takt and its programs for fish. The programs know what can come next: see `--complete` in
# apps/command_line/completion.hpp.

function __takt_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    for line in ($words[1] --complete $words[2..-1] "$current" 2>/dev/null)
        switch $line
            case ':directories'
                __fish_complete_directories "$current" ''
            case ':files'
                __fish_complete_path "$current"
            case ':files *'
                for extension in (string split ' ' -- (string replace ':files ' '' -- $line))
                    __fish_complete_suffix ".$extension"
                end
            case ':ask *'
                takt complete (string split ' ' -- (string replace ':ask ' '' -- $line)) 2>/dev/null
            case '*'
                echo $line
        end
    end
end

for program in takt taktd takt-follow takt-home takt-jog takt-logic takt-move
    complete -c $program -f -a '(__takt_complete)'
end
