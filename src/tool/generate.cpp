/// The command `generate`: options over the request, scenes that are there already, progress, trace. Folders are
/// written by scene_store.cpp.
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/output/trace.hpp"
#include "bin_scenes/pour/contact_action.hpp"
#include "dataset/scene_store.hpp"
#include "tool/commands.hpp"
#include "tool/interrupt.hpp"
#include "tool/progress_bar.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>

namespace bin_scenes {

namespace {

/// The options that stand for keys of the request.
std::vector<Override> overrides_of(const GenerateOptions& options) {
  for (const std::string& item : options.set) {
    if (item.find('=') == std::string::npos) {
      throw input_error("expected key=value, found '" + item + "'", "--set", "put the request before the options");
    }
  }
  std::vector<Override> overrides(options.set.begin(), options.set.end());
  const auto add = [&](const char* option, const char* key, const std::optional<std::string>& value) {
    if (value) overrides.emplace_back(std::string(key) + "=" + *value, option);
  };
  add("--seed", "seed", options.seed);
  add("--scenes", "scenes", options.scenes);
  add("--first", "first", options.first);
  add("--solver", "solver.type", options.solver);
  add("--seconds", "seconds", options.seconds);
  return overrides;
}

/// Runs of consecutive indices that have to be made: [first, count].
std::vector<std::pair<std::size_t, std::size_t>> missing_runs(const Request& request,
                                                              const std::set<std::size_t>& there) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  std::size_t next = request.first;
  for (const std::size_t index : there) {
    if (index > next) runs.emplace_back(next, index - next);
    next = index + 1;
  }
  const std::size_t end = request.first + request.scenes;
  if (next < end) runs.emplace_back(next, end - next);
  return runs;
}

std::string text_of(const Progress& progress) {
  std::ostringstream text;
  text << "scene " << progress.scene << " " << progress.phase;
  if (progress.simulated_s > 0)  // other phases know nothing of rest
    text << std::fixed << std::setprecision(2) << ": " << progress.resting << " of " << progress.parts
         << " parts at rest, " << progress.simulated_s << " s simulated";
  return text.str();
}

void print_details(const Scene& scene) {
  const Report& r = scene.report;
  std::printf("scene %zu: %s, %zu parts, %.3f s simulated in %.3f s (%llu steps), %s on %s\n", scene.index,
              r.accepted ? "accepted" : "set apart", scene.parts.size(), r.simulated_s, r.wall_s,
              static_cast<unsigned long long>(r.steps), r.solver.c_str(), r.device.c_str());
  std::printf("  %s\n", r.solver_reason.c_str());
  std::printf("  penetration p95 %.4f %%, max %.4f %% of a part; gap p95 %.4f mm\n", 100 * r.penetration.p95_relative,
              100 * r.penetration.max_relative, 1e3 * r.gap.p95);
  for (const auto& [stage, ms] : r.profile.stages_ms) std::printf("  %-32s %12.2f ms\n", stage.c_str(), ms);
  for (const auto& [counter, n] : r.profile.counters) {
    std::printf("  %-32s %12llu\n", counter.c_str(), static_cast<unsigned long long>(n));
  }
  for (const Flag& flag : r.flags) {
    std::printf("  flag %s: %s (%s)\n", flag.code.c_str(), flag.text.c_str(), flag.remedy.c_str());
  }
  std::fflush(stdout);
}

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  return text.empty() ? "no reason given" : text;
}

void print_set_apart(const std::vector<std::pair<std::size_t, std::string>>& apart, std::size_t scenes,
                     const std::string& out) {
  std::fprintf(stderr, "bin_scenes: %zu of %zu scenes set apart in %s/set_apart\n", apart.size(), scenes, out.c_str());
  for (const auto& [index, reasons] : apart) std::fprintf(stderr, "  scene_%06zu: %s\n", index, reasons.c_str());
}

McapProfile mcap_profile(const GenerateOptions& options) {
  if (!options.mcap) return McapProfile::ros1;
  if (std::find(options.formats.begin(), options.formats.end(), "mcap") == options.formats.end() &&
      std::filesystem::path(options.trace).extension() != ".mcap") {
    throw input_error("says which MCAP file to write, but neither --formats nor --trace names one", "--mcap",
                      "add --formats json,mcap or --trace FILE.mcap");
  }
  return mcap_profile_of(*options.mcap, "--mcap");
}

