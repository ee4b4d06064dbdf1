/// Keeps each body's energy of the last observation and compares sums over groups that may have touched. Also finds
/// bodies that leave far faster than any neighbour moved.
#include "pour/energy_audit.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace bin_scenes {

namespace {

constexpr double earth = 9.81;     ///< m/s2
constexpr double allowed = 1e-3;   ///< share of kinetic energy: the goal for force-free tumbling
constexpr double stirs = 1e-4;     ///< m g d: change of energy from which a part has moved
constexpr double swift = 1e-6;     ///< m g d: kinetic energy from which a part has moved
constexpr double touching = 0.02;  ///< of the diagonal: parts nearer than this may have touched

}  // namespace

EnergyAudit::EnergyAudit(const WorldDef& world)
    : world_(world),
      gravity_(world.gravity.norm() > 0.0 ? world.gravity.norm() : earth),
      bodies_(world.bodies.size()),
      world_energy_(world.bodies.size()) {}

EnergyAudit::Body EnergyAudit::body_at(std::size_t body, const BodyState& state) const {
  const BodyDef& def = world_.bodies[body];
  const MassProperties& mass = world_.parts[def.part]->mass();
  const Vec3 spin = state.pose.orientation.conjugate() * state.velocity.angular;  // model axes
  Body now;
  now.in = true;
  now.fixed = def.fixed;
  now.center = state.pose * mass.center;
  now.speed = state.velocity.linear.norm();
  now.swift = now.speed + world_.parts[def.part]->radius() * state.velocity.angular.norm();
  now.potential = -def.mass * world_.gravity.dot(now.center);
  now.kinetic = 0.5 * def.mass * (now.speed * now.speed + spin.dot(mass.inertia * spin) / mass.volume);
  return now;
}

void EnergyAudit::enter(std::size_t body, const BodyState& state) {
  BIN_SCENES_ASSERT(body < bodies_.size() && is_rigid(state.pose));
  bodies_[body] = body_at(body, state);
  world_energy_.enter(body, bodies_[body].kinetic + bodies_[body].potential);
}

void WorldEnergy::observe(std::size_t index, double kinetic, double potential, double unit) {
  Body& body = bodies_[index];
  body.now = kinetic + potential;
  body.unit = unit;
  body.in = true;
  body.swiftest = std::max(body.swiftest, kinetic);
}

void WorldEnergy::finish(double time) {
  double gain = 0.0, unit = 0.0, change = 0.0;
  for (const Body& body : bodies_) {
    if (!body.in) continue;
    const double more = body.now - body.least;
    change += more;
    const bool moved = std::abs(more) > stirs * body.unit || body.swiftest > swift * body.unit;
    gain += (moved ? more : std::min(more, 0.0)) - allowed * body.swiftest;
    if (moved) unit += body.unit;
  }
  if (gain > worst_.relative * unit) worst_ = {gain / unit, time};
  const bool least = begins_ || change <= 0.0;
  for (Body& body : bodies_) {
    if (least) body.least = body.now, body.swiftest = 0.0;
    body.in = false;
  }
  begins_ = false;
}

void EnergyAudit::observe_world(double time) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    if (!body.in || body.fixed) continue;
    const BodyDef& def = world_.bodies[b];
    world_energy_.observe(b, body.kinetic, body.potential, def.mass * gravity_ * world_.parts[def.part]->diagonal());
  }
  world_energy_.finish(time);
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

