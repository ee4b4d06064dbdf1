/// A scene for Python: the memory that the numpy arrays of the module share without copying. module.cpp declares the
/// Python classes; computed arrays are made on their first use.
#pragma once

#include "bin_scenes/generate/generator.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes::python {

/// An image with its organised cloud and the bytes of its picture, which are made on first use.
class ImageData {
 public:
  explicit ImageData(RangeImage made) : image(std::move(made)) {}
  RangeImage image;
  std::vector<std::array<float, 3>>& points();
  std::vector<std::array<float, 3>>& normals();
  /// Returns the counts of a picture of 8 bits, one byte per count.
  std::vector<std::uint8_t>& picture_bytes();
  bool has_gray() const;              ///< whether gray() may be called
  std::vector<std::uint8_t>& gray();  ///< grey levels that gray_of() returns

 private:
  std::mutex mutex_;
  std::vector<std::uint8_t> picture_bytes_, gray_;
  std::vector<std::array<float, 3>> points_, normals_;
};

/// Which data of a scene is made in addition to the poses.
struct Wanted {
  bool images = true, grasps = false, gray = false;
};

/// Throws an input Error if grasps are wanted, but the request has no grippers.
Generator::Options options_of(const Wanted& wanted, const Request& request, const std::string& caller);

struct SceneData {
  SceneData(Generator::Result&& result, std::shared_ptr<const LoadedRequest> request);

  Scene scene;
  std::optional<SceneGrasps> grasps;
  std::shared_ptr<const LoadedRequest> loaded;
  std::vector<std::shared_ptr<ImageData>> images;
  std::vector<std::array<double, 7>> poses;       ///< pose of each part: x y z (m), qx qy qz qw
  std::vector<std::array<double, 6>> velocities;  ///< velocity of each part: linear (m/s), angular (rad/s)
  std::vector<std::int32_t> ids, lines;           ///< id and part line of each part

  /// scene.json as the command line writes it; without images it has no block `truth`.
  std::string json() const;
  /// grasps.json as the command line writes it.
  std::string grasps_json() const;
};

}  // namespace bin_scenes::python
