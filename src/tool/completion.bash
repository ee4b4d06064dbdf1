# Completion of bin_scenes for bash. Installed, it is found by itself; else: source <(bin_scenes completion bash)

_bin_scenes() {
  local program=${COMP_WORDS[0]/#\~\//$HOME/} words=() begun=${COMP_WORDS[COMP_CWORD]} i word
  # Bash splits words at = and :, which belong to them here.
  for ((i = 1; i <= COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]#[\"\']}  # a quote may be open
    if ((i > 1)) && [[ $word == [=:]* || ${COMP_WORDS[i-1]} == *[=:] ]]; then
      words[-1]+=$word
    else
      words+=("$word")
    fi
  done
  [[ $begun == [=:] ]] && begun=""
  begun=${begun#[\"\']}
  local kept=${words[-1]%"$begun"} found endings
  COMPREPLY=()
  while IFS= read -r found; do
    if [[ $found == file:* ]]; then
      endings=${found#file:}
      compopt -o filenames
      while IFS= read -r word; do COMPREPLY+=("$word"); done < <(
        compgen -d -- "$begun"
        if [[ -z $endings ]]; then compgen -f -- "$begun"; else
          compgen -f -- "$begun" | grep -iE "\.(${endings//,/|})\$"
        fi | while IFS= read -r word; do [[ -d $word ]] || printf '%s\n' "$word"; done)
    else
      COMPREPLY+=("${found#"$kept"}")
    fi
  done < <("$program" complete -- "${words[@]}" 2>/dev/null)
  [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *[=.] ]] && compopt -o nospace
  return 0
}
complete -F _bin_scenes bin_scenes
