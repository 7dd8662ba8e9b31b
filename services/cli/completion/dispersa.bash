# Completion of dispersa's programs for bash. What may stand where is asked of the program itself.
_dispersa() {
  local word=${COMP_WORDS[COMP_CWORD]} line
  COMPREPLY=()
  while IFS= read -r line; do
    case $line in
      :file$'\t'yaml)
        compopt -o filenames 2>/dev/null
        while IFS= read -r line; do
          [[ -d $line || $line == *.yaml || $line == *.yml ]] && COMPREPLY+=("$line")
        done < <(compgen -f -- "${word#=}") ;;
      :file)
        compopt -o filenames 2>/dev/null
        while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -f -- "${word#=}") ;;
      :folder)
        compopt -o filenames 2>/dev/null
        while IFS= read -r line; do COMPREPLY+=("$line"); done < <(compgen -d -- "${word#=}") ;;
      *) COMPREPLY+=("${line%%$'\t'*}") ;;
    esac
  done < <("${COMP_WORDS[0]/#\~/$HOME}" completion words "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -F _dispersa dispersa dispersa-coordinator dispersa-worker
