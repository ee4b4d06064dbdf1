/// Finds the data files of bin_scenes: shaders, presets and scripts. They have the same relative paths in the source
/// tree and in the folder share/bin_scenes of an installation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bin_scenes {

/// Returns the places where the file or folder `path` may be, in the order in which they are tried: the source tree
/// that was built, the installation, and an installation that was moved, relative to the program and to the library or
/// Python module that holds this code. None of them needs to exist.
std::vector<std::filesystem::path> data_places(const std::filesystem::path& path);
/// Returns the first place that exists. Throws an environment Error that lists all places.
/// @param what  name of the files for the error message, such as "shaders"
std::filesystem::path first_place(const std::vector<std::filesystem::path>& places, const std::string& what,
                                  const std::string& remedy);

}  // namespace bin_scenes
