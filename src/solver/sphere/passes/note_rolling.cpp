/// Measures how fast the contacts of rolling parts go round them. Steps are shortened in proportion
/// (sphere_solver.cpp): in each sub-step, a part that rolls loses about as much energy as at a corner of a polygon
/// whose sides are the angle by which the contact goes round the part in the sub-step.
#include "solver/sphere/world.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <vector>

namespace bin_scenes::sphere {

namespace {

constexpr float narrow = 0.02f;   ///< radius: contacts within it are one place, and a place that leaves it has moved
constexpr float one_side = 0.9f;  ///< cosine: normals that differ by more hold the part from several sides

/// Where two bodies press: the mean of their contacts, weighted by forces.
struct Place {
  float force = 0;                                   ///< N
  Vec3f on_a = Vec3f::Zero(), on_b = Vec3f::Zero();  ///< m, body frames
  Vec3f normal = Vec3f::Zero();                      ///< unit vector from a to b, world frame

  explicit Place(const Manifold& m) {
    for (const Contact& c : m.contacts) {
      force += c.normal_force;
      on_a += c.normal_force * c.anchor_a;
      on_b += c.normal_force * c.anchor_b;
      normal += c.normal_force * c.normal;
    }
    if (force <= 0) return;
    on_a /= force;
    on_b /= force;
    normal.normalize();
  }
};

/// Returns whether the bodies press at one place, and all their contacts point the same way. A part in a hole or a
/// thread is held from several sides: it rattles rather than rolls.
bool is_narrow(const Manifold& m, const Place& place, float most) {
  return place.force > 0 && std::all_of(m.contacts.begin(), m.contacts.end(), [&](const Contact& c) {
           return c.normal.dot(place.normal) > one_side &&
                  (c.normal_force <= 0 || (c.anchor_a - place.on_a).norm() < most);
         });
}

/// A part that rolls moves its place over both bodies, twice in about the same direction: a part that slides moves it
/// over one of them, and one that rattles moves it to and fro.
void note_place(const Place& now, float radius, double clock, Rolling& r) {
  const Vec3f moved = now.on_a - r.on_a;
  const float distance = std::min(moved.norm(), (now.on_b - r.on_b).norm());
  if (distance < narrow * radius) return;
  const bool goes_on = moved.dot(r.moved) > 0.5f * moved.norm() * r.moved.norm();
  r.took = static_cast<float>(clock - r.since);
  r.speed = goes_on ? distance / (radius * r.took) : 0.0f;
  r.since = clock;
  r.moved = moved;
  r.on_a = now.on_a;
  r.on_b = now.on_b;
}

bool presses(const Manifold& m) {
  return std::any_of(m.contacts.begin(), m.contacts.end(), [](const Contact& c) { return c.normal_force > 0; });
}

}  // namespace

void note_rolling(World& world) {
  static thread_local std::vector<int> touched;  // by body: number of manifolds that press
  touched.assign(world.bodies.size(), 0);
  for (const std::uint32_t i : world.order)
    if (const Manifold& m = world.manifolds[i]; presses(m))
      for (const std::uint32_t body : {m.a, m.b})
        if (body != ground) ++touched[body];
  const auto is_still = [&](std::uint32_t body) { return body == ground || !world.bodies[body].moves(); };
  world.rolling = 0;
  for (const std::uint32_t i : world.order) {
    Manifold& m = world.manifolds[i];
    // Only what rolls on something that does not move, and touches nothing else.
    const std::uint32_t rolls = is_still(m.a) ? m.b : m.a;
    if (is_still(rolls) || !is_still(rolls == m.a ? m.b : m.a) || touched[rolls] > 1) continue;
    const float radius = world.shapes[world.bodies[rolls].shape]->radius;
    BIN_SCENES_ASSERT(radius > 0);
    if (const Place now(m); is_narrow(m, now, narrow * radius)) note_place(now, radius, world.clock, m.rolling);
    if (m.rolling.speed <= 0) continue;
    // A place that does not move again in time has slowed down.
    const auto rests = static_cast<float>(world.clock - m.rolling.since);
    world.rolling = std::max(world.rolling, m.rolling.speed / std::max(1.0f, rests / (2.0f * m.rolling.took)));
  }
}

}  // namespace bin_scenes::sphere
