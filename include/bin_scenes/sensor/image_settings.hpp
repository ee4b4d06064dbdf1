/// Settings of the model `image`: a camera that takes grey or colour images by the light of lamps.
#pragma once

#include "bin_scenes/core/types.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// A light source of an image. The light of several lamps adds up, and a lamp itself casts no shadow.
struct ImageLamp {
  enum class Type {
    area,      ///< a rectangle that shines to one side
    ring,      ///< a flat ring, or a disk if `inner` is 0, that shines to one side
    dome,      ///< the sky: light from everywhere that nothing blocks
    projector  ///< white light of Sensor::projector
  } type = Type::area;
  std::optional<Pose> pose;    ///< area, ring: centre in the bin frame, light leaves along z; none: the camera's
  double radiance = 1.0;       ///< only ratios between lamps count; of a projector that of a white surface at 1 m
  Vec3 colour = Vec3::Ones();  ///< times radiance, of red, green and blue
  double width = 0.3;          ///< area: m along x
  double height = 0.3;         ///< area: m along y
  double outer = 0.06;         ///< ring: radius (m)
  double inner = 0.045;        ///< ring: radius (m)
  double horizon = 0.5;        ///< dome: radiance at the horizon and below it / that of the zenith
  std::string picture;         ///< dome: file of an equirectangular picture; none: even from horizon to zenith
  std::string picture_sha256;  ///< picture: of the file's bytes as the reader saw them; empty: not known
  double turn = 0.0;           ///< dome: rad, of the picture about the vertical
};

/// Kept in Sensor::settings.
struct ImageSettings {
  std::vector<ImageLamp> lamps;  ///< none: a dome
  int samples = 16;              ///< paths of light a pixel, a power of two; more = less grain, linear cost
  bool denoise = false;          ///< takes the grain of few samples out
  bool colour = false;           ///< red, green and blue instead of grey
  int bits = 8;                  ///< of a count in files and messages, 8 or 16
};

}  // namespace bin_scenes
