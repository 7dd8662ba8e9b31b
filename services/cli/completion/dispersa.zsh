#compdef dispersa dispersa-coordinator dispersa-worker
# Completion of dispersa's programs for zsh. What may stand where is asked of the program itself.
_dispersa() {
  local line
  local -a found
  for line in "${(@f)$(${(Q)words[1]/#\~/$HOME} completion words "${(@Q)words[2,CURRENT]}" 2>/dev/null)}"; do
    case $line in
      '') ;;
      :file$'\t'yaml) compset -P '--*='; _files -g '*.(yaml|yml)' ;;
      :file) compset -P '--*='; _files ;;
      :folder) compset -P '--*='; _files -/ ;;
      *) found+=("${${line%%$'\t'*}//:/\\:}:${line#*$'\t'}") ;;
    esac
  done
  (( $#found )) && _describe -V 'dispersa' found
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
  _dispersa "$@"
else
  compdef _dispersa dispersa dispersa-coordinator dispersa-worker
fi
