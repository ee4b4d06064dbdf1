#include "pour/squeezed_parts.hpp"

#include "bin_scenes/core/error.hpp"
#include "core/formatted.hpp"
#include "solver/step_limit.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

constexpr double most_growth = 0.95;  ///< 1/s: with 1.1, a cube moves by 3 % of its diagonal before it is at rest
constexpr double measured = 1.5;  ///< factor of the rate, for cubes of 5 mm to 0.3 m under 2 to 1000 times their mass
constexpr double stiff_sub_steps = 4.0;  ///< of stiff contacts, in place of one
constexpr double slippery = 1e-3;        ///< friction coefficient below which nothing is held
constexpr double near = 0.01;            ///< of the light part's height: distance at which parts touch

/// A body that may move, where it starts.
struct Standing {
  std::size_t body;
  Aabb box;
  Vec3 center;
};

std::vector<Standing> standing(const PourPlan& plan) {
  std::vector<Standing> all;
  for (std::size_t b = 0; b < plan.line_of.size(); ++b) {
    const PartLine& line = plan.request.parts[plan.line_of[b]];
    if (line.poses.empty() || line.stays()) continue;
    const Pose& pose = line.poses[plan.copy_of[b]];
    const PartModel& part = *plan.world.parts[plan.world.bodies[b].part];
    Standing s{b, {}, pose * part.mass().center};
    for (const Vec3& v : part.corners()) s.box.extend(pose * v);
    all.push_back(s);
  }
  return all;
}

/// Whether `upper` stands on `lower` alone, as far as their bounding boxes say.
bool stands_on(const Standing& upper, const Standing& lower) {
  const Aabb& box = lower.box;
  const bool above = upper.center.x() > box.lower.x() && upper.center.x() < box.upper.x() &&
                     upper.center.y() > box.lower.y() && upper.center.y() < box.upper.y();
  return above && std::abs(upper.box.lower.z() - box.upper.z()) < near * box.size().z();
}

double sub_step(const PourPlan& plan) {
  const SphereSettings& s = plan.request.solver.sphere;
  double smallest = plan.largest_part;
  for (const PartModelPtr& part : plan.world.parts) smallest = std::min(smallest, part->diagonal());
  const int cuts = s.cut_steps ? step_cuts(s.time_step, plan.world.gravity.norm(), smallest, s.step_fall) : 1;
  return s.time_step / cuts / (s.sub_steps * stiff_sub_steps);
}

[[noreturn]] void refuse(const PourPlan& plan, const Standing& heavy, const Standing& light, double ratio,
                         double most) {
  const auto named = [&](const Standing& s) {
    return "part " + std::to_string(s.body) + " (" + plan.request.parts[plan.line_of[s.body]].model + ")";
  };
  throw input_error(named(heavy) + " stands on " + named(light) + " and is " + formatted("%.4g", ratio) +
                        " times as heavy, and no friction holds the lower one: it would be squeezed out",
                    "parts[" + std::to_string(plan.line_of[light.body]) + "].friction",
                    formatted("set friction, or masses that differ by a factor of at most %.2g", most));
}

}  // namespace

void refuse_squeezed_parts(const PourPlan& plan) {
  const SolverSettings& solver = plan.request.solver;
  if (solver.type == SolverType::bullet || solver.preset == SolverSettings::Preset::thesis) return;
  const Vec3& gravity = plan.world.gravity;
  if (!(gravity.z() < 0.0) || gravity.head<2>().norm() > 1e-3 * -gravity.z()) return;
  const std::vector<Standing> all = standing(plan);
  const double rate_of_one = measured * gravity.norm() * sub_step(plan);  // times ratio / width
  for (const Standing& light : all) {
    const BodyDef& lower = plan.world.bodies[light.body];
    if (lower.friction > slippery) continue;
    const double most = most_growth * light.box.size().head<2>().minCoeff() / rate_of_one;
    for (const Standing& heavy : all) {
      const double ratio = plan.world.bodies[heavy.body].mass / lower.mass;
      if (ratio > most && stands_on(heavy, light)) refuse(plan, heavy, light, ratio, most);
    }
  }
}

}  // namespace bin_scenes
