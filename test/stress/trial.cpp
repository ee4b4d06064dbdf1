#include "stress/trial.hpp"

#include "stress/watch.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"

#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

namespace bin_scenes::stress {

namespace {

constexpr double trace_rate = 120.0;     ///< Hz
constexpr double growth_allowed = 64e3;  ///< bytes: a few log lines, not a scene
constexpr double pace_allowed = 2.0;     ///< what grows with every scene takes six times as long in the last tenth
constexpr double pace_slack = 0.05;      ///< s: the clock of CPU time may tick but every 4 ms

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * share);
  return text;
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Bytes that malloc has handed out; large blocks are mapped, and counted by themselves.
double bytes_in_use() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

/// What the scene's own report says, held against what must be.
void judge_scene(const Scene& scene, const LoadedRequest& loaded, const Expect& expect, Outcome& outcome) {
  const Request& request = loaded.request;
  const std::vector<PartModelPtr>& parts = loaded.parts;
  const auto fails = [&](const std::string& what) {
    if (std::find(outcome.failures.begin(), outcome.failures.end(), what) == outcome.failures.end())
      outcome.failures.push_back(what);
  };
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (const PartModelPtr& part : parts) {
    smallest = std::min(smallest, part->diagonal());
    largest = std::max(largest, part->diagonal());
  }
  const Report& report = scene.report;
  outcome.simulated_s += report.simulated_s;
  outcome.steps += report.steps;
  outcome.device = report.device;
  for (const Flag& flag : report.flags)
    if (flag.code == "energy_gained" || flag.code == "part_thrown" || flag.code == "part_jammed")
      outcome.flags.push_back(flag.text);
  double highest = -std::numeric_limits<double>::infinity();
  for (const ScenePart& part : scene.parts) {
    if (part.state == PartState::fixed) continue;
    ++outcome.parts;
    outcome.resting += part.state == PartState::resting;
    if (part.state == PartState::not_poured) continue;  // it has no pose
    if (!part.pose.finite()) fails("not finite");
    highest = std::max(highest, (part.pose * parts[part.line]->mass().center).z());
  }
  const double depth =
      std::max(report.penetration.max_relative, report.penetration.bin_max / std::max(smallest, 1e-300));
  outcome.penetration = std::max(outcome.penetration, depth);
  if (depth > expect.penetration) fails("overlap " + percent(depth));
  if (!expect.spills && report.escaped.size() != expect.escapes)
    fails("escaped " + std::to_string(report.escaped.size()) + " of " + std::to_string(scene.parts.size()) +
          (expect.escapes ? ", expected " + std::to_string(expect.escapes) : ""));
  if (expect.all_in && !report.not_poured.empty())
    fails("not poured " + std::to_string(report.not_poured.size()) + " of " + std::to_string(scene.parts.size()));
  if (expect.rests && !report.at_rest) fails("did not come to rest");
  if (report.drift.measured && report.at_rest) {
    outcome.drift = std::max(outcome.drift, report.drift.max / largest);
    if (report.drift.max > stays * largest) fails("called resting, moved on by " + percent(report.drift.max / largest));
  }
  if (!(highest >= expect.height)) fails("fell down");
  if (!(highest <= expect.ceiling)) fails("did not land");
  if (expect.side) {
    const ScenePart &part = scene.parts[0], &other = scene.parts[1];
    const Vec3 center = part.pose * parts[part.line]->mass().center;
    if (!(expect.side->dot(other.pose.inverse() * center - parts[other.line]->mass().center) > 0.0))
      fails("went through");
  }
  if (request.seconds && std::abs(report.simulated_s - *request.seconds) > 0.1) fails("did not keep the set time");
}

}  // namespace

std::string request_text(const Case& c, const std::string& solver) {
  Request request = c.request;
  request.pour.finish = Pour::Finish::probed;  // the suite asks for the last finish there is
  request.solver.type = solver == "bullet" ? SolverType::bullet : SolverType::sphere;
  if (solver == "thesis") request.solver.preset = SolverSettings::Preset::thesis;
  if (solver == "sphere/gpu") request.solver.sphere.device = SphereSettings::Device::gpu;
  // A scene that says it rests is taken at its word, and re-run from its poses.
  request.drift_check = !request.seconds && !c.expect.refused && request.scenes == 1;
  for (PartLine& line : request.parts) line.model = "models/" + line.model + ".obj";
  if (request.bin.kind == Bin::Kind::mesh) request.bin.mesh = "models/" + request.bin.mesh + ".obj";
  return write_request(request);
}

void judge_growth(const std::vector<double>& cpu, const std::vector<double>& in_use, Outcome& outcome) {
  const std::size_t n = in_use.size(), tenth = n / 10;
  if (tenth == 0) return;
  // In each quarter but the first, which warms up: a buffer that is enlarged once is no leak.
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < 4; ++k) least = std::min(least, in_use[(k + 1) * n / 4 - 1] - in_use[k * n / 4 - 1]);
  outcome.growth_bytes = 3.0 * least;
  if (outcome.growth_bytes > growth_allowed)
    outcome.failures.push_back("memory in use grew by " + with("", outcome.growth_bytes) + " bytes");
  const double second = cpu[2 * tenth] - cpu[tenth], last = cpu[n] - cpu[n - tenth];
  outcome.pace = last / std::max(1e-9, second);
  if (last > pace_allowed * second + pace_slack)
    outcome.failures.push_back("the last tenth took " + with("", outcome.pace) + " times as long as the second");
}

Outcome run_here(const std::string& yaml, const std::string& directory, const Expect& expect) {
  Outcome outcome;
  try {
    const Request request = read_request_text(yaml, directory);
    Generator generator;
    std::unique_ptr<Watch> watch;
    Generator::Options options;
    options.render = false;
    if (expect.traced) {
      options.hooks.trace_rate = trace_rate;
      options.hooks.trace = [&](std::size_t, double time, const std::vector<BodyState>& states) {
        if (time == 0.0) watch = std::make_unique<Watch>(generator.loaded());
        watch->observe(states);
      };
    }
    std::vector<double> cpu = {cpu_seconds()}, in_use;
    cpu.reserve(request.scenes + 1), in_use.reserve(request.scenes);  // or they grow themselves
    generator.generate(request, options, [&](Generator::Result&& result) {
      judge_scene(result.scene, generator.loaded(), expect, outcome);
      if (watch) {
        outcome.energy = std::max(outcome.energy, watch->energy_gain());
        if (!watch->finite()) outcome.failures.push_back("velocity not finite");
        if (watch->energy_gain() > expect.energy)
          outcome.failures.push_back("energy +" + percent(watch->energy_gain()));
        if (watch->momentum_change() > expect.momentum)
          outcome.failures.push_back("momentum changed by " + percent(watch->momentum_change()));
        if (watch->top_speed() > expect.speed)
          outcome.failures.push_back("as fast as " + with("", watch->top_speed()) + " m/s");
      }
      cpu.push_back(cpu_seconds());
      in_use.push_back(bytes_in_use());
    });
    if (expect.refused) outcome.failures.push_back("was not refused");
    if (expect.flat) judge_growth(cpu, in_use, outcome);
  } catch (const Error& error) {
    if (!expect.refused || error.kind() != ErrorKind::input || error.remedy().empty())
      outcome.failures.push_back(std::string("error: ") + error.what());
  } catch (const std::exception& error) {
    outcome.failures.push_back(std::string("exception: ") + error.what());
  }
  return outcome;
}

}  // namespace bin_scenes::stress
