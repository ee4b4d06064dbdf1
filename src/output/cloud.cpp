/// The one file that sees PCL outside the ROS rim.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "output/png.hpp"

#ifdef BIN_SCENES_HAS_PCL
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <cstring>
#include <memory>
#endif

namespace bin_scenes {

#ifdef BIN_SCENES_HAS_PCL

namespace {

/// A point as it lies in the file; no padding.
struct Point {
  std::array<float, 3> position, normal;
  float intensity;
  std::uint32_t label;
};
static_assert(sizeof(Point) == 32, "before its validity, one byte, a point is 32 bytes in the file");
constexpr std::size_t point_bytes = sizeof(Point) + 1;

pcl::PCLPointCloud2 header_of(const RangeImage& image) {
  pcl::PCLPointCloud2 cloud;
  cloud.width = image.width;
  cloud.height = image.height;
  cloud.is_dense = false;
  cloud.point_step = point_bytes;
  cloud.row_step = cloud.width * cloud.point_step;
  std::uint32_t offset = 0;
  const auto add = [&](const char* name, std::uint8_t type, std::uint32_t size) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = offset;
    field.count = 1;
    field.datatype = type;
    cloud.fields.push_back(field);
    offset += size;
  };
  for (const char* name : {"x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity"}) {
    add(name, pcl::PCLPointField::FLOAT32, 4);
  }
  add("label", pcl::PCLPointField::UINT32, 4);
  add("validity", pcl::PCLPointField::UINT8, 1);
  return cloud;
}
}  // namespace

bool pcd_supported() {
  return true;
}

void write_pcd(const std::string& path, const RangeImage& image) {
  const Pose pose = image.sensor.pose.value_or(Pose());
  Eigen::Vector4f origin(0, 0, 0, 1);
  origin.head<3>() = pose.position.cast<float>();
  // Only the header by PCL's hand: it writes files through a mapping, where a full disk is a signal and no error.
  const std::string header =
      pcl::PCDWriter().generateHeaderBinary(header_of(image), origin, pose.orientation.cast<float>()) + "DATA binary\n";
  const std::size_t points = image.depth.size(), size = header.size() + points * point_bytes;
  const std::unique_ptr<char[]> bytes(new char[size]);  // tens of megabytes: not written twice
  char* at = std::copy(header.begin(), header.end(), bytes.get());
  const std::vector<std::array<float, 3>> positions = points_of(image), normals = normals_of(image, positions);
  for (std::size_t i = 0; i < points; ++i, at += point_bytes) {
    const Point point = {positions[i], normals[i], image.intensity[i], image.label[i]};
    std::memcpy(at, &point, sizeof(Point));
    at[sizeof(Point)] = static_cast<char>(image.validity[i]);
  }
  write_bytes(path, bytes.get(), size);
}

#else

bool pcd_supported() {
  return false;
}

void write_pcd(const std::string& path, const RangeImage&) {
  throw environment_error("this build has no PCL and writes no PCD", path,
                          "build with -DBIN_SCENES_PCL=ON, or leave format pcd out");
}

#endif

}  // namespace bin_scenes
