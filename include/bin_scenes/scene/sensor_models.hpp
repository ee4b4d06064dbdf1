/// Settings of the built-in sensor models beside geometry (Sensor in scene/request.hpp): what light and chip do. A
/// model of your own keeps its settings in its own file (sensor/sensor_model.hpp). Every effect can be switched off by
/// the value its comment names; `noise: false` of a sensor switches off all that are random.
#pragma once

#include <vector>

namespace bin_scenes {

/// Treatment of a pixel whose footprint crosses a depth edge.
enum class MixedPixels {
  remove,  ///< invalid, code 6: the device's filter finds it
  keep     ///< delivered: a point that flies between foreground and background
};

/// The chip of the camera. A signal is a share of the full well: 0 dark, 1 saturated.
struct ImagerSettings {
  double exposure = 0.8;  ///< signal of a white matte surface that faces the light at reference_distance; more = less
                          ///< noise on dark parts, and bright or shiny ones saturate
  double reference_distance = 0.0;  ///< m from the light; 0 = automatic exposure: for a white surface parallel to the
                                    ///< image at the median distance of what is lit
  double ambient = 0.02;            ///< signal of a white surface without the sensor's light; adds shot noise only.
                                    ///< laser_line sees none of it: a filter before its camera passes the laser
  double full_well = 10000.0;       ///< electrons at saturation; shot noise of a signal s is sqrt(s / full_well)
  double read_noise = 5.0;          ///< electrons, standard deviation; 0 = none
  double blur = 0.0;              ///< structured_light: camera pixels, standard deviation of the lens's blur; 0 = sharp
  int bits = 12;                  ///< of the analogue-digital converter, 1 to 16; fewer = coarser steps
  std::vector<double> exposures;  ///< structured_light, stereo: several instead of `exposure`, laser_line: of `power`,
                                  ///< ascending; of each pixel the longest counts that does not saturate
};

/// Fringe projection: a phase shift of `steps` images, periods told apart by a Gray code.
struct StructuredLightSettings {
  int steps = 8;           ///< images of the phase shift, at least 3; noise falls with the square root
  double period = 16.0;    ///< projector pixels a fringe; shorter = less noise, more Gray images, sooner blurred
  int gray_bits = 0;       ///< Gray-code images; 0 = as many as the projector's width needs, one more than the periods
  double contrast = 0.95;  ///< (white - black) / (white + black) of the projector
  double defocus = 0.7;    ///< standard deviation of the projector's blur, its pixels; 0 = sharp
  double gamma = 1.0;      ///< decoded: exponent of the projector's response that is left after calibration; 1 = linear
  double min_modulation = 0.004;  ///< amplitude / full well below which a pixel has too little signal (code 4)
  MixedPixels mixed = MixedPixels::remove;
  double edge_step = 0.005;  ///< m: depth step inside a pixel's footprint from which on it is a mixed pixel
};

/// A sheet of light and a camera that finds its line in every column.
struct LaserLineSettings {
  double fan = 0.9;          ///< rad, opening of the sheet about its z axis
  double power = 0.5;        ///< signal at the peak of a white matte surface that faces the laser; more = saturation
  double blur = 0.7;         ///< camera pixels, standard deviation of the lens's blur; adds to the line's width
  double speckle = 0.15;     ///< contrast of speckle in one pixel, 0 to 1; 0 = none. Moves the peak
  double min_signal = 0.02;  ///< peak signal below which a line is missing (code 4)
  enum class Peak { strongest, nearest } peak = Peak::strongest;  ///< which of two lines in a column is reported
};

/// Two cameras side by side; the second has the first one's lens and looks the same way (rectified).
struct StereoSettings {
  double baseline = 0.1;  ///< m along the camera's x; longer = less noise, more occlusion
  int disparities = 128;  ///< pixel, multiple of 16: what lies nearer than focal length * baseline / them is unmatched
  int window = 7;         ///< odd, pixel: the matcher's block; larger = less noise, rounder edges
  double dots = 0.12;     ///< share of the projector's pixels that are dots; 0 = no pattern, passive stereo
  int uniqueness = 10;    ///< %, by which the best match must beat the second; more = more holes, fewer outliers
  double max_difference = 1.0;    ///< pixel, left-right check; smaller = more holes, fewer outliers
  double min_texture = 1.0;       ///< grey levels of 255, standard deviation in a window, beyond noise, below which
                                  ///< nothing is matched
  int speckle_size = 60;          ///< pixel: smaller islands of disparity are removed; 0 = none
  double disparity_noise = 0.08;  ///< analytic: pixel at full signal, standard deviation
  double min_signal = 0.02;       ///< analytic: signal below which nothing is matched (code 8)
};

/// Axial and lateral noise after Nguyen, Izadi, Lovell 2012, "Modeling Kinect Sensor Noise for Improved 3D
/// Reconstruction and Tracking", whose figures are the defaults.
struct TimeOfFlightSettings {
  double axial = 0.0012;         ///< m, at axial_distance, facing
  double axial_growth = 0.0019;  ///< 1/m, times (z - axial_distance) squared
  double axial_distance = 0.4;   ///< m
  double axial_angle = 0.0001;   ///< m^1.5, times t^2 / (pi/2 - t)^2 / sqrt(z), t the angle of incidence
  double lateral = 0.8;          ///< pixel, jitter of the ray; moves edges, never a plane
  double lateral_angle = 0.035;  ///< pixel, times t / (pi/2 - t)
  double albedo = 0.5;           ///< for which the figures hold; axial noise goes with sqrt(albedo / signal). 0 = same
                                 ///< noise for all
  double min_signal = 0.01;      ///< share of a white facing surface's at 1 m below which nothing is measured (code 4)
  MixedPixels mixed = MixedPixels::keep;
  double edge_step = 0.02;    ///< m: depth step inside a pixel's footprint from which on it is a mixed pixel
  double modulation = 200.0;  ///< MHz, of the light's brightness: by which light of several ways is mixed. Depth
                              ///< repeats after 150 m / it; devices tell the turns apart by further frequencies
};

}  // namespace bin_scenes
