/// Settings of the sensor model `image`: a camera that takes grey or colour pictures in the light of lamps. The model
/// (src/sensor/models/image_model.cpp) traces paths of light through the scene; it measures no depth.
#pragma once

#include "bin_scenes/light/image_lamp.hpp"

#include <vector>

namespace bin_scenes {

/// All settings of the model. The struct is stored in Sensor::settings.
struct ImageSettings {
  std::vector<ImageLamp> lamps;  ///< none: one dome
  int samples = 16;      ///< paths of light per pixel, a power of two; more paths reduce the noise at linear cost
  bool denoise = false;  ///< whether Monte Carlo noise at low sample counts is removed
  bool colour = false;   ///< red, green and blue instead of grey
  int bits = 8;          ///< bits of a count in files and messages, 8 or 16
};

}  // namespace bin_scenes
