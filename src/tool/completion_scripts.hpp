/// The texts of src/tool/completion.bash and .zsh, which the build inserts (completion_scripts.cpp.in).
#pragma once

namespace bin_scenes {

extern const char* const completion_for_bash;
extern const char* const completion_for_zsh;

}  // namespace bin_scenes
