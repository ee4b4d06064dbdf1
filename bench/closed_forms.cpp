/// Error against closed forms over time steps, every solver with its default settings otherwise. The scenes are those
/// the tests hold to the project's goals (test/solver/closed_form_scenes.hpp).
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "framework/statistics.hpp"
#include "requests.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/closed_form_scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>

namespace bin_scenes::bench {
namespace {

using testing::Lab;
using MakeLab = std::function<Lab()>;

struct Value {
  std::string form;
  double error;
  std::string unit;  ///< "rel": of the exact value
  double goal;       ///< at default settings; the measure's tolerance
};

constexpr double rounding = 1e-5;  ///< of single precision: errors below say nothing about the step

struct Form {
  std::vector<std::string> names;  ///< of the values that one measurement gives
  std::vector<Value> (*measure)(const MakeLab& lab);
  bool ball;    ///< a ball alone: one sphere for the thesis's solver
  bool thesis;  ///< whether the thesis's solver, whose floor is a lattice of spheres, can be asked
};

std::vector<Value> free_fall(const MakeLab& lab) {
  return {{"free_fall", testing::free_fall(lab()).way, "rel", 1e-4}};
}

std::vector<Value> bounce(const MakeLab& lab) {
  double worst = 0.0;
  for (const double drop : {0.3, 0.437, 0.6})
    worst = std::max(worst, std::abs(testing::bounce(lab(), drop, 0.9) / 0.81 - 1.0));
  return {{"bounce_0.9", worst, "rel", 1e-2}};
}

std::vector<Value> slide(const MakeLab& lab) {
  return {{"sliding_distance", testing::slide(lab()).way, "rel", 5e-3}};
}

/// Angle at which a box begins to slip (a millimetre in a second), by bisection.
std::vector<Value> friction_angle(const MakeLab& lab) {
  double worst = 0.0;
  for (const double heading : {0.0, 0.4, 0.25 * M_PI}) {
    double sticks = std::atan(0.5) - 0.1, slips = std::atan(0.5) + 0.1;
    for (int i = 0; i < 9; ++i) {
      const double middle = 0.5 * (sticks + slips);
      (testing::slip(lab(), middle, heading) > 1e-3 ? slips : sticks) = middle;
    }
    worst = std::max(worst, std::abs(0.5 * (sticks + slips) - std::atan(0.5)) * 180.0 / M_PI);
  }
  return {{"friction_angle", worst, "deg", 0.5}};
}

std::vector<Value> roll(const MakeLab& lab) {
  return {{"rolling_15_deg", testing::roll(lab()), "rel", 2e-3}};
}

std::vector<Value> collision(const MakeLab& lab) {
  double momentum = 0.0, energy = 0.0;
  for (const double restitution : {0.0, 0.5, 1.0}) {
    const testing::Collision change = testing::collide(lab(), restitution);
    if (change.push < 0.1) throw environment_error("the two boxes did not meet", "collision", "report this");
    momentum = std::max(momentum, change.momentum);
    energy = std::max(energy, change.energy - 1.0);
  }
  return {{"collision_momentum", momentum, "rel", 1e-5}, {"collision_energy_gain", energy, "rel", 1e-5}};
}

std::vector<Value> tumble(const MakeLab& lab) {
  const testing::Tumble result = testing::tumble(lab());
  return {{"tumbling_energy", std::max(result.highest - 1.0, 1.0 - result.lowest), "rel", 1e-3},
          {"tumbling_energy_gain", result.highest - 1.0, "rel", 1e-4},
          {"tumbling_spin", result.spin, "rel", 1e-3}};
}

std::vector<Value> stack(const MakeLab& lab) {
  return {{"stack_10_boxes_30_s", testing::stack_drift(lab(), 30.0), "edge", 1e-3}};
}

std::vector<Value> brick_stacks(const MakeLab& lab) {
  const std::vector<double> drifts = testing::brick_stack_drifts(lab, 30.0);
  const double mean = std::accumulate(drifts.begin(), drifts.end(), 0.0) / static_cast<double>(drifts.size());
  return {{"brick_stacks_mean", mean, "edge", 1e-3},
          {"brick_stacks_worst", *std::max_element(drifts.begin(), drifts.end()), "edge", 1e-3}};
}

std::vector<Value> rods(const MakeLab& lab) {
  const testing::Rods speeds = testing::meet_along_rods(lab());
  return {{"two_rods", std::max(std::abs(speeds.first), std::abs(speeds.second - 1.0)), "rel", 1e-2}};
}

const Form forms[] = {{{"free_fall"}, free_fall, false, true},
                      {{"bounce_0.9"}, bounce, true, true},
                      {{"sliding_distance"}, slide, false, true},
                      {{"friction_angle"}, friction_angle, false, false},
                      {{"rolling_15_deg"}, roll, true, true},
                      {{"collision_momentum", "collision_energy_gain"}, collision, false, true},
                      {{"tumbling_energy", "tumbling_energy_gain", "tumbling_spin"}, tumble, false, true},
                      {{"stack_10_boxes_30_s"}, stack, false, false},
                      {{"brick_stacks_mean", "brick_stacks_worst"}, brick_stacks, false, false},
                      {{"two_rods"}, rods, false, true}};

Lab lab_of(const std::string& solver, double time_step, bool ball) {
  Request request;
  choose_solver(request, solver);
  request.solver.sphere.time_step = request.solver.bullet.time_step = request.solver.thesis.time_step = time_step;
  if (ball) request.solver.thesis.voxels = 1;
  std::string reason;
  return Lab(make_solver(request, {}, reason));
}

/// In a process of its own: a GL context would not survive later forks, and a solver that fails takes no other along.
std::vector<Value> measured(const Form& form, const std::string& solver, double time_step, Row& failure) {
  std::vector<Value> values;
  const Isolated one = isolated([&] {
    Row row;
    for (const Value& v : form.measure([&] { return lab_of(solver, time_step, form.ball); }))
      row.key(v.form + " " + v.unit + " " + Row::text(v.goal), v.error);
    return row;
  });
  if (!one.good) {
    failure = one.row;
    return {};
  }
  for (const auto& [column, text] : one.row.cells()) {
    const std::size_t first = column.name.find(' '), second = column.name.rfind(' ');
    values.push_back({column.name.substr(0, first), std::strtod(text.c_str(), nullptr),
                      column.name.substr(first + 1, second - first - 1),
                      std::strtod(column.name.c_str() + second, nullptr)});
  }
  return values;
}

void run(Run& out) {
  std::vector<double> rates = {30, 60, 120, 240, 400, 480, 1000};  // the defaults, 240 and 400, among them
  if (out.quick()) rates = {60, 240, 1000};
  for (const Form& form : forms)
    for (const std::string solver : {"sphere", "bullet", "sphere/thesis"}) {
      if (solver == "sphere/thesis" && !form.thesis) continue;
      std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> fits;
      for (const double rate : rates) {
        const auto wanted = [&](const std::string& name) {
          return out.wanted(Row().key("form", name).key("solver", solver).key("time_step_s", 1.0 / rate));
        };
        if (std::none_of(form.names.begin(), form.names.end(), wanted)) continue;
        Row failure;
        const std::vector<Value> values = measured(form, solver, 1.0 / rate, failure);
        if (values.empty()) out.row(Row().key("solver", solver).key("time_step_s", 1.0 / rate).append(failure));
        for (const Value& v : values) {
          out.row(Row()
                      .key("form", v.form)
                      .key("solver", solver)
                      .key("time_step_s", 1.0 / rate)
                      .measure("error", v.error)
                      .info("unit", v.unit)
                      .info("goal", v.goal));
          if (v.error < rounding) continue;
          fits[v.form].first.push_back(1.0 / rate);
          fits[v.form].second.push_back(v.error);
        }
      }
      for (const auto& [name, fit] : fits)
        if (fit.first.size() > 1)
          out.row(Row()
                      .key("form", name)
                      .key("solver", solver)
                      .key("time_step_s", "all")
                      .info("order", fitted_exponent(fit.first, fit.second)));
    }
}

const Registration registration{"closed_forms", "error against closed forms over time steps, with its order", run};

}  // namespace
}  // namespace bin_scenes::bench
