#pragma once

#include "sensor/models/structured_light.hpp"

namespace bin_scenes {

/// Four rays a pixel, through the middles of its quarters, and what they meet.
struct StructuredLight::Samples {
  static constexpr int per_pixel = 4;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  std::vector<SeenPoint> points;
  std::vector<Lit> lit;
  std::vector<char> mixed;  ///< by pixel: one of its rays meets a surface that the others do not
};

}  // namespace bin_scenes
