/// Finds the model files of a finished scene again, for the page of `view`. A scene stores names and digests of its
/// models, not the models, and may have been moved to another machine since. A file of the right name but with another
/// digest is not used.
#pragma once

#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/mesh/mesh.hpp"

#include <string>

namespace bin_scenes {

/// Mesh of an entry of `models` in scene.json (keys model, sha256 and how the file was read), in metres. The file is
/// looked for as the request wrote it, and by its name: in `models` if that is given, in the working directory, beside
/// the scene, above it, and in folders called models there. Throws an input Error if no file has the digest.
/// @param bin  of scene.json; decides what size of a part without a unit is plausible
Mesh find_model(const SceneModel& model, const Bin& bin, const std::string& folder, const std::string& models);
/// Returns the path of that file.
std::string find_model_file(const SceneModel& model, const std::string& folder, const std::string& models);
/// Finds the mesh of a bin.
Mesh find_bin(const Bin& bin, const std::string& folder, const std::string& models);

}  // namespace bin_scenes