/// Refuses options that the request cannot serve, and reports what they leave out.
void check_options(const GenerateOptions& options, const Request& request, bool needs_sensors) {
  const auto asked = [&](const char* format) {
    return std::find(options.formats.begin(), options.formats.end(), format) != options.formats.end();
  };
  if (asked("grasps") && request.grippers.empty()) {
    throw input_error("grasps are requested, but the request has no grippers", options.request,
                      "add for instance `grippers: [robotiq_2f_85]`");
  }
  if (needs_sensors && request.sensors.empty()) {
    throw input_error("the formats show what a sensor sees, but the request has no sensors", options.request,
                      "add `sensors: [{name: camera}]`, or ask for --formats json,bag,mcap alone");
  }
  if (asked("bop")) {
    for (const Sensor& sensor : request.sensors) {
      const std::string why = bop_misfit(sensor);
      if (!why.empty()) throw input_error(why, "sensors: " + sensor.name, bop_misfit_remedy);
    }
    if (const std::string loss = bop_loss(request.sensors); !loss.empty())
      std::fprintf(stderr, "bin_scenes: note: %s\n", loss.c_str());
  }
  if (!options.trace.empty() && request.scenes != 1) {
    throw input_error("a trace holds one scene, but " + std::to_string(request.scenes) + " are asked for", "--trace",
                      "add --scenes 1, and --first to choose which");
  }
  if (!(options.trace_rate >= 1e-3 && options.trace_rate <= 1e6)) {  // not a number fails too
    throw input_error("must be at least 0.001 and at most 1000000 rows a second", "--trace-rate", "100 is the default");
  }
}

/// Feeds the trace from the hooks of a run.
class Tracing {
 public:
  Tracing(std::unique_ptr<Trace> trace, const Generator& generator) : trace_(std::move(trace)), generator_(generator) {}
  void hook(RunHooks& hooks, double rate) {
    hooks.trace_rate = rate;
    hooks.trace = [this](std::size_t, double time, const std::vector<BodyState>& states) { add(time, states); };
    if (!trace_->shows_contacts()) return;
    hooks.trace_contacts = [this](const std::vector<ContactForce>& forces) { forces_ = forces; };
  }
  void finish() { trace_->finish(); }

 private:
  void add(double time, const std::vector<BodyState>& states) {
    if (!begun_) trace_->begin(generator_.loaded());
    begun_ = true;
    sample_.time = time;
    sample_.parts.resize(states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      sample_.parts[i].id = static_cast<int>(i);
      sample_.parts[i].pose = states[i].pose;
      sample_.parts[i].velocity = states[i].velocity;
    }
    if (trace_->shows_contacts()) sample_.contacts = contacts_of(forces_, before_, states, generator_.loaded());
    before_ = states;
    trace_->add(sample_);
  }

  std::unique_ptr<Trace> trace_;
  const Generator& generator_;
  TraceSample sample_;
  std::vector<ContactForce> forces_;  ///< at the time of the next sample
  std::vector<BodyState> before_;     ///< of the previous sample
  bool begun_ = false;
};

}  // namespace

int generate(const GenerateOptions& options) {
  // Nothing is half-written, since files appear whole, and the next run removes what is left under hidden names.
  const std::atomic<bool>& interrupted = stop_on_signals(500'000, "bin_scenes: cancelled; finished scenes are kept\n");
  const CancelScope scope(&interrupted);
  Request request = read_request(options.request, overrides_of(options));
  const McapProfile profile = mcap_profile(options);
  SceneStore store(options.out, options.formats, profile, options.verify);
  check_options(options, request, store.needs_sensors());

  std::set<std::size_t> there;
  std::vector<std::pair<std::size_t, std::string>> apart;
  if (!options.overwrite) {
    for (const std::size_t index : store.indices(request)) {
      const SceneStore::Found found = store.find(index, request);
      if (!options.trace.empty() || found == SceneStore::Found::nothing) continue;  // to trace it is to make it again
      there.insert(index);
      if (found == SceneStore::Found::set_apart) apart.emplace_back(index, joined(store.reasons(index)));
    }
  }
  const std::size_t scenes = request.scenes;
  if (!there.empty()) {
    std::fprintf(stderr, "bin_scenes: %zu of %zu scenes are there already and are kept\n", there.size(), scenes);
  }

  Generator generator;
  ProgressBar bar;
  std::optional<Tracing> trace;
  Generator::Options run;
  run.render = store.needs_images();
  run.gray = store.needs_gray();
  run.grasps = store.needs_grasps();
  run.hooks.cancel = &interrupted;
  run.hooks.progress = [&](const Progress& progress) { bar.show(progress.fraction, text_of(progress)); };
  if (!options.trace.empty()) {
    trace.emplace(open_trace(options.trace, request, profile), generator);
    trace->hook(run.hooks, options.trace_rate);
  }
  for (const auto& [first, count] : missing_runs(request, there)) {
    request.first = first;
    request.scenes = count;
    run.prepare = [&](Generator::Result& result) { store.prepare(result, generator); };
    generator.generate(request, run, [&](Generator::Result&& result) {
      store.commit(result, request, generator);
      const Report& report = result.scene.report;
      if (!report.accepted) apart.emplace_back(result.scene.index, joined(report.reasons));
      bar.clear();
      if (options.verbose) print_details(result.scene);
    });
  }
  if (trace) trace->finish();
  bar.clear();

  if (apart.empty()) return exit_done;
  print_set_apart(apart, scenes, options.out);
  return exit_set_apart;
}

}  // namespace bin_scenes
