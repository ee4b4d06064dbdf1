/// Finds the model files of a finished scene again, for the page of `view`. A scene stores names and digests of its
/// models, not the models, and may have been moved to another machine since. A file of the right name but with another
/// digest is not used.
#pragma once

#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/mesh/mesh.hpp"

#include <string>

namespace bin_scenes {

/// Returns the mesh (m) of an entry of `models` in scene.json. The file is searched at the path of the request, and by
/// name in `models` if that is given, in the working directory, in the folder of the scene, above it, and in folders
/// named `models` there. Throws an input Error if no file has the digest.
/// @param bin  bin of the scene; decides which unit is plausible for a model file that states none
Mesh find_model(const SceneModel& model, const Bin& bin, const std::string& folder, const std::string& models);
/// Returns the path of that file.
std::string find_model_file(const SceneModel& model, const std::string& folder, const std::string& models);
/// Finds the mesh of a bin.
Mesh find_bin(const Bin& bin, const std::string& folder, const std::string& models);

}  // namespace bin_scenes
