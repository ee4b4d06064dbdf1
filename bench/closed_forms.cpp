/// Error against closed forms over time steps, every solver with its default settings otherwise. The scenes are those
/// the tests hold to the project's goals (test/solver/closed_form_scenes.hpp).
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "framework/statistics.hpp"
#include "runs.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/closed_form_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace bin_scenes::bench {
namespace {

using testing::Lab;
using MakeLab = std::function<Lab()>;
using Errors = std::vector<double>;

struct Quantity {
  const char *name, *unit;  ///< "rel": of the exact value
  double goal;              ///< at default settings; the measure's tolerance
};

constexpr double rounding = 1e-5;  ///< of single precision: errors below say nothing about the step

struct Form {
  std::vector<Quantity> quantities;
  Errors (*measure)(const MakeLab& lab);  ///< their errors
  bool ball;                              ///< a ball alone: one sphere for the thesis's solver
  bool thesis;        ///< whether the thesis's solver, whose floor is a lattice of spheres, can be asked
  bool dear = false;  ///< quick forms take default steps only
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
    {{{"free_fall", "rel", 1e-4}},
     [](const MakeLab& lab) { return Errors{testing::free_fall(lab()).way}; },
     false,
     true},
    {{{"bounce_0.9", "rel", 1e-2}}, bounce, true, true},
    {{{"sliding_distance", "rel", 5e-3}},
     [](const MakeLab& lab) { return Errors{testing::slide(lab()).way}; },
     false,
     true},
    {{{"friction_angle", "deg", 0.5}}, friction_angle, false, false},
    {{{"rolling_15_deg", "rel", 2e-3}}, [](const MakeLab& lab) { return Errors{testing::roll(lab())}; }, true, true},
    {{{"collision_momentum", "rel", 1e-5}, {"collision_energy_gain", "rel", 1e-5}}, collision, false, true},
    {{{"tumbling_energy", "rel", 1e-3}, {"tumbling_energy_gain", "rel", 1e-4}, {"tumbling_spin", "rel", 1e-3}},
     tumble,
     false,
     true},
    {{{"stack_10_boxes_30_s", "edge", 1e-3}},
     [](const MakeLab& lab) { return Errors{testing::stack_drift(lab(), 30.0)}; },
     false,
     false},
    {{{"brick_stacks_mean", "edge", 1e-3}, {"brick_stacks_worst", "edge", 1e-3}}, brick_stacks, false, false, true},
    {{{"two_rods", "rel", 1e-2}}, rods, false, true}};

/// Default settings, or steps of this length that nothing cuts.
Request settings_of(const std::string& solver, std::optional<double> time_step, bool ball) {
  Request request;
  choose_solver(request, solver);
  SolverSettings& s = request.solver;
  if (time_step) {
    s.sphere.time_step = s.bullet.time_step = s.thesis.time_step = *time_step;
    s.sphere.cut_steps = s.bullet.cut_steps = false;
  }
  if (ball) s.thesis.voxels = 1;
  return request;
}

/// Errors, and the mean step that was simulated. In a process of its own: a GL context would not survive later forks,
/// and a solver that fails takes no other along.
Row measured(const Form& form, const Request& request) {
  return isolated([&] {
           Lab::Count count;
           const std::vector<double> errors = form.measure([&] {
             std::string reason;
             return Lab(make_solver(request, {}, reason), &count);
           });
           Row row;
           for (std::size_t i = 0; i < errors.size(); ++i) row.measure(form.quantities[i].name, errors[i]);
           return row.info("step_s", count.seconds / static_cast<double>(count.steps));
         })
      .row;
}

/// The slope of error over step in doubled logarithms, where a line explains nine tenths of how they vary. What grows
/// as steps get shorter is rounding that adds up.
std::string order_of(const std::vector<double>& steps, const std::vector<double>& errors) {
  constexpr std::size_t fewest = 4;
  const bool line = steps.size() >= fewest && explained_by_exponent(steps, errors) >= 0.9;
  const double order = fitted_exponent(steps, errors);
  return line && order > 0.0 ? Row::text(order) : "no order";
}

void run(Run& out) {
  std::vector<double> rates = {30, 60, 120, 240, 400, 480, 1000};
  if (out.quick()) rates = {60, 240, 1000};
  std::vector<std::optional<double>> time_steps = {std::nullopt};
  for (const double rate : rates) time_steps.emplace_back(1.0 / rate);
  for (const Form& form : forms)
    for (const std::string solver : {"sphere", "bullet", "sphere/thesis"}) {
      if (solver == "sphere/thesis" && !form.thesis) continue;
      std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> curves;
      for (const std::optional<double>& time_step : time_steps) {
        if (out.quick() && form.dear && time_step) continue;
        const auto key = [&](const std::string& name) {
          return Row()
              .key("form", name)
              .key("solver", solver)
              .key("time_step_s", time_step ? Row::text(*time_step) : "default");
        };
        if (std::none_of(form.quantities.begin(), form.quantities.end(),
                         [&](const Quantity& q) { return out.wanted(key(q.name)); }))
          continue;
        const Row errors = measured(form, settings_of(solver, time_step, form.ball));
        for (const Quantity& q : form.quantities) {
          const double error = errors.number(q.name), step = errors.number("step_s");
          Row row = key(q.name);
          row.info("step_s", step).measure("error", error).info("unit", q.unit).info("goal", q.goal);
          if (!time_step) row.info("met", error <= q.goal ? "yes" : "no");
          if (const std::string why = errors.at("status"); !why.empty()) row.status(why);
          out.row(row);
          if (!time_step || !(error >= rounding)) continue;
          curves[q.name].first.push_back(step);
          curves[q.name].second.push_back(error);
        }
      }
      for (const Quantity& q : form.quantities) {
        const auto& [steps, errors] = curves[q.name];
        const Row key = Row().key("form", q.name).key("solver", solver).key("time_step_s", "all");
        if (out.wanted(key)) out.row(Row(key).info("order", order_of(steps, errors)));
      }
    }
}

const Registration registration{"closed_forms",
                                "error against closed forms over time steps, with its order",
                                {"form", "solver", "time_step_s"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
