/// A request together with the models that it names.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"

#include <vector>

namespace bin_scenes {

/// The common input of pouring, judging, rendering and writing a scene.
struct LoadedRequest {
  Request request;
  std::vector<PartModelPtr> parts = {};  ///< the models, by part line
  PartModelPtr bin_model = nullptr;      ///< Bin::Kind::mesh only
};

/// Mass of one part of the line (kg): as given, or density times the volume of the mesh.
inline double mass_of(const PartLine& line, const PartModel& model) {
  return line.mass ? *line.mass : line.density.value_or(1000.0) * model.mass().volume;
}

}  // namespace bin_scenes
