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

/// One image of a scene. Row-major, width * height; optical frame of the sensor; NaN / 0 where nothing was seen.
struct RangeImage {
  Sensor sensor;                        ///< with pose and K filled in
  std::vector<float> depth;             ///< z along the optical axis (m); NaN = invalid
  std::vector<std::uint16_t> label;     ///< 0 = background or bin, part id + 1 otherwise
  std::vector<std::array<float, 3>> normal;  ///< of the surface, towards the camera; NaN = invalid
  std::vector<float> intensity;         ///< 0..1, cosine of incidence
  std::vector<std::size_t> visible, total;  ///< pixels per part id: seen, and seen if it were alone
};

/// Point of a pixel in the optical frame (m); NaN where depth is.
std::array<float, 3> point_at(const RangeImage& image, int column, int row);

/// Sensor with pose and K filled in: by default above the bin, looking down, the whole rim in view.
Sensor resolved(const Sensor& sensor, const Bin& bin);

class RangeCamera {
 public:
  /// Needs a GL device (gl/device.hpp); throws an environment Error without one.
  RangeCamera();
  ~RangeCamera();
  /// Renders every sensor of the request. Meshes are uploaded once per model and kept.
  std::vector<RangeImage> render(const Scene& scene, const Request& request, const std::vector<PartModelPtr>& parts,
                                 const PartModelPtr& bin_model = nullptr);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
