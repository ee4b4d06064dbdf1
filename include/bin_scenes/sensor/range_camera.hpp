/// What a range camera sees of a scene: depth and part id per pixel, rendered through EGL, and the organised cloud.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

/// Pinhole model: the point (x, y, z) of the optical frame falls on column k0 x/z + k1 y/z + k2 and row k4 y/z + k5 of
/// the row-major K. Integer coordinates are pixel centres, as in CameraInfo; each pixel looks along the one ray through
/// its centre (no anti-aliasing, so no points between near and far surfaces).
///
/// One image of a scene. Row-major, width * height; optical frame of the sensor; NaN / 0 where nothing was seen.
struct RangeImage {
  Sensor sensor;                             ///< with pose and K filled in
  std::vector<float> depth;                  ///< z along the optical axis (m); NaN = invalid
  std::vector<std::uint16_t> label;          ///< 0 = background or bin, part id + 1 otherwise
  std::vector<std::array<float, 3>> normal;  ///< of the surface, towards the camera; NaN = invalid
  std::vector<float> intensity;              ///< 0..1, cosine of incidence
  std::vector<std::size_t> visible, total;   ///< pixels per part id: seen, and seen if it were alone
  std::vector<std::vector<bool>> silhouette;  ///< by part id: the pixels of `total`; empty unless asked for, and for parts
                                              ///< that are not there
};

/// Point of a pixel in the optical frame (m); NaN where depth is.
std::array<float, 3> point_at(const RangeImage& image, int column, int row);

/// Sensor with pose and K filled in: by default above the middle of the bin, looking down (image right = bin x, image
/// up = bin y), the whole rim in view with a margin of 5 %. `bounds` of a mesh bin in the bin frame; a bin without
/// rim is taken for a floor of Bin::inner_size. Throws an input Error if K or the range make no sense.
Sensor resolved(const Sensor& sensor, const Bin& bin, const Aabb* bounds = nullptr);

class RangeCamera {
 public:
  /// Needs a GL device (gl/device.hpp); throws an environment Error without one.
  RangeCamera();
  ~RangeCamera();
  /// Renders every sensor of the request. Meshes are uploaded once per model and kept while the model lives. Parts
  /// that were not poured or whose pose is not finite are not there. The same scene gives the same bits each time.
  /// @param silhouettes  also RangeImage::silhouette, which costs one more image a part.
  std::vector<RangeImage> render(const Scene& scene, const Request& request, const std::vector<PartModelPtr>& parts,
                                 const PartModelPtr& bin_model = nullptr, bool silhouettes = false);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
