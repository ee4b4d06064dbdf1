/// Where the files of an installation lie that was moved: shaders, presets.
#pragma once

#include <filesystem>
#include <vector>

namespace bin_scenes {

/// The folders share/bin_scenes that may belong to the program and to the library or Python module that holds this
/// code; none of them needs to be there.
std::vector<std::filesystem::path> share_folders();

}  // namespace bin_scenes
