/// The image that a range sensor delivers of a scene, with the noise-free truth.
#pragma once

#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/sensor/silhouettes.hpp"
#include "bin_scenes/sensor/validity.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace bin_scenes {

/// A picture of a camera: counts, row-major, the channels of a pixel beside each other.
struct Picture {
  int channels = 0;  ///< 1: grey; 3: red, green, blue; 0: none was taken
  int bits = 8;      ///< 8 or 16 a count
  std::vector<std::uint16_t> counts;
};

/// Row-major images. Optical frame of the sensor's camera; integer coordinates are pixel centres, as in CameraInfo.
struct RangeImage {
  Sensor sensor;                 ///< with poses and K filled in
  std::optional<Sensor> device;  ///< as it truly is, whose view the truth is; none: `sensor`, which has no such errors
  const Sensor& true_sensor() const { return device ? *device : sensor; }
  int width = 0, height = 0;  ///< of what was measured: the camera's, but for laser_line columns and profiles

  // Measured; NaN / 0 where it is not valid.
  std::vector<float> depth;                  ///< z along the optical axis (m); NaN = invalid
  std::vector<std::uint16_t> label;          ///< 0 = background or bin, part id + 1 otherwise
  std::vector<float> intensity;              ///< 0..1; of the ideal model the cosine of incidence
  std::vector<float> snr;                    ///< signal / standard deviation of the noise that the model predicts there
  std::vector<std::uint8_t> validity;        ///< of Validity
  Picture picture;                           ///< of the model `image`
  std::vector<std::array<float, 3>> points;  ///< measured points (m), if they do not lie on the rays of their pixels

  /// True normal of what a pixel sees, measured or not, towards the camera; NaN = nothing there.
  std::vector<std::array<float, 3>> normal;

  // True, of the camera's own view, sensor.width * sensor.height; empty where it equals what stands above.
  std::vector<float> truth_depth;
  std::vector<std::uint16_t> truth_label;
  std::vector<std::array<float, 3>> truth_normal;
  const std::vector<float>& seen_depth() const { return truth_depth.empty() ? depth : truth_depth; }
  const std::vector<std::array<float, 3>>& seen_normal() const { return truth_normal.empty() ? normal : truth_normal; }
  const std::vector<std::uint16_t>& seen_label() const { return truth_label.empty() ? label : truth_label; }

  std::vector<std::size_t> visible, total;  ///< true pixels per part id: seen, and seen if it were alone
  std::vector<Silhouette> silhouettes;      ///< by part id: the pixels of `total`
};

/// Measured point of a pixel in the optical frame (m); NaN where depth is.
std::array<float, 3> point_at(const RangeImage& image, int column, int row);
/// The same for a whole image, on all cores, because removing the distortion of a lens is expensive.
std::vector<std::array<float, 3>> points_of(const RangeImage& image);
/// Normals of points_of(image), towards the camera: of planes through the points of neighbouring pixels, as drivers of
/// real sensors compute them; of the ideal model, which measures exactly, the true ones. NaN where depth is, and where
/// too few neighbours lie on one surface.
std::vector<std::array<float, 3>> normals_of(const RangeImage& image, const std::vector<std::array<float, 3>>& points);

}  // namespace bin_scenes
