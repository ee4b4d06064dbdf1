#include "light/lobe.hpp"

#include "light/illumination.hpp"
#include "light/unit_circle.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// Two axes beside a unit vector z, without a branch that flips them between neighbours (Duff et al. 2017, "Building an
/// orthonormal basis, revisited").
Mat3 frame_about(const Vec3& z) {
  const double sign = z.z() < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + z.z()), b = z.x() * z.y() * a;
  Mat3 frame;
  frame.col(0) = Vec3(1.0 + sign * z.x() * z.x() * a, sign * b, -sign * z.x());
  frame.col(1) = Vec3(b, sign + z.y() * z.y() * a, -z.y());
  frame.col(2) = z;
  return frame;
}

}  // namespace

Lobe::Lobe(const Surface& surface, const Vec3& normal, const Vec3& to_eye)
    : surface_(surface),
      frame_(frame_along(surface, normal).value_or(frame_about(normal))),
      eye_(frame_.transpose() * to_eye),
      widths_(widths_of(surface)),
      // What facets send on to each other leaves in all directions: some samples are always drawn as of a matte
      // surface.
      share_(0.75 * surface.gloss) {
  eye_.z() = std::max(eye_.z(), 1e-6);
  surface_.along = frame_.transpose() * surface.along;
  if (!frame_along(surface_, Vec3::UnitZ())) surface_.anisotropy = 0.0, widths_ = widths_of(surface_);
}

Vec3 Lobe::matte(double u, double v) const {
  const Eigen::Vector2d disc = std::sqrt(u) * on_unit_circle(v);
  return {disc.x(), disc.y(), std::sqrt(std::max(0.0, 1.0 - u))};
}

/// By a facet that the eye sees (Heitz 2018, "Sampling the GGX distribution of visible normals").
Vec3 Lobe::mirrored(double u, double v) const {
  const Vec3 stretched = Vec3(widths_.along * eye_.x(), widths_.across * eye_.y(), eye_.z()).normalized();
  // The disc of directions seen edge on: its two halves are the projections of the upper hemisphere.
  const Vec3 along =
      stretched.z() < 0.9999 ? Vec3(Vec3::UnitZ().cross(stretched).normalized()) : Vec3(frame_about(stretched).col(0));
  const Vec3 up = stretched.cross(along);
  const Eigen::Vector2d disc = std::sqrt(u) * on_unit_circle(v);
  const double x = disc.x();
  const double s = 0.5 * (1.0 + stretched.z());
  const double y = (1.0 - s) * std::sqrt(std::max(0.0, 1.0 - x * x)) + s * disc.y();
  const Vec3 seen = x * along + y * up + std::sqrt(std::max(0.0, 1.0 - x * x - y * y)) * stretched;
  const Vec3 facet = Vec3(widths_.along * seen.x(), widths_.across * seen.y(), std::max(1e-9, seen.z())).normalized();
  return 2.0 * eye_.dot(facet) * facet - eye_;
}

double Lobe::density(const Vec3& local) const {
  const double matte = local.z() / M_PI;
  if (share_ <= 0.0) return matte;
  const Vec3 half = local + eye_;  // not unit: bend is times its square
  const double bend = Vec3(half.x() / widths_.along, half.y() / widths_.across, half.z()).squaredNorm();
  const double square = half.squaredNorm(), c = eye_.z();
  const double facets = square * square / (M_PI * widths_.along * widths_.across * bend * bend);
  const double slant = Vec3(widths_.along * eye_.x(), widths_.across * eye_.y(), c).norm();
  const double seen = 2.0 * c / (c + slant);
  return (1.0 - share_) * matte + share_ * seen * facets / (4.0 * c);
}

Lobe::Sample Lobe::at(double u, double v) const {
  const Vec3 local = u < share_ ? mirrored(u / share_, v) : matte((u - share_) / (1.0 - share_), v);
  if (!(local.z() > 1e-6)) return {frame_ * local, 0.0, 1.0};
  const double density = this->density(local);
  const SentBack sent = sent_back(surface_, Vec3::UnitZ(), local, eye_);
  return {frame_ * local, (sent.matte + sent.mirrored) / (M_PI * density), density, sent.matte / (M_PI * density)};
}

}  // namespace bin_scenes
