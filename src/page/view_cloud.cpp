#include "page/view_cloud.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/range_image.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "core/read_file.hpp"
#include "output/cloud_point.hpp"
#include "output/png_reader.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();
const char* const make_anew = "make the scene anew: generate --overwrite";

/// All pixels, before they are thinned.
struct Organised {
  std::size_t width = 0, height = 0;
  std::vector<std::array<float, 3>> points;
  std::vector<std::uint16_t> labels;
  std::vector<std::uint8_t> validity;
};

/// The number behind `word` in the header of a cloud.
std::size_t number_after(const std::string& header, const std::string& word, const std::string& path) {
  const std::size_t at = header.find("\n" + word + " ");
  std::size_t number = 0;
  if (at == std::string::npos || !(std::istringstream(header.substr(at + word.size() + 2, 12)) >> number) ||
      number > 65'536)
    throw input_error("its header has no '" + word + "'", path, make_anew);
  return number;
}

/// A file of output/cloud.cpp.
Organised read_cloud(const std::string& path, bool ply) {
  const std::string bytes = read_file(path), end = ply ? "end_header\n" : "DATA binary\n";
  const std::size_t header = bytes.find(end);
  if (header == std::string::npos) throw input_error("is no cloud that bin_scenes wrote", path, make_anew);
  const std::string head = bytes.substr(0, header);
  Organised cloud;
  cloud.width = number_after(head, ply ? "obj_info num_cols" : "WIDTH", path);
  cloud.height = number_after(head, ply ? "obj_info num_rows" : "HEIGHT", path);
  const std::size_t size = cloud.width * cloud.height;
  if (bytes.size() != header + end.size() + size * cloud_point::bytes)
    throw input_error("is cut off, or no cloud that bin_scenes wrote", path, make_anew);
  cloud.points.resize(size);
  cloud.labels.resize(size);
  cloud.validity.resize(size);
  const char* at = bytes.data() + header + end.size();
  for (std::size_t i = 0; i < size; ++i, at += cloud_point::bytes) {
    cloud_point::Measured point;
    std::memcpy(&point, at, sizeof point);
    cloud.points[i] = point.position;
    cloud.labels[i] = static_cast<std::uint16_t>(point.label);
    cloud.validity[i] = static_cast<std::uint8_t>(at[cloud_point::validity_at]);
  }
  return cloud;
}

/// A grey image of the camera; empty if it is not there.
LoadedImage read_image(const fs::path& path, std::size_t width, std::size_t height) {
  std::error_code missing;
  if (!fs::is_regular_file(path, missing)) return {};
  LoadedImage image = load_png(path.string());
  if (width != 0 && image.samples.size() != width * height)
    throw input_error("has another size than the depth image", path.string(), make_anew);
  return image;
}

/// Points on the rays of the pixels; NaN where the depth image has 0.
std::vector<std::array<float, 3>> on_rays(const Sensor& sensor, const LoadedImage& counts) {
  RangeImage image;
  image.sensor = sensor;
  image.width = counts.width;
  image.height = counts.height;
  for (const std::uint16_t count : counts.samples)
    image.depth.push_back(count == 0 ? no_value : static_cast<float>(count * sensor.depth_scale));
  return points_of(image);
}

Organised read_images(const fs::path& base, const Sensor& sensor) {
  const LoadedImage depth = read_image(base.string() + "_depth.png", 0, 0);
  Organised cloud;
  cloud.width = static_cast<std::size_t>(depth.width);
  cloud.height = static_cast<std::size_t>(depth.height);
  cloud.points = on_rays(sensor, depth);
  const LoadedImage labels = read_image(base.string() + "_labels.png", cloud.width, cloud.height),
                    validity = read_image(base.string() + "_validity.png", cloud.width, cloud.height);
  cloud.labels = labels.samples;
  cloud.labels.resize(cloud.points.size());
  cloud.validity.assign(validity.samples.begin(), validity.samples.end());
  cloud.validity.resize(cloud.points.size());
  return cloud;
}

}  // namespace

ViewCloud read_view_cloud(const std::string& folder, const Sensor& sensor, std::size_t most) {
  const fs::path base = fs::path(folder) / sensor.name;
  const auto there = [&](const char* ending) {
    std::error_code missing;
    return fs::is_regular_file(base.string() + ending, missing);
  };
  const bool on_pixels = !sensor_model(sensor.model).laser;  // else an image of profiles
  ViewCloud view;
  Organised all;
  for (const char* ending : {".ply", ".pcd", "_depth.png"}) {
    if (!there(ending) || (std::strcmp(ending, "_depth.png") == 0 && !on_pixels)) continue;
    view.source = sensor.name + ending;
    all = std::strcmp(ending, "_depth.png") == 0 ? read_images(base, sensor)
                                                 : read_cloud(base.string() + ending, std::strcmp(ending, ".ply") == 0);
    break;
  }
  if (view.source.empty()) return view;

  std::vector<std::array<float, 3>> truth(all.points.size(), {no_value, no_value, no_value});
  view.has_errors = on_pixels && there("_truth_depth.png");
  if (view.has_errors) truth = on_rays(sensor, read_image(base.string() + "_truth_depth.png", all.width, all.height));

  std::size_t step = 1;
  while (all.width * all.height / (step * step) > most) ++step;
  for (std::size_t row = 0; row < all.height; row += step) {
    for (std::size_t i = row * all.width; i < (row + 1) * all.width; i += step) {
      const bool measured = std::isfinite(all.points[i][2]);
      const std::array<float, 3>& point = measured ? all.points[i] : truth[i];
      if (!std::isfinite(point[2])) continue;
      view.points.push_back(point);
      view.labels.push_back(all.labels[i]);
      view.validity.push_back(all.validity[i]);
      view.errors.push_back(measured ? all.points[i][2] - truth[i][2] : no_value);
    }
  }
  return view;
}

}  // namespace bin_scenes
