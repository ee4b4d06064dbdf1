#include "grasp/finger_boxes.hpp"

#include "bin_scenes/core/error.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr int slices = 16;
constexpr double alike = 0.02;  ///< / extent: slices whose boxes differ by less share one
constexpr double misfit = 0.1;  ///< / pad length: largest distance of pad and tip from their nominal positions
constexpr double flat = 1e-9;   ///< / extent in z: rounding

/// Extends a box by the part of a triangle between two heights.
void extend_by_slice(Aabb& box, const std::array<Vec3, 3>& corners, double low, double high) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
    if (a.z() >= low && a.z() <= high) box.extend(a);
    for (const double height : {low, high}) {
      const double from = a.z() - height, to = b.z() - height;
      if ((from < 0.0) != (to < 0.0)) box.extend(Vec3(a + from / (from - to) * (b - a)));
    }
  }
}

bool nearly_same(const Aabb& a, const Aabb& b, double tolerance) {
  const Vec3 lower = a.lower - b.lower, upper = a.upper - b.upper;
  return std::max(lower.head<2>().cwiseAbs().maxCoeff(), upper.head<2>().cwiseAbs().maxCoeff()) <= tolerance;
}

void check_place(const Aabb& bounds, const Gripper& gripper, const std::string& key) {
  const double limit = misfit * gripper.pad_length;
  const auto refuse = [&](const char* what, double is, double should) {
    throw input_error(formatted("its %s is %.4g m, and should be %.4g m", what, is, should), key,
                      "move the mesh in its file, or set finger_mesh_scale or pad_length");
  };
  if (std::abs(bounds.lower.x()) > limit) refuse("smallest x", bounds.lower.x(), 0.0);
  const double tip = 0.5 * gripper.pad_length;
  if (std::abs(bounds.upper.z() - tip) > limit) refuse("largest z", bounds.upper.z(), tip);
}

}  // namespace

std::vector<Aabb> boxes_around(const Mesh& mesh, const Gripper& gripper, const std::string& key) {
  const Aabb bounds = mesh.bounds();
  check_place(bounds, gripper, key);
  const double step = bounds.size().z() / slices, tolerance = alike * bounds.size().head<2>().maxCoeff();
  std::vector<Aabb> boxes;
  for (int slice = 0; slice < slices; ++slice) {
    const double low = bounds.lower.z() + slice * step, high = slice + 1 < slices ? low + step : bounds.upper.z();
    Aabb box;
    for (const Triangle& t : mesh.triangles)
      extend_by_slice(box, {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]},
                      low - flat * bounds.size().z(), high + flat * bounds.size().z());
    if (box.empty()) continue;
    box.lower.z() = low;
    box.upper.z() = high;
    if (!boxes.empty() && nearly_same(boxes.back(), box, tolerance))
      boxes.back().extend(box);
    else
      boxes.push_back(box);
  }
  return boxes;
}

}  // namespace bin_scenes
