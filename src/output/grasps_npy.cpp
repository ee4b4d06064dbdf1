/// <sensor>_grasps.npy, as GraspGroup.from_npy of graspnetAPI reads it.
///
/// A row: score, width, height, depth, rotation by rows, translation, object. The gripper's x is the approach there,
/// its y the closing direction; the fingers end at `depth` along x.
#include "bin_scenes/output/scene_writer.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

constexpr int grasp_columns = 17;

/// Of labels that are loaded: the smaller the friction that holds, the higher.
constexpr double score_without_friction = 1.1;

using Row = Eigen::Matrix<float, 1, grasp_columns>;

Row row_of(const SceneGrasp& grasp, const Gripper& gripper, const Pose& into_camera) {
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

/// numpy's format, version 1.0: the data begin at a multiple of 64 bytes.
std::string npy_header(std::size_t rows) {
  std::string facts = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ", " +
                      std::to_string(grasp_columns) + "), }";
  constexpr std::size_t before = 10;
  while ((before + facts.size() + 1) % 64 != 0) facts += ' ';
  facts += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(facts.size() & 0xffu);
  header += static_cast<char>(facts.size() >> 8);
  return header + facts;
}

}  // namespace

std::string grasps_npy(const SceneGrasps& grasps, const Sensor& sensor, const Request& request) {
  const Pose into_camera = sensor.pose.value_or(Pose()).inverse();
  std::string rows;
  std::size_t count = 0;
  for (const SceneGrasp& grasp : grasps.grasps) {
    const Gripper& gripper = request.grippers[grasp.gripper];
    if (!grasp.free() || gripper.type != Gripper::Type::parallel) continue;
    const Row row = row_of(grasp, gripper, into_camera);
    rows.append(reinterpret_cast<const char*>(row.data()), grasp_columns * sizeof(float));
    ++count;
  }
  return npy_header(count) + rows;
}

}  // namespace bin_scenes
