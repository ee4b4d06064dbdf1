/// The plan of a pour, which follows from a request: parts, opening and limits. It is checked and computed once for all
/// scenes of the request.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/pour/spawn.hpp"
#include "bin_scenes/solver/solver.hpp"
#include "pour/lying.hpp"

#include <map>
#include <vector>

namespace bin_scenes {

/// The data that all scenes of a request share.
struct PourPlan {
  explicit PourPlan(const LoadedRequest& loaded);

  Request request;
  WorldDef world;                             ///< definition of a world with walls up to the rim
  std::vector<Cover> covers;                  ///< balls around the mesh, by part line
  Cover bin_cover;                            ///< the same for a bin that is a mesh
  double largest_part;                        ///< m: largest diagonal of a part
  Aabb bin_bounds;                            ///< outer bounds of a bin with walls; else empty
  Opening opening;                            ///< the box in which parts enter; upper.z is the height of the rim
  double entry_height = 0.0;                  ///< m, height of the walls of a box while parts enter
  std::map<std::size_t, LyingPoses> lying;    ///< stable orientations of the part lines on the table
  std::vector<std::size_t> line_of, copy_of;  ///< by body: index of its part line, and number within the line
};

}  // namespace bin_scenes
