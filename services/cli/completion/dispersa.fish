# Completion of dispersa's programs for fish. What may stand where is asked of the program itself.
function __dispersa_complete
    set -l words (commandline -opc)
    set -l word "$(commandline -ct)"
    set -l before (string match -r -- '^--[^=]*=' $word)
    set -l begun (string replace -- "$before" '' $word)
    for line in (command $words[1] completion words $words[2..] "$word" 2>/dev/null)
        switch $line
            case :file\tyaml
                string replace -r -- '^' "$before" (__fish_complete_path "$begun" | string match -r -- '^[^\t]*(?:/|\.ya?ml)(?:\t.*)?$')
            case :file
                string replace -r -- '^' "$before" (__fish_complete_path "$begun")
            case :folder
                string replace -r -- '^' "$before" (__fish_complete_directories "$begun" '')
            case '*'
                echo $line
        end
    end
end
for program in dispersa dispersa-coordinator dispersa-worker
    complete -c $program -f -a '(__dispersa_complete)'
end
