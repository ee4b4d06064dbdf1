/// Error against closed forms, every solver with its default settings. The scenes are those that the tests hold to the
/// project's goals (test/solver/closed_form_scenes.hpp).
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/closed_form_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bin_scenes::bench {
namespace {

using testing::Lab;
using MakeLab = std::function<Lab()>;
using Errors = std::vector<double>;

struct Quantity {
  const char *name, *unit;  ///< "rel": of the exact value
  double goal;
};

struct Form {
  Errors (*measure)(const MakeLab& lab);  ///< errors of the quantities
  std::vector<Quantity> quantities;
  bool ball = false;   ///< a ball alone: one sphere for the thesis's solver
  bool thesis = true;  ///< whether the thesis's solver, whose floor is a lattice of spheres, can be asked
};

Errors bounce(const MakeLab& lab) {
  double worst = 0.0;
  for (const double drop : {0.3, 0.437, 0.6})
    worst = std::max(worst, std::abs(testing::bounce(lab(), drop, 0.9) / 0.81 - 1.0));
  return {worst};
}

/// Angle at which a box begins to slip (a tenth of a millimetre in a second: 0.001 degree more than what it takes to
/// move at all), by bisection to 0.001 degree.
Errors friction_angle(const MakeLab& lab) {
  double worst = 0.0;
  for (const double heading : {0.0, 0.4, 0.25 * M_PI}) {
    double sticks = std::atan(0.5) - 0.1, slips = std::atan(0.5) + 0.1;
    for (int i = 0; i < 14; ++i) {
      const double middle = 0.5 * (sticks + slips);
      (testing::slip(lab(), middle, heading) > 1e-4 ? slips : sticks) = middle;
    }
    worst = std::max(worst, std::abs(0.5 * (sticks + slips) - std::atan(0.5)) * 180.0 / M_PI);
  }
  return {worst};
}

Errors collision(const MakeLab& lab) {
  double momentum = 0.0, energy = 0.0;
  for (const double restitution : {0.0, 0.5, 1.0}) {
    const testing::Collision change = testing::collide(lab(), restitution);
    if (change.push < 0.1) throw environment_error("the two boxes did not meet", "collision", "report this");
    momentum = std::max(momentum, change.momentum);
    energy = std::max(energy, change.energy - 1.0);
  }
  return {momentum, energy};
}

Errors tumble(const MakeLab& lab) {
  const testing::Tumble result = testing::tumble(lab());
  return {std::max(result.highest - 1.0, 1.0 - result.lowest), result.highest - 1.0, result.spin};
}

Errors brick_stacks(const MakeLab& lab) {
  const std::vector<double> drifts = testing::brick_stack_drifts(lab, 30.0);
  const double mean = std::accumulate(drifts.begin(), drifts.end(), 0.0) / static_cast<double>(drifts.size());
  return {mean, *std::max_element(drifts.begin(), drifts.end())};
}

Errors rods(const MakeLab& lab) {
  const testing::Rods speeds = testing::meet_along_rods(lab());
  return {std::max(std::abs(speeds.first), std::abs(speeds.second - 1.0))};
}

const Form forms[] = {
    {[](const MakeLab& lab) { return Errors{testing::free_fall(lab()).distance}; }, {{"free_fall", "rel", 1e-4}}},
    {bounce, {{"bounce_0.9", "rel", 1e-2}}, true},
    {[](const MakeLab& lab) { return Errors{testing::slide(lab()).distance}; }, {{"sliding_distance", "rel", 5e-3}}},
    {friction_angle, {{"friction_angle", "deg", 0.5}}, false, false},
    {[](const MakeLab& lab) { return Errors{testing::roll(lab())}; }, {{"rolling_15_deg", "rel", 2e-3}}, true},
    {collision, {{"collision_momentum", "rel", 1e-5}, {"collision_energy_gain", "rel", 1e-5}}},
    {tumble, {{"tumbling_energy", "rel", 1e-3}, {"tumbling_energy_gain", "rel", 1e-4}, {"tumbling_spin", "rel", 1e-3}}},
    {[](const MakeLab& lab) { return Errors{testing::stack_drift(lab(), 30.0)}; },
     {{"stack_10_boxes_30_s", "edge", 1e-3}},
     false,
     false},
    {brick_stacks, {{"brick_stacks_mean", "edge", 1e-3}, {"brick_stacks_worst", "edge", 1e-3}}, false, false},
    {rods, {{"two_rods", "rel", 1e-2}}}};

/// Errors, and the mean step that was simulated. In a process of its own: a GL context would not survive later forks,
/// and a solver that fails takes no other along.
Row measured(const Form& form, const std::string& solver) {
  Request request;
  choose_solver(request, solver);
  if (form.ball) request.solver.thesis.voxels = 1;
  const auto work = [&] {
    Lab::Count count;
    const Errors errors = form.measure([&] { return Lab(solver_of({request, {}}), &count); });
    Row row;
    for (std::size_t i = 0; i < errors.size(); ++i) row.measure(form.quantities[i].name, errors[i]);
    return row.info("step_s", count.seconds / static_cast<double>(count.steps));
  };
  return isolated(work).row;
}

void run(Run& out) {
  for (const Form& form : forms)
    for (const std::string solver : {"sphere", "bullet", "sphere/thesis"}) {
      if (solver == "sphere/thesis" && !form.thesis) continue;
      const auto wanted = [&](const Quantity& q) { return out.wanted(Row::keys("form", q.name, "solver", solver)); };
      if (std::none_of(form.quantities.begin(), form.quantities.end(), wanted)) continue;
      const Row errors = measured(form, solver);
      for (const Quantity& q : form.quantities) {
        const double error = errors.number(q.name);
        Row row = Row::keys("form", q.name, "solver", solver).info("step_s", errors.at("step_s"));
        row.measure("error", error).info("unit", q.unit).info("goal", q.goal).info("met", error <= q.goal);
        if (const std::string why = errors.at("status"); !why.empty()) row.status(why);
        out.row(row);
      }
    }
}

const Registration registration{
    "closed_forms", "error against closed forms, default settings", {"form", "solver"}, run};

}  // namespace
}  // namespace bin_scenes::bench
