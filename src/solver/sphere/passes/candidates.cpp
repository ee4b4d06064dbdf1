#include "solver/sphere/passes/candidates.hpp"

#include "solver/sphere/passes/sample_test.hpp"
#include "solver/sphere/passes/slide.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {

namespace {

#include "shared/sphere/rim.h"

void candidates_of_rim(const World& world, std::size_t k, const Shape& shape, const Samples& samples,
                       const Placement& a, float margin, Candidates& out) {
  const Plane& plane = world.planes[k];
  Rim rim;
  if (!find_rim(plane, world.wall_top, a.x, shape.radius, margin, samples.face_spacing, rim)) return;
  const auto offer = [&](const Touch& touch, float t, std::uint32_t feature) {
    const Vec3f p = a.x + rim.start + t * rim.along;
    const auto within = [&](const Plane& other) { return other.wall && other.normal.dot(p) < other.offset - margin; };
    if (touch.distance < margin && std::none_of(world.planes.begin(), world.planes.end(), within))
      out.push_back(
          {touch.point - touch.distance * touch.gradient, touch.point, touch.gradient, touch.distance, feature});
  };
  float before = distance_at(rim, shape.field, a.rotation, rim.first - 1);
  float here = distance_at(rim, shape.field, a.rotation, rim.first);
  for (int i = rim.first; i <= rim.last; ++i) {
    const float after = distance_at(rim, shape.field, a.rotation, i + 1);
    float t;
    Touch touch;
    if (may_touch_rim(rim, before, here, after, margin) &&
        touch_rim(rim, plane, shape.field, a.rotation, i, t, touch) && touch.distance < margin) {
      offer(touch, t, rim_feature(i, false, static_cast<uint>(k)));
      if (touch_far_end(rim, shape.field, a.rotation, t, touch))
        offer(touch, t, rim_feature(i, true, static_cast<uint>(k)));
    }
    before = here;
    here = after;
  }
}

/// How the points of a body go on over another one, in whose frame this is given.
struct Drift {
  Vec3f drift, twist;

  Drift(float seconds, const Placement& points, const Placement& over) {
    const Mat3f back = over.rotation.transpose();
    drift = seconds * (back * (points.v - over.v + points.w.cross(over.x - points.x)));
    twist = seconds * (back * (points.w - over.w));
  }
};

}  // namespace

void candidates_of_pair(const World& world, const Manifold& m, const Placement& a, const Placement& b, float margin,
                        Counters& counters, Candidates& out) {
  const Body &body_a = world.bodies[m.a], &body_b = world.bodies[m.b];
  const Shape &sa = *world.shapes[body_a.shape], &sb = *world.shapes[body_b.shape];
  const Samples &samples_a = world.samples(body_a), &samples_b = world.samples(body_b);
  const Carry b_to_a{a.rotation.transpose() * b.rotation, a.rotation.transpose() * (b.x - a.x)};
  const Carry a_to_b{b_to_a.rotation.transpose(), -(b_to_a.rotation.transpose() * b_to_a.offset)};
  // The last sweeps look as far ahead as another sub-step.
  const float rest = world.settings.time_step - world.plan().contact_time + world.plan().sub_step;
  const Drift a_goes(rest, a, b), b_goes(rest, b, a);
  const View::Tested tested_a{samples_a, sa.field}, tested_b{samples_b, sb.field};
  View of_a(tested_a, tested_b, a_to_b, b_to_a, out), of_b(tested_b, tested_a, b_to_a, b_to_a, out);
  of_b.side = SPHERE_SIDE_B;
  of_a.drift = a_goes.drift, of_a.twist = a_goes.twist;
  of_b.drift = b_goes.drift, of_b.twist = b_goes.twist;
  of_a.margin = of_b.margin = margin;
  of_a.slop = of_b.slop = world.settings.soft.slop * world.smallest_size;
  of_a.way_back = of_b.way_back = world.settings.way_back;
  test_samples(of_a, counters);
  test_samples(of_b, counters);
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
    const Solid solid{true, world.shapes[body.shape]->field, plane, world.wall_top};
    for (std::size_t c = 0; c < samples.clusters.size(); ++c) {
      ++counters.clusters_tested;
      const Vec3f center = a.x + a.rotation * samples.clusters[c].center;
      if (plane.normal.dot(center) - plane.offset > samples.clusters[c].radius + samples.radius + samples.sag + margin)
        continue;
      const std::size_t last = std::min(samples.nodes.size(), (c + 1) * cluster_size);
      counters.nodes_tested += last - c * cluster_size;
      for (std::size_t i = c * cluster_size; i < last; ++i) {
        Touch touch;
        touch.point = carry(samples.nodes[i]);
        touch.distance = distance_to(solid, touch.point, touch.gradient) - samples.radius;
        if (touch.distance > margin + samples.sag) continue;
        slide(samples, solid.field, carry, static_cast<uint>(i), solid, touch);
        if (touch.distance > margin) continue;
        const Vec3f& up = touch.gradient;
        const Vec3f surface = touch.point - samples.radius * up;
        out.push_back({back * (surface - a.x), back * (surface - touch.distance * up - a.x), -(back * up),
                       touch.distance, static_cast<uint>(i + k * SPHERE_PLANE)});
      }
    }
    candidates_of_rim(world, k, *world.shapes[body.shape], samples, a, margin, out);
  }
}

}  // namespace bin_scenes::sphere
