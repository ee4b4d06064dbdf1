/// Draws a part with the axes of its symmetries as a PNG picture, so that a user can check them by eye. `bin_scenes
/// symmetries --picture` writes it. The symmetries are found in part/symmetry.hpp.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/part/symmetry.hpp"

#include <string>

namespace bin_scenes {

/// Draws the part from an upper corner; continuous axes are red, discrete ones blue. Throws an environment Error.
void write_symmetry_picture(const std::string& path, const PartModelPtr& part, const Symmetries& symmetries);

}  // namespace bin_scenes
