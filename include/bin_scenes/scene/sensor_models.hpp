/// Settings of the built-in sensor models: light sources, cameras and decoding. The placement and the lens of a sensor
/// are in Sensor (scene/request.hpp). The meaning, unit and range of each value, and the value that switches an effect
/// off, are in the tables of keys (docs/use/request.md). A sensor model of your own keeps its settings in its own file
/// (sensor/sensor_model.hpp). The key `noise: false` of a sensor switches all random effects off.
#pragma once

#include <vector>

namespace bin_scenes {

/// Treatment of a pixel whose footprint crosses a depth edge.
enum class MixedPixels {
  remove,  ///< the pixel becomes invalid with code 6, as if the filter of the device had found it
  keep     ///< the pixel keeps a depth between foreground and background
};

/// The image sensor of the camera. A signal is a share of the full-well capacity: 0 is dark, 1 is saturated.
struct ImagerSettings {
  double exposure = 0.8;
  double reference_distance = 0.0;
  double ambient = 0.02;
  double full_well = 10000.0;
  double read_noise = 5.0;
  double blur = 0.0;
  int bits = 12;
  std::vector<double> exposures;
};

/// Fringe projection: `steps` phase-shifted images, and a Gray code that identifies the period.
struct StructuredLightSettings {
  int steps = 8;
  double period = 16.0;
  int gray_bits = 0;
  double contrast = 0.95;
  double defocus = 0.7;
  double gamma = 1.0;
  double min_modulation = 0.004;
  MixedPixels mixed = MixedPixels::remove;
  double edge_step = 0.005;
};

/// Laser triangulation: a sheet of light, and a camera that finds the line in each column of its image.
struct LaserLineSettings {
  double fan = 0.9;
  double power = 0.5;
  double blur = 0.7;
  double speckle = 0.15;
  double min_signal = 0.02;
  enum class Peak { strongest, nearest } peak = Peak::strongest;  ///< which of two lines in one column is reported
};

/// Two cameras side by side. The second camera has the lens of the first and looks in the same direction, so that the
/// images are rectified.
struct StereoSettings {
  double baseline = 0.1;
  int disparities = 128;
  int window = 7;
  double dots = 0.12;
  int uniqueness = 10;
  double max_difference = 1.0;
  double min_texture = 1.0;
  int speckle_size = 60;
  double disparity_noise = 0.08;
  double min_signal = 0.02;
};

/// Time of flight with axial and lateral noise according to Fankhauser et al. 2015, "Kinect v2 for Mobile Robot
/// Navigation: Evaluation and Modeling". The default values are those of the paper for indoor use; its lateral noise
/// of 1.6 mm is 0.58 pixels of its camera at 1 m.
struct TimeOfFlightSettings {
  double axial = 0.001292;
  double axial_growth = 0.0003;
  double axial_distance = 0.8333;
  double axial_angle = 0.0001;
  double lateral = 0.58;
  double lateral_angle = 0.0;
  double albedo = 0.5;
  double min_signal = 0.01;
  MixedPixels mixed = MixedPixels::keep;
  double edge_step = 0.02;
  double modulation = 200.0;
};

}  // namespace bin_scenes
