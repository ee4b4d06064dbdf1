#include "pour/jam.hpp"

#include "core/disjoint_sets.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// What acts on one part (N).
using Forces = std::vector<Vec3>;

/// The smaller of what presses along and against a direction, for the force along which it is largest (N).
double squeeze(const Forces& forces) {
  double largest = 0.0;
  for (const Vec3& force : forces) {
    const Vec3 along = force.normalized();
    double with = 0.0, against = 0.0;
    for (const Vec3& other : forces) {
      const double share = other.dot(along);
      (share > 0.0 ? with : against) += std::abs(share);
    }
    largest = std::max(largest, std::min(with, against));
  }
  return largest;
}

}  // namespace

JamReport worst_jam(const WorldDef& world, const std::vector<BodyState>& states,
                    const std::vector<ContactForce>& forces) {
  JamReport worst;
  const double gravity = world.gravity.norm();
  if (!(gravity > 0.0)) return worst;
  const auto moves = [&](int body) { return body >= 0 && !world.bodies[static_cast<std::size_t>(body)].fixed; };
  std::vector<Forces> on(states.size());
  DisjointSets groups(states.size());
  for (const ContactForce& f : forces) {
    if (moves(f.a)) on[static_cast<std::size_t>(f.a)].push_back(-f.force);
    if (moves(f.b)) on[static_cast<std::size_t>(f.b)].push_back(f.force);
    if (moves(f.a) && moves(f.b)) groups.join(static_cast<std::uint32_t>(f.a), static_cast<std::uint32_t>(f.b));
  }
  BIN_SCENES_ASSERT(states.size() == world.bodies.size());
  BIN_SCENES_ASSERT(each_is(forces, [](const ContactForce& f) { return f.force.allFinite() && f.a != f.b; }));
  const auto height = [&](std::size_t body) {
    return -(states[body].pose * world.parts[world.bodies[body].part]->mass().center).dot(world.gravity);
  };
  for (std::size_t body = 0; body < states.size(); ++body) {
    const double pressed = squeeze(on[body]);
    // Most parts carry little more than themselves, and need not be compared with what is above them.
    if (pressed <= worst.ratio * world.bodies[body].mass * gravity) continue;
    double mass = world.bodies[body].mass;
    for (std::size_t other = 0; other < states.size(); ++other) {
      const bool above = !on[other].empty() && groups.root(static_cast<std::uint32_t>(other)) ==
                                                   groups.root(static_cast<std::uint32_t>(body));
      if (other != body && above && height(other) > height(body)) mass += world.bodies[other].mass;
    }
    const double ratio = pressed / (mass * gravity);
    if (ratio > worst.ratio) worst = {ratio, static_cast<int>(body)};
  }
  return worst;
}

std::vector<Flag> flags_of(const JamReport& jam) {
  if (jam.ratio <= flagged_squeeze) return {};
  return {
      {"part_jammed",
       formatted("part %d is squeezed by %.3g times the weight of itself and of what lies on it", jam.part, jam.ratio),
       "check its fit: it may stick where its collision shape fills a gap of the part"}};
}

}  // namespace bin_scenes
