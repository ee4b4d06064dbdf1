/// A request together with the models that it names. It is the common input of the layers that pour, judge, render and
/// write a scene, so that none of them loads a file again.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"

#include <vector>

namespace bin_scenes {

/// The request and its prepared models.
struct LoadedRequest {
  Request request;
  std::vector<PartModelPtr> parts = {};  ///< the models, by part line
  PartModelPtr bin_model = nullptr;      ///< the mesh of the bin; Bin::Kind::mesh only
};

/// Returns the mass of one part of a line (kg): as given, or density times the volume of the mesh.
inline double mass_of(const PartLine& line, const PartModel& model) {
  return line.mass ? *line.mass : line.density.value_or(1000.0) * model.mass().volume;
}

}  // namespace bin_scenes
