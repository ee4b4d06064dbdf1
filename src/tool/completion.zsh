#compdef bin_scenes
# Completion of bin_scenes for zsh. Installed, it is found by itself; else: source <(bin_scenes completion zsh)

_bin_scenes() {
  local program=${(Q)words[1]} found
  local -a plain open
  for found in ${(f)"$(${~program} complete -- "${(@Q)words[2,CURRENT]}" 2>/dev/null)"}; do
    if [[ $found == file:* ]]; then
      local endings=${found#file:}
      compset -P '*='
      if [[ -z $endings ]]; then _files; else _files -g "*.(#i)(${endings//,/|})"; fi
    elif [[ $found == *[=.] ]]; then
      open+=($found)
    else
      plain+=($found)
    fi
  done
  (( ${#plain} )) && compadd -a plain
  (( ${#open} )) && compadd -S '' -a open
  return 0
}
if [[ $funcstack[1] == _bin_scenes ]]; then _bin_scenes "$@"; else compdef _bin_scenes bin_scenes; fi
