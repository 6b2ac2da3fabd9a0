# Completion of takt and its programs for bash. The programs know what can come next: see `--complete` in
# apps/command_line/completion.hpp.

_takt() {
  local line kind file extension
  local -a words files
  read -ra words <<<"${COMP_LINE:0:COMP_POINT}"
  [[ ${COMP_LINE:COMP_POINT-1:1} == ' ' ]] && words+=('')
  local current=${words[-1]}
  # bash replaces only what follows the last ':' or '='.
  local kept=${current##*[:=]}
  local dropped=${current%"$kept"}
  COMPREPLY=()
  while IFS= read -r line; do
    case $line in
      ':directories') mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -d -- "$current") ;;
      ':files'*)
        compopt -o filenames 2>/dev/null
        mapfile -t files < <(compgen -f -- "$current")
        for file in "${files[@]}"; do
          kind=${line#:files}
          [[ -z $kind || -d $file ]] && COMPREPLY+=("$file")
          [[ -d $file ]] && continue
          for extension in $kind; do [[ $file == *."$extension" ]] && COMPREPLY+=("$file"); done
        done ;;
      ':ask '*)
        # shellcheck disable=SC2086 # words of the request
        while IFS= read -r line; do
          line=${line%%$'\t'*}
          [[ $line == "$current"* ]] && COMPREPLY+=("${line#"$dropped"}")
        done < <(takt complete ${line#:ask } 2>/dev/null) ;;
      *)
        line=${line%%$'\t'*}
        COMPREPLY+=("${line#"$dropped"}") ;;
    esac
  done < <("${words[0]}" --complete "${words[@]:1}" 2>/dev/null)
}

complete -F _takt takt taktd takt-follow takt-home takt-jog takt-logic takt-move
