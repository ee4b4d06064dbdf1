#include "world.hpp"

#include <algorithm>

namespace bin_scenes::thesis {

namespace {

Vec3 vec3(const gpu::vec4& v) {
  return Vec3(v.x, v.y, v.z);
}

constexpr double endless = 1e30;  // m; float keeps it finite

}  // namespace

Shape make_shape(const std::vector<Sphere>& spheres, const MassProperties& mass) {
  Shape shape;
  shape.frame = {mass.center, mass.principal_axes};
  shape.gyration = mass.principal / mass.volume;
  const Pose into = shape.frame.inverse();
  for (const Sphere& sphere : spheres) {
    shape.spheres.push_back({into * sphere.center, sphere.radius, into.orientation * sphere.normal});
    shape.radius = std::max(shape.radius, shape.spheres.back().center.norm() + sphere.radius);
  }
  return shape;
}

std::vector<gpu::ThesisSheet> bin_sheets(const Bin& bin, double wall_height, double radius, double tightness) {
  std::vector<gpu::ThesisSheet> sheets;
  const auto add = [&](const Vec3& on_plane, const Vec3& normal, const Vec3& u, double half_u, double half_v,
                       double depth) {
    gpu::ThesisSheet sheet;
    sheet.origin = vec4(on_plane - radius * normal, radius);
    sheet.normal = vec4(normal, 2.0 * radius * tightness);
    sheet.u = vec4(u, half_u);
    sheet.v = vec4(normal.cross(u), half_v);
    sheet.surface = {static_cast<float>(bin.friction), static_cast<float>(bin.restitution), static_cast<float>(depth),
                     0.0f};
    sheets.push_back(sheet);
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  if (bin.kind == Bin::Kind::floor) add(Vec3::Zero(), z, x, endless, endless, endless);
  if (bin.kind == Bin::Kind::box) {
    const Vec3 half = 0.5 * bin.inner_size;
    const double height = std::max(wall_height, bin.inner_size.z());
    const double depth = std::max(8.0 * radius, 2.0 * bin.wall_thickness);
    const double rim = 2.0 * radius;  // the sheets reach a sphere beyond each other: no gap along the edges
    add(Vec3::Zero(), z, x, half.x() + rim, half.y() + rim, endless);
    for (const double side : {-1.0, 1.0}) {
      add(Vec3(side * half.x(), 0, 0.5 * height), -side * x, z, 0.5 * height + rim, half.y() + rim, depth);
      add(Vec3(0, side * half.y(), 0.5 * height), -side * y, z, 0.5 * height + rim, half.x() + rim, depth);
    }
  }
  return sheets;
}

World make_world(const WorldDef& def, const std::vector<Shape>& shapes, const ThesisSettings& settings) {
  World world;
  world.shapes = shapes;
  world.bodies = def.bodies;
  world.gravity = def.gravity;
  world.bin_friction = def.bin.friction;
  world.bin_restitution = def.bin.restitution;
  world.present.assign(def.bodies.size(), false);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  world.states.assign(def.bodies.size(), {{nan, nan, nan, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0}});

  // The bin's spheres are as small as the smallest of the parts, so that none falls through their gaps.
  double radius = endless;
  for (const Shape& shape : shapes)
    for (const Sphere& sphere : shape.spheres) radius = std::min(radius, sphere.radius);
  if (radius < endless) world.sheets = bin_sheets(def.bin, def.wall_height, radius, settings.tightness);
  if (def.bin.kind == Bin::Kind::box) {
    const Vec3 half = 0.5 * def.bin.inner_size;
    world.domain.extend(Vec3(-half.x(), -half.y(), 0.0));
    world.domain.extend(Vec3(half.x(), half.y(), std::max(def.wall_height, def.bin.inner_size.z())));
  }
  return world;
}

gpu::ThesisState to_state(const BodyState& state, const Shape& shape) {
  const Pose body = state.pose * shape.frame;
  const Quat& q = body.orientation;
  gpu::ThesisState result;
  result.position = vec4(body.position);
  result.orientation = vec4(q.vec(), q.w());
  result.velocity = vec4(state.velocity.linear);
  result.spin = vec4(state.velocity.angular);
  return result;
}

BodyState to_body_state(const gpu::ThesisState& state, const Shape& shape) {
  const gpu::vec4& q = state.orientation;
  const Pose body{vec3(state.position), Quat(q.w, q.x, q.y, q.z).normalized()};
  return {body * shape.frame.inverse(), {vec3(state.velocity), vec3(state.spin)}};
}

}  // namespace bin_scenes::thesis