void EnergyAudit::observe(double time, const std::vector<BodyState>& states, bool driven) {
  BIN_SCENES_ASSERT(time >= last_);
  const double seconds = time - last_;
  last_ = time;
  if (driven) {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (bodies_[b].in && states[b].pose.finite()) enter(b, states[b]);
    world_energy_.begin();
    observe_world(time);
    return;
  }
  std::vector<Reach> reaches;
  bool gained = false, faster = false;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& before = bodies_[b];
    if (!before.in || before.fixed || !states[b].pose.finite()) continue;
    const Body now = body_at(b, states[b]);
    const PartModel& part = *world_.parts[world_.bodies[b].part];
    const double distance = std::max(0.5 * (before.speed + now.speed) * seconds, (now.center - before.center).norm());
    const double gain = now.kinetic - before.kinetic + now.potential - before.potential -
                        allowed * std::max(now.kinetic, before.kinetic);
    Reach reach;
    reach.body = b;
    reach.center = 0.5 * (before.center + now.center);
    reach.radius = part.radius() + 0.5 * distance + 0.5 * touching * part.diagonal();
    reach.gain = gain;
    reach.before = before.swift;
    reach.now = now.speed;
    reaches.push_back(reach);
    faster |= now.speed > least_speed(b) && now.speed > flagged_ratio * before.swift + gravity_ * seconds;
    gained |= gain > worst_.gain * world_.bodies[b].mass * gravity_ * part.diagonal();
    before = now;
  }
  observe_world(time);
  if (!gained && !faster) return;  // nobody is worse than the worst so far, however its group fared
  DisjointSets group = groups(reaches);
  if (gained) compare_gains(group, reaches, time);
  if (faster) compare_speeds(group, reaches, seconds, time);
}

double EnergyAudit::least_speed(std::size_t body) const {
  return std::sqrt(2.0 * flagged_gain * gravity_ * world_.parts[world_.bodies[body].part]->diagonal());
}

void EnergyAudit::compare_speeds(DisjointSets& group, const std::vector<Reach>& reaches, double seconds, double time) {
  std::vector<double> fastest(reaches.size(), 0.0), restitution(reaches.size(), world_.bin.restitution);
  for (std::uint32_t i = 0; i < reaches.size(); ++i) {
    const std::size_t root = group.root(i);
    fastest[root] = std::max(fastest[root], reaches[i].before);
    restitution[root] = std::max(restitution[root], world_.bodies[reaches[i].body].restitution);
  }
  const double fall = gravity_ * seconds;
  for (std::uint32_t i = 0; i < reaches.size(); ++i) {
    const Reach& part = reaches[i];
    const std::size_t root = group.root(i);
    if (part.now <= least_speed(part.body)) continue;
    const double ratio = (part.now - fall) / (std::max(fastest[root], fall) * (1.0 + restitution[root]));
    if (ratio <= std::max(worst_.thrown.ratio, 1.0)) continue;
    worst_.thrown = {ratio, time, static_cast<int>(part.body), -1};
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = 0; k < reaches.size(); ++k) {
      const double gap = (reaches[k].center - part.center).norm() - reaches[k].radius - part.radius;
      if (k == i || group.root(k) != root || gap >= nearest) continue;
      nearest = gap;
      worst_.thrown.beside = static_cast<int>(reaches[k].body);
    }
  }
}

void EnergyAudit::compare_gains(DisjointSets& group, const std::vector<Reach>& reaches, double time) {
  std::vector<double> sums(reaches.size(), 0.0);
  for (std::uint32_t i = 0; i < reaches.size(); ++i) sums[group.root(i)] += reaches[i].gain;
  for (std::uint32_t i = 0; i < reaches.size(); ++i) {
    const BodyDef& def = world_.bodies[reaches[i].body];
    const double unit = def.mass * gravity_ * world_.parts[def.part]->diagonal();
    const double gain = std::min(reaches[i].gain, sums[group.root(i)]) / unit;
    if (gain <= worst_.gain) continue;
    worst_.gain = gain;
    worst_.time = time;
    worst_.part = static_cast<int>(reaches[i].body);
  }
}

std::vector<Flag> flags_of(const EnergyReport& worst) {
  const std::string remedy = "use the other solver, shorter time steps, or a model without nearly equal fits";
  std::vector<Flag> flags;
  if (worst.gain > flagged_gain)
    flags.push_back({"energy_gained",
                     formatted("part %d gained %.3g m g d of energy from nowhere by %.3f s of simulated time",
                               worst.part, worst.gain, worst.time),
                     remedy});
  const auto& thrown = worst.thrown;
  if (thrown.ratio > flagged_ratio)
    flags.push_back(
        {"part_thrown",
         formatted("part %d, beside %s, left at %.3g times the speed of what was near it by %.3f s of simulated time",
                   thrown.part, thrown.beside < 0 ? "the bin" : ("part " + std::to_string(thrown.beside)).c_str(),
                   thrown.ratio, thrown.time),
         remedy});
  return flags;
}

}  // namespace bin_scenes
