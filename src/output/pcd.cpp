/// The one file that sees PCL outside the ROS rim.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "output/png.hpp"

#ifdef BIN_SCENES_HAS_PCL
#include <pcl/io/pcd_io.h>

#include <cstring>
#endif

namespace bin_scenes {

#ifdef BIN_SCENES_HAS_PCL

namespace {

/// A point as it lies in the file; no padding.
struct Point {
  float x, y, z, normal_x, normal_y, normal_z, intensity;
  std::uint32_t label;
};
static_assert(sizeof(Point) == 32, "one point is 32 bytes in the file");

pcl::PCLPointCloud2 cloud_of(const RangeImage& image) {
  pcl::PCLPointCloud2 cloud;
  cloud.width = image.sensor.width;
  cloud.height = image.sensor.height;
  cloud.is_dense = false;
  cloud.point_step = sizeof(Point);
  cloud.row_step = cloud.width * cloud.point_step;
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity", "label"}) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = offset;
    field.count = 1;
    field.datatype = field.name == "label" ? pcl::PCLPointField::UINT32 : pcl::PCLPointField::FLOAT32;
    cloud.fields.push_back(field);
    offset += 4;
  }
  cloud.data.resize(static_cast<std::size_t>(cloud.row_step) * cloud.height);
  for (int row = 0; row < image.sensor.height; ++row) {
    for (int column = 0; column < image.sensor.width; ++column) {
      const std::size_t i = static_cast<std::size_t>(row) * image.sensor.width + column;
      const auto [x, y, z] = point_at(image, column, row);
      const auto& n = image.normal[i];
      const Point point = {x, y, z, n[0], n[1], n[2], image.intensity[i], image.label[i]};
      std::memcpy(&cloud.data[i * sizeof(Point)], &point, sizeof(Point));
    }
  }
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
  const pcl::PCLPointCloud2 cloud = cloud_of(image);
  std::string bytes =
      pcl::PCDWriter().generateHeaderBinary(cloud, origin, pose.orientation.cast<float>()) + "DATA binary\n";
  bytes.append(cloud.data.begin(), cloud.data.end());
  write_bytes(path, bytes.data(), bytes.size());
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
