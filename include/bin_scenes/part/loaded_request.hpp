/// A request and what it names.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"

#include <vector>

namespace bin_scenes {

/// What pouring, judging, rendering and writing of a scene are given together.
struct LoadedRequest {
  Request request;
  std::vector<PartModelPtr> parts = {};  ///< the models, by part line
  PartModelPtr bin_model = nullptr;      ///< Bin::Kind::mesh only
};

/// Of one part of the line (kg).
inline double mass_of(const PartLine& line, const PartModel& model) {
  return line.mass ? *line.mass : line.density.value_or(1000.0) * model.mass().volume;
}

}  // namespace bin_scenes
