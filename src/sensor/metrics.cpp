/// Shows a sensor balls and plates over its field of view, with the models that scenes use, and fits what it measured.
#include "bin_scenes/sensor/metrics.hpp"

#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "sensor/fit.hpp"
#include "sensor/targets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr double albedo = 0.8;  // of balls and plates, as vendors' targets
constexpr int repeats = 8;

Vec3 as_vector(const std::array<float, 3>& p) {
  return {p[0], p[1], p[2]};
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto median = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), median, values.end());
  return *median;
}

/// At the origin, looking along z; what stood beside the camera stays there.
Sensor at_origin(const Sensor& sensor) {
  Sensor moved = sensor;
  Bin nothing;
  nothing.kind = Bin::Kind::none;
  if (sensor.pose) {
    const Pose back = sensor.pose->inverse();
    if (moved.projector.pose) moved.projector.pose = back * *moved.projector.pose;
    if (moved.laser.pose) moved.laser.pose = back * *moved.laser.pose;
    moved.scan.direction = back.orientation * moved.scan.direction;
  }
  moved.pose = Pose();
  return resolved(moved, nothing);
}

RangeImage shot(const Sensor& sensor, Targets& targets, std::size_t index) {
  const Scenery scenery = targets.scenery();
  const Sensor device = true_device({sensor}, 0, 0);
  RangeImage image = measure(scenery, render(scenery, lens_of(device), *device.pose, sensor.near, sensor.far), device,
                             targets.surfaces(), {0, index, 0});
  report_as_believed(image, device, sensor);
  return image;
}

/// Valid points, optionally of one label.
std::vector<Vec3> points_with(const RangeImage& image, int label) {
  std::vector<Vec3> out;
  const std::vector<std::array<float, 3>> all = points_of(image);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (image.validity[i] == 0 && image.label[i] == label) out.push_back(as_vector(all[i]));
  }
  return out;
}

/// Largest - smallest after the outermost 0.3 % are left out, as VDI/VDE 2634 allows.
double range_of(std::vector<double> residuals) {
  if (residuals.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  std::sort(residuals.begin(), residuals.end());
  const std::size_t out = residuals.size() * 15 / 10000;
  return residuals[residuals.size() - 1 - out] - residuals[out];
}

/// Half the width and height of the camera's field at a distance.
Eigen::Vector2d half_field(const Sensor& sensor, double distance) {
  const Lens lens = lens_of(sensor);
  return 0.5 * distance * Eigen::Vector2d(lens.width / lens.fx, lens.height / lens.fy);
}

std::array<Vec3, 7> positions(const Sensor& sensor, const std::array<double, 3>& z, double share) {
  const Eigen::Vector2d half = share * half_field(sensor, z[1]);
  return {Vec3(0, 0, z[1]),
          Vec3(-half.x(), 0, z[1]),
          Vec3(half.x(), 0, z[1]),
          Vec3(0, -half.y(), z[1]),
          Vec3(0, half.y(), z[1]),
          Vec3(-half.x(), -half.y(), z[0]),
          Vec3(half.x(), half.y(), z[2])};
}

/// One ball after the other: they would light and occlude each other.
void measure_balls(const Sensor& sensor, SensorMetrics& m) {
  const std::array<Vec3, 7> places = positions(sensor, m.distances, 0.55);
  const Mesh ball = ball_target(m.ball_radius, 5);
  std::array<Vec3, 7> centers;
  for (int i = 0; i < 7; ++i) {
    Targets targets;
    targets.add(ball, {places[i], Quat::Identity()}, {albedo, 0.0, 0.4});
    const BallFit fit = fit_ball(points_with(shot(sensor, targets, 0), 1));
    m.probing_form[i] = range_of(fit.residuals);
    m.probing_size[i] = 2.0 * (fit.radius - m.ball_radius);
    centers[i] = fit.center;
  }
  for (int a = 0; a < 7; ++a) {
    for (int b = 0; b < a; ++b) {
      const double right = (places[a] - places[b]).norm(), error = std::abs((centers[a] - centers[b]).norm() - right);
      m.sphere_spacing = std::fmax(m.sphere_spacing, error);  // of a ball that was not seen: no number
      m.dimension_trueness = std::fmax(m.dimension_trueness, error / right);
    }
  }
}

Targets plate(const Vec3& center, const Quat& turn, double size) {
  Targets targets;
  const double thickness = 0.01 * size;
  targets.add(box_target({size, size, thickness}), {center + turn * Vec3(0, 0, 0.5 * thickness), turn},
              {albedo, 0.0, 0.4});
  return targets;
}

/// Points of the plate's face without a rim of a twentieth of its size: its sides are seen there, and edges.
std::vector<Vec3> points_on_face(const RangeImage& image, const Vec3& center, const Quat& turn, double size) {
  std::vector<Vec3> points = points_with(image, 1);
  const auto on_rim = [&](const Vec3& p) {
    const Vec3 there = turn.conjugate() * (p - center);
    return there.head<2>().cwiseAbs().maxCoeff() > 0.45 * size;
  };
  points.erase(std::remove_if(points.begin(), points.end(), on_rim), points.end());
  return points;
}

void measure_flatness(const Sensor& sensor, SensorMetrics& m) {
  const double size = 4.0 * half_field(sensor, m.distances[2]).maxCoeff();
  const double tilt = M_PI / 6.0;
  // A tilted plate reaches from the nearest to the farthest distance of the volume, and not beyond.
  const double tilted = std::min(size, 2.0 * (m.distances[2] - m.distances[1]) / std::sin(tilt));
  const std::array<std::pair<double, Quat>, 7> poses = {{
      {m.distances[1], Quat::Identity()},
      {m.distances[1], Quat(Eigen::AngleAxisd(-tilt, Vec3::UnitY()))},
      {m.distances[1], Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY()))},
      {m.distances[1], Quat(Eigen::AngleAxisd(-tilt, Vec3::UnitX()))},
      {m.distances[1], Quat(Eigen::AngleAxisd(tilt, Vec3::UnitX()))},
      {m.distances[0], Quat::Identity()},
      {m.distances[2], Quat::Identity()},
  }};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Vec3 center(0, 0, poses[i].first);
    const Quat& turn = poses[i].second;
    const double side = turn.isApprox(Quat::Identity()) ? size : tilted;
    Targets targets = plate(center, turn, side);
    m.flatness[i] = range_of(fit_plane(points_on_face(shot(sensor, targets, 0), center, turn, side)).residuals);
  }
}

