/// Nodes of curved faces slide along the face to the point that is nearest to the other part or to the bin. This header
/// includes shaders/shared/sphere/slide.h as C++ and provides the functions that it requires.
#pragma once

#include "solver/sphere/passes/edge_contact.hpp"
#include "solver/sphere/world.hpp"

namespace bin_scenes::sphere {

inline float radius_of(const Samples& samples) {
  return samples.radius;
}
inline float face_spacing_of(const Samples& samples) {
  return samples.face_spacing;
}
inline float sag_of(const Samples& samples) {
  return samples.sag;
}

inline const Vec3f& normal_of(const Plane& plane) {
  return plane.normal;
}
inline float offset_of(const Plane& plane) {
  return plane.offset;
}
inline bool is_wall(const Plane& plane) {
  return plane.wall;
}

struct Solid {
  bool is_plane;
  const Field& field;
  Plane plane;
  float top;  ///< m: height at which walls end
};

inline Solid solid_of(const Field& field) {
  return {false, field, {}, 0};
}

#include "shared/sphere/slide.h"

}  // namespace bin_scenes::sphere
