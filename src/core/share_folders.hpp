/// Finds the data files (shaders, presets) of an installation that was moved to another place, relative to the
/// executable. It only lists candidates; the caller decides which of them has the file.
#pragma once

#include <filesystem>
#include <vector>

namespace bin_scenes {

/// The folders share/bin_scenes that may belong to the program and to the library or Python module that holds this
/// code; none of them needs to be there.
std::vector<std::filesystem::path> share_folders();

}  // namespace bin_scenes
