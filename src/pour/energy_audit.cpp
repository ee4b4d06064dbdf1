#include "pour/energy_audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace bin_scenes {

namespace {

constexpr double earth = 9.81;     ///< m/s2
constexpr double allowed = 1e-3;   ///< share of kinetic energy: the goal for force-free tumbling
constexpr double touching = 0.02;  ///< of the diagonal: parts nearer than this may have touched

}  // namespace

EnergyAudit::EnergyAudit(const WorldDef& world)
    : world_(world),
      gravity_(world.gravity.norm() > 0.0 ? world.gravity.norm() : earth),
      bodies_(world.bodies.size()) {}

EnergyAudit::Body EnergyAudit::body_at(std::size_t body, const BodyState& state) const {
  const BodyDef& def = world_.bodies[body];
  const MassProperties& mass = world_.parts[def.part]->mass();
  const Vec3 spin = state.pose.orientation.conjugate() * state.velocity.angular;  // model axes
  Body now;
  now.in = true;
  now.fixed = def.fixed;
  now.center = state.pose * mass.center;
  now.speed = state.velocity.linear.norm();
  now.potential = -def.mass * world_.gravity.dot(now.center);
  now.kinetic = 0.5 * def.mass * (now.speed * now.speed + spin.dot(mass.inertia * spin) / mass.volume);
  return now;
}

void EnergyAudit::enter(std::size_t body, const BodyState& state) {
  bodies_[body] = body_at(body, state);
}

DisjointSets EnergyAudit::groups(const std::vector<Reach>& reaches) const {
  DisjointSets groups(reaches.size());
  std::vector<std::uint32_t> order(reaches.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto lower = [&](std::uint32_t i) { return reaches[i].center.x() - reaches[i].radius; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return lower(a) < lower(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {  // sweep along x
    const Reach& a = reaches[order[i]];
    for (std::size_t k = i + 1; k < order.size() && lower(order[k]) <= a.center.x() + a.radius; ++k) {
      const Reach& b = reaches[order[k]];
      const double near = a.radius + b.radius;
      if ((a.center - b.center).squaredNorm() <= near * near) groups.join(order[i], order[k]);
    }
  }
  return groups;
}

void EnergyAudit::look(double time, const std::vector<BodyState>& states, bool driven) {
  const double seconds = time - last_;
  last_ = time;
  if (driven) {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (bodies_[b].in && states[b].pose.finite()) enter(b, states[b]);
    return;
  }
  std::vector<Reach> reaches;
  bool gained = false;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& before = bodies_[b];
    if (!before.in || before.fixed || !states[b].pose.finite()) continue;
    const Body now = body_at(b, states[b]);
    const PartModel& part = *world_.parts[world_.bodies[b].part];
    const double way = std::max(0.5 * (before.speed + now.speed) * seconds, (now.center - before.center).norm());
    const double gain = now.kinetic - before.kinetic + now.potential - before.potential -
                        allowed * std::max(now.kinetic, before.kinetic);
    reaches.push_back(
        {b, 0.5 * (before.center + now.center), part.radius() + 0.5 * way + 0.5 * touching * part.diagonal(), gain});
    gained |= gain > worst_.gain * world_.bodies[b].mass * gravity_ * part.diagonal();
    before = now;
  }
  if (!gained) return;  // nobody gained more than the worst so far, however its group fared

  DisjointSets group = groups(reaches);
  std::vector<double> sums(reaches.size(), 0.0);
  for (std::uint32_t i = 0; i < reaches.size(); ++i) sums[group.root(i)] += reaches[i].gain;
  for (std::uint32_t i = 0; i < reaches.size(); ++i) {
    const BodyDef& def = world_.bodies[reaches[i].body];
    const double unit = def.mass * gravity_ * world_.parts[def.part]->diagonal();
    const double gain = std::min(reaches[i].gain, sums[group.root(i)]) / unit;
    if (gain > worst_.gain) worst_ = {gain, time, static_cast<int>(reaches[i].body)};
  }
}

std::vector<Flag> EnergyAudit::flags() const {
  if (worst_.gain <= flagged_gain) return {};
  char text[160];
  std::snprintf(text, sizeof text, "part %d gained %.3g m g d of energy from nowhere by %.3f s of simulated time",
                worst_.part, worst_.gain, worst_.time);
  return {{"energy_gained", text, "use the other solver, shorter time steps, or a model without nearly equal fits"}};
}

}  // namespace bin_scenes
