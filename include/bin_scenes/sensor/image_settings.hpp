/// Settings of the sensor model `image`: a camera that takes grey or colour pictures in the light of lamps. The model
/// (src/sensor/models/image_model.cpp) traces paths of light through the scene; it measures no depth.
#pragma once

#include "bin_scenes/light/image_lamp.hpp"

#include <vector>

namespace bin_scenes {

/// All settings of the model. The struct is stored in Sensor::settings.
struct ImageSettings {
  std::vector<ImageLamp> lamps;  ///< empty: the light is one dome
  int samples = 8;               ///< number of light paths per pixel, a power of two; the cost is proportional to it
  bool denoise = false;          ///< whether Monte Carlo noise at low sample counts is removed
  bool colour = false;           ///< whether pictures have red, green and blue instead of grey
  int bits = 8;                  ///< bits per count in files and messages, 8 or 16
};

}  // namespace bin_scenes
