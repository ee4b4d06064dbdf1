#include "bin_scenes/part/mass_properties.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <Eigen/Eigenvalues>

namespace bin_scenes {

MassProperties mass_properties(const Mesh& mesh) {
  MassProperties result;
  BIN_SCENES_ASSERT(indices_in_range(mesh));
  // Signed tetrahedra between each triangle and one apex. The apex is free for a closed mesh; the centre of the
  // bounding box keeps the sums small when the part lies far from the origin of its file.
  const Vec3 apex = mesh.empty() ? Vec3(Vec3::Zero()) : mesh.bounds().center();
  double volume6 = 0.0;           // six times the volume
  Vec3 first24 = Vec3::Zero();    // 24 times the integral of x
  Mat3 second120 = Mat3::Zero();  // 120 times the integral of x x^T
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Vec3 a = mesh.vertices[ia] - apex, b = mesh.vertices[ib] - apex, c = mesh.vertices[ic] - apex;
    const Vec3 sum = a + b + c;
    const double determinant = a.dot(b.cross(c));
    volume6 += determinant;
    first24 += determinant * sum;
    second120 += determinant * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    result.area += 0.5 * (b - a).cross(c - a).norm();
  }
  result.volume = volume6 / 6.0;
  BIN_SCENES_ASSERT(std::isfinite(result.volume) && result.area >= 0.0);
  if (result.volume == 0.0) {
    result.center = apex;
    return result;
  }
  const Vec3 offset = first24 / (4.0 * volume6);
  const Mat3 covariance = second120 / 120.0 - result.volume * offset * offset.transpose();
  result.center = apex + offset;
  result.inertia = covariance.trace() * Mat3::Identity() - covariance;

  const Eigen::SelfAdjointEigenSolver<Mat3> solver(result.inertia);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  result.principal = solver.eigenvalues();
  result.principal_axes = Quat(axes).normalized();
  BIN_SCENES_ASSERT(result.center.allFinite() && is_unit(result.principal_axes));
  BIN_SCENES_ASSERT(result.volume < 0.0 || result.principal[0] <= result.principal[2]);
  return result;
}

}  // namespace bin_scenes
