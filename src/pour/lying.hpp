/// How parts lie on a table: the orientations in which they are stable, and free places around the bin.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/part/part_model.hpp"

#include <optional>
#include <vector>

namespace bin_scenes {

/// The orientations in which a part rests on a plane: it lies on a face of its convex hull, and its centre of mass is
/// above this face.
class LyingPoses {
 public:
  explicit LyingPoses(const PartModel& part);
  /// Returns the orientation that a part reaches if it is released in a random orientation and rolls slowly from face
  /// to face until one of them supports it. The rotation about the vertical is uniform.
  Quat draw(Random& random) const;

 private:
  struct Face {
    Vec3 normal;      ///< outward, model frame
    double distance;  ///< m, distance of its plane from the centre of mass
  };
  /// Returns the face through which a ray from the centre of mass leaves the hull.
  const Face& face_towards(const Vec3& direction) const;
  std::vector<Face> faces_;
};

/// The circle around a part as seen from above (bin frame).
struct Footprint {
  Eigen::Vector2d center;
  double radius;  ///< m
};
Footprint footprint(const PartModel& part, const Pose& pose);

/// Returns a pose of the model frame on the table. Its footprint is outside of the bin, at most `strip` (m) away from
/// it, and overlaps no other footprint. Returns none if no place was found.
/// @param bin  bounds of the bin
/// @param height  z of the table (m)
std::optional<Pose> place_on_table(const PartModel& part, const LyingPoses& lying, const Aabb& bin, double height,
                                   double strip, const std::vector<Footprint>& others, Random& random);

}  // namespace bin_scenes
