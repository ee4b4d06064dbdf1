/// Organised clouds as PCD and PLY files, with all fields.
#include "bin_scenes/output/scene_writer.hpp"
#include "output/cloud_point.hpp"
#include "output/png.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

namespace bin_scenes {

namespace {

struct Field {
  const char* pcd;   ///< name
  const char* ply;   ///< name, as viewers know it
  const char* type;  ///< of PLY
};
constexpr Field fields[] = {{"x", "x", "float"},
                            {"y", "y", "float"},
                            {"z", "z", "float"},
                            {"normal_x", "nx", "float"},
                            {"normal_y", "ny", "float"},
                            {"normal_z", "nz", "float"},
                            {"intensity", "intensity", "float"},
                            {"label", "label", "uint"},
                            {"validity", "validity", "uchar"},
                            {"truth_normal_x", "truth_nx", "float"},
                            {"truth_normal_y", "truth_ny", "float"},
                            {"truth_normal_z", "truth_nz", "float"},
                            {"snr", "snr", "float"}};

/// Position, then quaternion w x y z.
std::string pose_text(const Pose& pose) {
  const Vec3& p = pose.position;
  const Quat& q = pose.orientation;
  return formatted("%.9g %.9g %.9g %.9g %.9g %.9g %.9g", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
}

/// Tens of megabytes, not written twice; through write_bytes(), where a full disk is an error and no signal.
void write_points(const std::string& path, const std::string& header, const RangeImage& image) {
  const std::size_t size = header.size() + image.depth.size() * cloud_point::bytes;
  const std::unique_ptr<char[]> bytes(new char[size]);
  char* at = std::copy(header.begin(), header.end(), bytes.get());
  const std::vector<std::array<float, 3>> positions = points_of(image), normals = normals_of(image, positions);
  BIN_SCENES_ASSERT(positions.size() == image.depth.size() && normals.size() == positions.size());
  BIN_SCENES_ASSERT(image.label.size() == positions.size() && image.validity.size() == positions.size());
  BIN_SCENES_ASSERT(image.snr.size() == positions.size() && image.normal.size() == positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i, at += cloud_point::bytes) {
    const cloud_point::Measured point = {positions[i], normals[i], image.intensity[i], image.label[i]};
    std::memcpy(at, &point, sizeof point);
    at[cloud_point::validity_at] = static_cast<char>(image.validity[i]);
    std::memcpy(at + cloud_point::true_normal_at, &image.normal[i], sizeof(cloud_point::TrueNormal));
    std::memcpy(at + cloud_point::snr_at, &image.snr[i], sizeof(float));
  }
  write_bytes(path, bytes.get(), size);
}

}  // namespace

void write_pcd(const std::string& path, const RangeImage& image) {
  std::string names = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (const Field& field : fields) {
    const bool real = std::strcmp(field.type, "float") == 0, byte = std::strcmp(field.type, "uchar") == 0;
    names += std::string(" ") + field.pcd;
    sizes += byte ? " 1" : " 4";
    types += real ? " F" : " U";
    counts += " 1";
  }
  const std::string width = std::to_string(image.width), height = std::to_string(image.height);
  write_points(path,
               "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + names + "\n" + sizes + "\n" + types +
                   "\n" + counts + "\nWIDTH " + width + "\nHEIGHT " + height + "\nVIEWPOINT " +
                   pose_text(image.sensor.pose.value_or(Pose())) + "\nPOINTS " + std::to_string(image.depth.size()) +
                   "\nDATA binary\n",
               image);
}

void write_ply(const std::string& path, const RangeImage& image) {
  std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment optical frame of " + image.sensor.name +
      ", m; its pose in the bin frame, x y z qw qx qy qz: " + pose_text(image.sensor.pose.value_or(Pose())) +
      "\nobj_info num_cols " + std::to_string(image.width) + "\nobj_info num_rows " + std::to_string(image.height) +
      "\nelement vertex " + std::to_string(image.depth.size()) + "\n";
  for (const Field& field : fields) header += std::string("property ") + field.type + " " + field.ply + "\n";
  write_points(path, header + "end_header\n", image);
}

}  // namespace bin_scenes
