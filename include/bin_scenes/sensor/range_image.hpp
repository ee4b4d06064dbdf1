/// The image that a range sensor delivers of a scene, together with the truth without errors. Sensor models fill it,
/// filters change its measured part, and output and ROS publish it.
#pragma once

#include "bin_scenes/raster/silhouettes.hpp"
#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/scene/validity.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace bin_scenes {

/// A picture of a camera: counts in row-major order, with the channels of a pixel next to each other.
struct Picture {
  int channels = 0;  ///< 1: grey; 3: red, green, blue; 0: no picture was taken
  int bits = 8;      ///< bits of a count, 8 or 16
  std::vector<std::uint16_t> counts;
};

/// Row-major images in the optical frame of the sensor's camera. Integer coordinates are pixel centres, as in
/// CameraInfo.
struct RangeImage {
  Sensor sensor;                 ///< with poses and camera matrix filled in
  std::optional<Sensor> device;  ///< the true device, whose view the true images show; none: it equals `sensor`,
                                 ///< because there are no calibration errors
  const Sensor& true_sensor() const { return device ? *device : sensor; }
  int width = 0, height = 0;  ///< size of the measured images: that of the camera; for laser_line, columns and profiles

  // Measured images. NaN or 0 marks pixels that are not valid.
  std::vector<float> depth;                  ///< z along the optical axis (m); NaN where not valid
  std::vector<std::uint16_t> label;          ///< 0 for background and bin, part id + 1 otherwise
  std::vector<float> intensity;              ///< 0..1; for the model `ideal`, the cosine of the incidence angle
  std::vector<std::uint8_t> gray;            ///< levels of the grey image (gray_image.hpp); empty: gray_of() makes them
  std::vector<float> snr;                    ///< signal / predicted standard deviation of its noise
  std::vector<std::uint8_t> validity;        ///< values of Validity
  Picture picture;                           ///< the picture of the model `image`
  std::vector<std::array<float, 3>> points;  ///< measured points (m), if they are not on the rays of their pixels

  /// The true normal of the surface that a pixel sees, whether it was measured or not, pointing towards the camera; NaN
  /// if the pixel sees nothing.
  std::vector<std::array<float, 3>> normal;

  // True images of the camera's own view, sensor.width * sensor.height. An image is empty if it equals the measured
  // one.
  std::vector<float> truth_depth;
  std::vector<std::uint16_t> truth_label;
  std::vector<std::array<float, 3>> truth_normal;
  /// These functions return the true images, wherever they are stored.
  const std::vector<float>& seen_depth() const { return truth_depth.empty() ? depth : truth_depth; }
  const std::vector<std::array<float, 3>>& seen_normal() const { return truth_normal.empty() ? normal : truth_normal; }
  const std::vector<std::uint16_t>& seen_label() const { return truth_label.empty() ? label : truth_label; }

  std::vector<std::size_t> visible,
      total;  ///< by part id: true number of visible pixels, and number without occlusion by other parts
  std::vector<Silhouette> silhouettes;  ///< by part id: the pixels that are counted in `total`
};

/// Returns the measured points of all pixels in the optical frame (m); NaN where the depth is NaN. It uses all cores,
/// because removing the distortion of a lens is expensive.
std::vector<std::array<float, 3>> points_of(const RangeImage& image);
/// Returns unit normals of points_of(image) that point towards the camera. They are normals of planes through the
/// points of neighbouring pixels, as drivers of real sensors compute them; for the model `ideal`, which measures
/// exactly, they are the true normals. A normal is NaN where the depth is NaN, and where too few neighbours are on one
/// surface.
std::vector<std::array<float, 3>> normals_of(const RangeImage& image, const std::vector<std::array<float, 3>>& points);

}  // namespace bin_scenes
