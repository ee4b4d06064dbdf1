/// Targets for measuring a sensor: plates, steps and balls of known shape, placed in an otherwise empty world.
/// metrics.hpp and the benchmarks of sensors use them; requests cannot contain them.
#pragma once

#include "bin_scenes/raster/scenery.hpp"
#include "light/illumination.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

/// Returns a box that is centred on the origin. @param size  lengths of its edges (m)
Mesh box_target(const Vec3& size);
/// Returns a ball around the origin: an icosahedron that is subdivided `level` times (20 * 4^level triangles), whose
/// mean radius over the surface is `radius` (m). At level 6, its facets deviate from the sphere by 4e-5 of the radius.
Mesh ball_target(double radius, int level = 6);

class Targets {
 public:
  /// Adds a target. @param pose  pose of the mesh in the world; the world frame is the bin frame of the sensors
  void add(const Mesh& mesh, const Pose& pose, const Surface& surface = {});
  void set_table(const Table& table) { request_.table = surfaces_.table = table; }
  Scenery scenery();
  const Surfaces& surfaces() const { return surfaces_; }
  const Request& request() const { return request_; }

 private:
  Request request_;
  Scene scene_;
  std::vector<PartModelPtr> models_;
  std::unique_ptr<SceneryCache> cache_ = std::make_unique<SceneryCache>();  // on the heap: stays in place if this moves
  Surfaces surfaces_;
};

}  // namespace bin_scenes
