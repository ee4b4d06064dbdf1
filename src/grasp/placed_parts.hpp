/// The parts and the bin of a scene as obstacles. Each has its mesh at its final pose with a bounding box, so that
/// sweeps of a gripper can be tested against it.
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
  Aabb box;              ///< bounding box in the bin frame
  int id = -1;           ///< id of the part; -1: the bin
  std::size_t line = 0;  ///< index into Request::parts
  bool movable = false;
  std::vector<Vec3> tops;  ///< movable parts: points spread over the upper side of the surface; bin frame
};

class PlacedParts {
 public:
  PlacedParts(const Scene& scene, const LoadedRequest& loaded);

  const std::vector<PlacedPart>& all() const { return all_; }  ///< parts in the order of the scene, then the bin
  const Vec3& up() const { return up_; }                       ///< unit vector against gravity, bin frame
  double top() const { return top_; }                          ///< m along up: highest point of all parts and the bin
  bool flat_floor() const { return flat_floor_; }              ///< whether the bin's floor is the plane z = 0
  /// Returns the id of the first part (-1: the bin) that a sweep hits, or none; tests all() in the order of the indices
  /// `order`. The endless floor is tested last.
  std::optional<int> met_by(const Sweep& sweep, const std::vector<std::size_t>& order) const;

 private:
  std::vector<PlacedPart> all_;
  std::unique_ptr<MeshQuery> walls_;
  bool floor_ = false, flat_floor_ = false;
  Vec3 up_ = Vec3::UnitZ();
  double top_ = 0.0;
};

/// Return the largest, and the smallest, coordinate of a box along a unit direction (m).
double highest(const Aabb& box, const Vec3& direction);
double lowest(const Aabb& box, const Vec3& direction);

}  // namespace bin_scenes
