/// Reads the cloud of a sensor from the files of a finished scene, for the page of `view`. It uses whatever the scene
/// has: a cloud file, otherwise the depth image, and the true depth for the errors. Large clouds are thinned.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

struct ViewCloud {
  /// Points in the optical frame (m). A pixel without a measurement has its true depth, if that is known.
  std::vector<std::array<float, 3>> points;
  std::vector<std::uint16_t> labels;   ///< 0: background or bin; part id + 1 otherwise
  std::vector<std::uint8_t> validity;  ///< codes of scene/validity.hpp
  std::vector<float> errors;           ///< measured depth minus true depth (m); NaN: not known
  bool has_errors = false;
  std::string source;  ///< name of the file that was read; empty: there is none
};

/// Reads <sensor>.ply or <sensor>.pcd, otherwise the depth image; the truth is <sensor>_truth_depth.png. Returns about
/// `most` points or fewer, thinned evenly over the image. Throws an input Error if a file is damaged.
ViewCloud read_view_cloud(const std::string& folder, const Sensor& sensor, std::size_t most);

}  // namespace bin_scenes
