#include "solver/sphere/passes/candidates.hpp"

#include "solver/sphere/passes/sample_test.hpp"
#include "solver/sphere/passes/slide.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {

namespace {

/// Distance to the solid beyond a plane, and the direction out of it. A wall ends at the bin's top: it is the corner
/// between its inner face and the rim's level, as thick as it takes.
float plane_distance(const World& world, const Plane& plane, const Vec3f& p, Vec3f& out) {
  const float face = plane.normal.dot(p) - plane.offset;
  out = plane.normal;
  if (!plane.wall) return face;
  const float above = p.z() - world.wall_top;
  if (above <= 0 && face >= 0) return face;
  if (above <= 0) {
    if (face >= above) return face;
    out = Vec3f::UnitZ();
    return above;
  }
  if (face <= 0) {
    out = Vec3f::UnitZ();
    return above;
  }
  const float d = std::sqrt(above * above + face * face);
  out = (above * Vec3f::UnitZ() + face * plane.normal) / d;
  return d;
}

/// The rim of a wall against the field of a part that lies across it: a line passes between the part's nodes. One
/// candidate for each place along it where it is nearest, or deepest.
void candidates_of_rim(const World& world, std::size_t k, const Shape& shape, const Samples& samples,
                       const Placement& a, float margin, Candidates& out) {
  constexpr float least_out = -0.1f;  // the way out of the rim is upwards, off the wall, or between the two
  const Plane& plane = world.planes[k];
  const float face = plane.normal.dot(a.x) - plane.offset, above = a.x.z() - world.wall_top;
  const float reach = shape.radius + margin, near = reach * reach - face * face - above * above;
  if (!plane.wall || near <= 0 || samples.face_spacing <= 0) return;
  const Vec3f along = plane.normal.cross(Vec3f::UnitZ());
  const Vec3f start = plane.offset * plane.normal + world.wall_top * Vec3f::UnitZ();
  const Mat3f back = a.rotation.transpose();
  const auto on_rim = [&](float t) { return Vec3f(back * (start + t * along - a.x)); };
  const float step = samples.face_spacing, middle = along.dot(a.x), half = std::sqrt(near);
  const int first = static_cast<int>(std::floor((middle - half) / step));
  const int last = static_cast<int>(std::ceil((middle + half) / step));
  float before = shape.field.sample(on_rim(step * static_cast<float>(first - 1)));
  float here = shape.field.sample(on_rim(step * static_cast<float>(first)));
  for (int i = first; i <= last; ++i) {
    const float after = shape.field.sample(on_rim(step * static_cast<float>(i + 1)));
    const bool nearest =  // or an end of where it lies along a face
        here <= before && here <= after && (here < before || here < after) && here - step < margin;
    before = here;
    here = after;
    if (!nearest) continue;
    float lower = step * static_cast<float>(i - 1), upper = step * static_cast<float>(i + 1);
    for (int round = 0; round < 8; ++round) {
      const float t0 = lower + (upper - lower) / 3, t1 = upper - (upper - lower) / 3;
      if (shape.field.sample(on_rim(t0)) <= shape.field.sample(on_rim(t1)))
        upper = t1;
      else
        lower = t0;
    }
    const float t = 0.5f * (lower + upper);
    const Vec3f x = on_rim(t), p = start + t * along;
    Vec3f gradient;
    const float d = shape.field.sample(x, gradient);
    const Vec3f way_out = -(a.rotation * gradient);
    const auto within = [&](const Plane& other) { return other.wall && other.normal.dot(p) < other.offset - margin; };
    if (d >= margin || way_out.z() < least_out || way_out.dot(plane.normal) < least_out ||
        std::any_of(world.planes.begin(), world.planes.end(), within))
      continue;
    const auto place = static_cast<std::uint32_t>(i + 0x400000) & 0x7fffffu;
    out.push_back({x - d * gradient, x, gradient, d, side_b | static_cast<std::uint32_t>(place + k * 0x1000000u)});
  }
}

}  // namespace

void candidates_of_pair(const World& world, const Manifold& m, const Placement& a, const Placement& b, float margin,
                        Counters& counters, Candidates& out) {
  const Body &body_a = world.bodies[m.a], &body_b = world.bodies[m.b];
  const Shape &sa = *world.shapes[body_a.shape], &sb = *world.shapes[body_b.shape];
  const Samples &samples_a = world.samples(body_a), &samples_b = world.samples(body_b);
  const Carry b_to_a{a.rotation.transpose() * b.rotation, a.rotation.transpose() * (b.x - a.x)};
  const Carry a_to_b{b_to_a.rotation.transpose(), -(b_to_a.rotation.transpose() * b_to_a.offset)};
  const bool way_back = world.settings.way_back;
  test_samples({samples_a, sa.field, samples_b, sb.field, a_to_b, &b_to_a, margin, way_back}, counters, out);
  test_samples({samples_b, sb.field, samples_a, sa.field, b_to_a, nullptr, margin, way_back}, counters, out);
}

void candidates_of_ground(const World& world, const Manifold& m, const Placement& a, float margin, Counters& counters,
                          Candidates& out) {
  const Body& body = world.bodies[m.a];
  const Samples& samples = world.samples(body);
  const Mat3f back = a.rotation.transpose();
  const Carry carry{a.rotation, a.x};
  counters.nodes_possible += samples.nodes.size();
  for (std::size_t k = 0; k < world.planes.size(); ++k) {
    const Plane& plane = world.planes[k];
    const auto depth = [&](const Vec3f& p, Vec3f& out) { return plane_distance(world, plane, p, out); };
    for (std::size_t c = 0; c < samples.clusters.size(); ++c) {
      ++counters.clusters_tested;
      const Vec3f center = a.x + a.rotation * samples.clusters[c].center;
      if (plane.normal.dot(center) - plane.offset > samples.clusters[c].radius + samples.radius + samples.sag + margin)
        continue;
      const std::size_t last = std::min(samples.nodes.size(), (c + 1) * cluster_size);
      counters.nodes_tested += last - c * cluster_size;
      for (std::size_t i = c * cluster_size; i < last; ++i) {
        Vec3f p = carry(samples.nodes[i]), up;
        float d = plane_distance(world, plane, p, up) - samples.radius;
        if (d > margin + samples.sag) continue;
        slide(samples, world.shapes[body.shape]->field, carry, i, depth, p, up, d);
        if (d > margin) continue;
        const Vec3f surface = p - samples.radius * up;
        out.push_back({back * (surface - a.x), back * (surface - d * up - a.x), -(back * up), d,
                       static_cast<std::uint32_t>(i + k * 0x1000000u)});
      }
    }
    candidates_of_rim(world, k, *world.shapes[body.shape], samples, a, margin, out);
  }
}

}  // namespace bin_scenes::sphere
