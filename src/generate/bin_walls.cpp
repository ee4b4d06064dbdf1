#include "generate/bin_walls.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

/// Height of the first triangle that a vertical line meets from above; -infinity if it meets none.
double first_from_above(const Mesh& mesh, double x, double y) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const auto twice_area = [&](const Vec3& p, const Vec3& q) {
      return (p.x() - x) * (q.y() - y) - (p.y() - y) * (q.x() - x);
    };
    const double of_a = twice_area(b, c), of_b = twice_area(c, a), of_c = twice_area(a, b), sum = of_a + of_b + of_c;
    const bool meets = sum != 0.0 && of_a / sum >= 0.0 && of_b / sum >= 0.0 && of_c / sum >= 0.0;
    if (meets) highest = std::max(highest, (of_a * a.z() + of_b * b.z() + of_c * c.z()) / sum);
  }
  return highest;
}

}  // namespace

void check_bin_walls(const PartModel& bin, const Request& request) {
  if (bin.load_report().closed || request.solver.type == SolverType::bullet) return;
  constexpr int columns = 7;       // along each axis, within the centre of the bin
  constexpr double beside = 1e-4;  // of the diagonal: just above the floor, and just below its top
  const Mesh mesh = transformed(bin.mesh(), request.bin.pose);
  const Aabb box = mesh.bounds();
  const Pose into_model = request.bin.pose.inverse();
  int floors = 0, sheets = 0;
  for (int i = 0; i < columns * columns; ++i) {
    const double u = 0.1 + 0.8 * (i % columns + 0.5) / columns, v = 0.1 + 0.8 * (i / columns + 0.5) / columns;
    const double x = box.lower.x() + u * box.size().x(), y = box.lower.y() + v * box.size().y();
    const double z = first_from_above(mesh, x, y), step = beside * box.diagonal();
    if (!std::isfinite(z)) continue;
    const auto solid = [&](double height) { return bin.query().inside(into_model * Vec3(x, y, height)); };
    ++floors;
    if (solid(z + step) || !solid(z - step)) ++sheets;
  }
  if (2 * sheets <= floors) return;
  throw input_error("the bin is a surface without thickness, and parts would fall through it", request.bin.mesh,
                    "give its walls a thickness in the modeller, use bin.inner_size, or solver.type: bullet");
}

}  // namespace bin_scenes
