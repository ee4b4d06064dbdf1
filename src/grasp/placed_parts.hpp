/// The parts and the bin of a scene as obstacles.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "grasp/sweep.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

struct PlacedPart {
  const MeshQuery* mesh = nullptr;
  Pose pose;
  Aabb box;              ///< bin frame
  int id = -1;           ///< -1: the bin
  std::size_t line = 0;  ///< of parts
  bool movable = false;
  std::vector<Vec3> tops;  ///< of movable parts: points of the surface that look up, spread evenly; bin frame
};

class PlacedParts {
 public:
  PlacedParts(const Scene& scene, const LoadedRequest& loaded);

  const std::vector<PlacedPart>& all() const { return all_; }  ///< parts in the order of the scene, then the bin
  const Vec3& up() const { return up_; }                       ///< unit, against gravity
  double top() const { return top_; }                          ///< m along up: of everything, rims included
  bool flat_floor() const { return flat_floor_; }              ///< whether the bin's floor is the plane z = 0
  /// The first of `order`, by index into all(), that a sweep meets, if any: its id. The endless floor comes last.
  std::optional<int> met_by(const Sweep& sweep, const std::vector<std::size_t>& order) const;

 private:
  std::vector<PlacedPart> all_;
  std::unique_ptr<MeshQuery> walls_;
  bool floor_ = false, flat_floor_ = false;
  Vec3 up_ = Vec3::UnitZ();
  double top_ = 0.0;
};

/// Highest and lowest of a box along a direction.
double highest(const Aabb& box, const Vec3& direction);
double lowest(const Aabb& box, const Vec3& direction);

}  // namespace bin_scenes
