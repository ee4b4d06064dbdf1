/// src/tool/completion.bash and .zsh as texts (completion_scripts.cpp.in).
#pragma once

namespace bin_scenes {

extern const char* const completion_for_bash;
extern const char* const completion_for_zsh;

}  // namespace bin_scenes