void measure_noise(const Sensor& sensor, SensorMetrics& m) {
  const double size = 4.0 * half_field(sensor, m.distances[1]).maxCoeff();
  Targets targets = plate({0, 0, m.distances[1]}, Quat::Identity(), size);
  std::vector<std::vector<std::array<float, 3>>> images;
  RangeImage image;
  for (int k = 0; k < repeats; ++k) {
    image = shot(sensor, targets, static_cast<std::size_t>(k));
    images.push_back(points_of(image));
  }
  for (const std::uint8_t v : image.validity) m.valid_points += v == 0;

  std::vector<double> of_point, along;
  for (std::size_t i = 0; i < images[0].size(); ++i) {
    Vec3 sum = Vec3::Zero(), square = Vec3::Zero();
    for (const auto& points : images) {
      sum += as_vector(points[i]);
      square += as_vector(points[i]).cwiseAbs2();
    }
    const Vec3 variance = (square - sum.cwiseAbs2() / repeats) / (repeats - 1);
    if (!variance.allFinite()) continue;
    of_point.push_back(std::sqrt(std::max(variance.sum(), 0.0)));
    along.push_back(std::sqrt(std::max(variance.z(), 0.0)));
  }
  m.point_precision = median(of_point);
  m.temporal_noise = median(along);

  constexpr int tile = 15;
  std::vector<double> local;
  std::vector<Vec3> centers;
  for (int y = 0; y + tile <= image.height; y += tile) {
    for (int x = 0; x + tile <= image.width; x += tile) {
      std::vector<Vec3> points;
      for (int k = 0; k < tile * tile; ++k) {
        const std::size_t i = static_cast<std::size_t>(y + k / tile) * image.width + x + k % tile;
        if (image.validity[i] == 0) points.push_back(as_vector(images.back()[i]));
      }
      if (points.size() < tile * tile / 2) continue;
      const PlaneFit fit = fit_plane(points);
      double sum = 0.0;
      for (const double r : fit.residuals) sum += r * r;
      local.push_back(std::sqrt(sum / static_cast<double>(fit.residuals.size())));
      centers.push_back(fit.center);
    }
  }
  m.local_planarity = median(local);
  if (centers.size() > 3) m.global_planarity = range_of(fit_plane(centers).residuals);
}

}  // namespace

SensorMetrics measure_sensor(const Sensor& given) {
  const Sensor sensor = at_origin(given);
  SensorMetrics m;
  m.sphere_spacing = m.dimension_trueness = m.global_planarity = std::numeric_limits<double>::quiet_NaN();
  const double center = std::sqrt(sensor.near * sensor.far);
  m.distances = {std::max(0.8 * center, 1.02 * sensor.near), center, std::min(1.2 * center, 0.98 * sensor.far)};
  const Eigen::Vector2d half = half_field(sensor, center);
  m.ball_radius = 0.2 * half.minCoeff();
  for (const double z : m.distances) {
    for (const double degrees : {0.0, 30.0, 50.0, 70.0}) {
      for (const double a : {0.05, 0.2, 0.5, 0.9}) {
        const double incidence = degrees * M_PI / 180.0;
        m.predicted.push_back({z, incidence, a, predicted_sigma(sensor, z, incidence, a)});
      }
    }
  }
  measure_balls(sensor, m);
  measure_flatness(sensor, m);
  measure_noise(sensor, m);
  return m;
}

}  // namespace bin_scenes
