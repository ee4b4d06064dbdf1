/// <sensor>_grasps_<gripper>.npy, as GraspGroup.from_npy of graspnetAPI reads it, or SuctionGroup.from_npy of
/// suctionnetAPI.
///
/// A row for two fingers: score, width, height, depth, rotation by rows, translation, object. The gripper's x is the
/// approach there, its y the closing direction; the fingers end at `depth` along x. A row for a cup: score, direction
/// away from the part, translation, object.
#include "bin_scenes/output/scene_writer.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

constexpr int grasp_columns = 17, suction_columns = 8;

/// Of labels that are loaded: the smaller the friction that holds, the higher.
constexpr double score_without_friction = 1.1;

template <int columns>
using Row = Eigen::Matrix<float, 1, columns>;

Row<grasp_columns> row_of_fingers(const SceneGrasp& grasp, const Gripper& gripper, const Pose& into_camera) {
  const Pose pose = into_camera * grasp.pose;
  const Eigen::Matrix3d own = pose.orientation.toRotationMatrix();
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> axes;
  axes << own.col(2), own.col(0), own.col(1);
  const double opened = std::min(gripper.travel(), grasp.width + 2.0 * gripper.opening);
  Eigen::Matrix<double, 1, grasp_columns> row;
  row << score_without_friction - grasp.friction, opened, gripper.finger_width, 0.5 * gripper.pad_length,
      Eigen::Map<const Eigen::Matrix<double, 1, 9>>(axes.data()), pose.position.transpose(), grasp.part;
  return row.cast<float>();
}

Row<suction_columns> row_of_cup(const SceneGrasp& grasp, const Pose& into_camera) {
  const Pose pose = into_camera * grasp.pose;
  const Vec3 away = -(pose.orientation * Vec3::UnitZ());
  Eigen::Matrix<double, 1, suction_columns> row;
  row << grasp.score, away.transpose(), pose.position.transpose(), grasp.part;
  return row.cast<float>();
}

/// numpy's format, version 1.0: the data begin at a multiple of 64 bytes.
std::string npy_header(std::size_t rows, int columns) {
  std::string facts = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ", " +
                      std::to_string(columns) + "), }";
  constexpr std::size_t before = 10;
  while ((before + facts.size() + 1) % 64 != 0) facts += ' ';
  facts += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(facts.size() & 0xffu);
  header += static_cast<char>(facts.size() >> 8);
  return header + facts;
}

}  // namespace

std::string grasps_npy(const SceneGrasps& grasps, const Sensor& sensor, const Request& request, std::size_t gripper) {
  const Pose into_camera = sensor.pose.value_or(Pose()).inverse();
  const Gripper& shape = request.grippers.at(gripper);
  const bool fingers = shape.type == Gripper::Type::parallel;
  std::string rows;
  std::size_t count = 0;
  const auto append = [&](const auto& row) {
    rows.append(reinterpret_cast<const char*>(row.data()), static_cast<std::size_t>(row.size()) * sizeof(float));
    ++count;
  };
  for (const SceneGrasp& grasp : grasps.grasps) {
    if (grasp.gripper != gripper || !grasp.free() || grasp.inner) continue;
    if (fingers)
      append(row_of_fingers(grasp, shape, into_camera));
    else
      append(row_of_cup(grasp, into_camera));
  }
  return npy_header(count, fingers ? grasp_columns : suction_columns) + rows;
}

std::string file_name_of(const Gripper& gripper) {
  std::string name = gripper.name;
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '-' && c != '.' && c != '_') c = '_';
  }
  return name;
}

}  // namespace bin_scenes
