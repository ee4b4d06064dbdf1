/// A lamp of the sensor model `image`: its kind, place, size and brightness, as a request gives them. It holds the
/// values only; light/lamps.hpp computes the light.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <optional>
#include <string>

namespace bin_scenes {

/// A light source. The light of several lamps adds up, and a lamp itself casts no shadow.
struct ImageLamp {
  enum class Type {
    area,      ///< a rectangle that emits light to one side
    ring,      ///< a flat ring, or a disk if `inner` is 0, that emits light to one side
    dome,      ///< the sky: light from every direction that nothing blocks
    projector  ///< white light from Sensor::projector
  } type = Type::area;
  /// Area, ring: centre in the bin frame, with light leaving along z; none: the pose of the camera.
  std::optional<Pose> pose;
  /// Only the ratios between lamps matter. For a projector, it is the radiance of a white surface at 1 m.
  double radiance = 1.0;
  Vec3 colour = Vec3::Ones();  ///< factors of the radiance for red, green and blue
  double width = 0.3;          ///< area: size along x (m)
  double height = 0.3;         ///< area: size along y (m)
  double outer = 0.06;         ///< ring: outer radius (m)
  double inner = 0.045;        ///< ring: inner radius (m)
  double horizon = 0.5;        ///< dome: radiance at the horizon and below it / radiance at the zenith
  std::string picture;         ///< dome: file of an equirectangular image; none: a gradient from horizon to zenith
  std::string picture_sha256;  ///< digest of the bytes of that file that the reader saw; empty: not known
  double turn = 0.0;           ///< dome: rotation of the image about the vertical (rad)
};

}  // namespace bin_scenes
