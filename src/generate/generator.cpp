/// Loads what a request names, makes its solver, and lets heaps settle; what then follows for a scene is the same
/// whether it was poured or picked from. Judging and rendering are done by other threads (finishing.hpp).
#include "bin_scenes/generate/generator.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "generate/finishing.hpp"
#include "generate/model_store.hpp"
#include "generate/proving.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

constexpr double drift_seconds = 0.5;  ///< simulated time of the drift check

// Shares of a scene in the progress bar: pouring takes nearly all of the time.
constexpr double load_share = 0.02, pour_share = 0.90;

/// Passes progress on with one fraction for the whole request, which never falls, and asks whether to go on.
class Reporter {
 public:
  Reporter(const RunHooks& hooks, std::size_t scenes) : hooks_(hooks), scenes_(static_cast<double>(scenes)) {}

  void phase(const std::string& name, std::size_t scene, std::size_t parts) {
    stop_if_cancelled();
    Progress progress;
    progress.phase = name;
    progress.scene = scene;
    progress.parts = parts;
    report(progress);
  }
  void poured(Progress progress) {
    poured_ = progress.fraction;
    report(progress);
  }
  void handed_on() { ++handed_on_; }

 private:
  void report(Progress progress) {
    if (poured_ > 0.0) {
      const double after = (1.0 - load_share - pour_share) * static_cast<double>(handed_on_) / scenes_;
      fraction_ = std::max(fraction_, std::min(load_share + pour_share * poured_ + after, 1.0));
    }
    progress.fraction = fraction_;
    if (hooks_.progress) hooks_.progress(progress);
  }

  const RunHooks& hooks_;
  double scenes_, fraction_ = 0.0;
  double poured_ = 0.0;        ///< share of all pouring
  std::size_t handed_on_ = 0;  ///< scenes
};

/// The request that goes on from a finished scene for `seconds`; `kept` are the scene's parts that take part, in the
/// order of the new request. Parts that escaped or were never poured have nothing to drift from.
Request going_on(const Request& request, const Scene& scene, double seconds, std::vector<std::size_t>& kept) {
  Request next = request;
  next.pour.pattern = Pour::Pattern::given;
  next.seconds = seconds;
  next.bin.motion = {};  // it is over
  for (std::size_t line = 0; line < next.parts.size(); ++line) {
    PartLine& part_line = next.parts[line];
    part_line.motion = {};
    part_line.poses.clear();
    part_line.velocities.clear();
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      const ScenePart& part = scene.parts[i];
      if (part.line != line || part.state == PartState::escaped || !is_there(part.state)) continue;
      part_line.poses.push_back(part.pose);  // from rest, as the drift of a finished scene is defined
      kept.push_back(i);
    }
    part_line.count = part_line.poses.size();
  }
  return next;
}

}  // namespace

struct Generator::State {
  ModelStore models;
  SensorRig rig;
  Grasper grasper;
  HeapProver heap_prover;

  struct Prepared {
    std::shared_ptr<Solver> solver;
    std::string solver_reason;
    Profile spent;
  };
  /// Models and solver of a request, which has been checked.
  Prepared prepare(const Request& request, Reporter& reporter) {
    Prepared prepared;
    {
      StageTimer timer(prepared.spent, "load");
      load(request, reporter);
    }
    StageTimer timer(prepared.spent, "prepare");
    reporter.phase("prepare", request.first, request.part_count());
    prepared.solver = make_solver({request, models.loaded().parts}, prepared.solver_reason);
    return prepared;
  }

  void load(const Request& request, Reporter& reporter) {
    reporter.phase("load", request.first, request.part_count());
    estimate_memory({request});
    models.load(request);
    estimate_memory(models.loaded());
    resolved_sensors(models.loaded());  // says what is wrong before hours of simulation
  }

  static void add_flags_of_bin(const PartModel& bin, Report& report) {
    for (Flag flag : bin.load_report().flags) {
      flag.text = "bin: " + flag.text;
      if (flag.code == "surface_open") flag.remedy = "close it in the modeller";  // a bin takes no thickness
      report.flags.push_back(flag);
    }
  }

  /// A settled heap's scene, with what the report says of models and solver.
  static Scene scene_of(const Heap& heap) {
    Scene scene = heap.scene();
    for (const PartModelPtr& part : heap.parts()) scene.model_sha256.push_back(part->load_report().content_sha256);
    scene.report.solver_reason = heap.solver_reason();
    for (auto part = heap.parts().begin(); part != heap.parts().end(); ++part) {  // a repair matters to each scene
      if (std::find(heap.parts().begin(), part, *part) != part) continue;
      for (const Flag& flag : (*part)->load_report().flags) scene.report.flags.push_back(flag);
    }
    if (const PartModelPtr bin = heap.loaded().bin_model) add_flags_of_bin(*bin, scene.report);
    return scene;
  }

  static void measure_drift(Scene& scene, const LoadedRequest& loaded, const std::shared_ptr<Solver>& solver,
                            const RunHooks& hooks) {
    if (!loaded.request.drift_check) return;
    std::vector<std::size_t> kept;
    const Request next = going_on(loaded.request, scene, drift_seconds, kept);
    if (kept.empty()) return;
    RunHooks quiet;
    quiet.cancel = hooks.cancel;
    Heap again({next, loaded.parts, loaded.bin_model}, solver, scene.index);
    again.settle(quiet);
    const Scene moved = again.scene();
    BIN_SCENES_ASSERT(moved.parts.size() == kept.size());
    Scene before;
    for (const std::size_t i : kept) {
      before.parts.push_back(scene.parts[i]);
      before.parts.back().id = static_cast<int>(before.parts.size()) - 1;  // as the re-run counts them
    }
    scene.report.drift = drift(before, moved, loaded.parts);
  }

  static bool proves(const Request& request, const Options& options) { return options.grasps && request.prove > 0; }

  /// What is done for a scene once it has been poured; in any thread. `sensors`: resolved. `prover`: if proves().
  void finish(Result& result, const LoadedRequest& loaded, const std::vector<Sensor>& sensors, const Options& options,
              Prover* prover) {
    Scene& scene = result.scene;
    Profile spent;
    {
      StageTimer timer(spent, "quality");
      judge(scene, loaded);
    }
    scene.sensors = sensors;
    if (options.render && !sensors.empty()) {
      StageTimer timer(spent, "render");
      result.images = rig.render(scene, loaded, options.gray);
    }
    if (options.grasps) {
      StageTimer timer(spent, "grasps");
      result.grasps = grasper.find(scene, loaded, result.images);
      for (const Flag& flag : flags_of(*result.grasps, loaded.request)) scene.report.flags.push_back(flag);
    }
    if (prover) {
      StageTimer timer(spent, "prove");
      prove_grasps(*result.grasps, scene, loaded, *prover);
    }
    scene.report.profile.merge(spent);
    if (options.prepare) options.prepare(result);
  }
};

Generator::Generator() : state_(std::make_unique<State>()) {}
Generator::~Generator() = default;

const LoadedRequest& Generator::loaded() const {
  return state_->models.loaded();
}

void Generator::generate(const Request& request, const Options& options, const std::function<void(Result&&)>& done) {
  const CancelScope scope(options.hooks.cancel);
  check(request);
  Reporter reporter(options.hooks, request.scenes);
  const State::Prepared prepared = state_->prepare(request, reporter);
  const LoadedRequest& loaded = state_->models.loaded();
  const std::vector<Sensor> sensors = resolved_sensors(loaded);

  const auto prover = State::proves(request, options) ? std::make_unique<Prover>(loaded) : nullptr;

  Finishing finishing([&](Result& result) { state_->finish(result, loaded, sensors, options, prover.get()); },
                      [&](Result&& result) {
                        reporter.handed_on();
                        done(std::move(result));
                      },
                      scenes_seen_at_once(request, estimate_memory(loaded)));

  const SceneList scenes{request.scenes, [&](std::size_t place) { return request.first + place; }};
  RunHooks hooks = options.hooks;
  hooks.progress = [&](const Progress& progress) {
    reporter.poured(progress);
    finishing.hand_on_finished();
  };
  settle_scenes(loaded, prepared.solver, prepared.solver_reason, scenes, hooks, [&](std::size_t place, Heap&& heap) {
    Scene scene = State::scene_of(heap);
    { const Heap over = std::move(heap); }  // its place on the device is free for the drift's
    if (place == 0) scene.report.profile.merge(prepared.spent);
    reporter.phase("quality", scene.index, scene.parts.size());
    State::measure_drift(scene, loaded, prepared.solver, options.hooks);
    finishing.add(place, std::move(scene));
    finishing.hand_on_finished();
  });
  finishing.wait();
}

Heap Generator::heap(const Request& request, const RunHooks& hooks) {
  const CancelScope scope(hooks.cancel);
  check(request);
  Reporter reporter(hooks, 1);
  const State::Prepared prepared = state_->prepare(request, reporter);
  return Heap(state_->models.loaded(), prepared.solver, request.first, prepared.solver_reason);
}

std::vector<NewParts> Generator::new_parts(const Heap& heap, const std::vector<PartLine>& lines,
                                           const RunHooks& hooks) {
  const CancelScope scope(hooks.cancel);
  Request all = heap.request();
  for (const PartLine& line : lines) {
    Request alone = heap.request();
    alone.parts = {line};
    alone.pour.pattern = line.poses.empty() || line.stays() ? Pour::Pattern::rain : Pour::Pattern::given;
    check(alone);
    all.parts.push_back(line);
  }
  Request counted = heap.request();  // the limits of counts hold for all together
  counted.parts = {PartLine()};
  counted.parts[0].model = "all";
  counted.parts[0].count = all.part_count();
  counted.pour.pattern = Pour::Pattern::rain;
  check(counted);
  Reporter reporter(hooks, 1);
  state_->load(all, reporter);
  std::vector<NewParts> parts;
  const std::size_t before = all.parts.size() - lines.size();
  for (std::size_t i = 0; i < lines.size(); ++i) parts.push_back({lines[i], state_->models.loaded().parts[before + i]});
  return parts;
}

Generator::Result Generator::result(const Heap& heap, const Options& options) {
  const CancelScope scope(options.hooks.cancel);
  const LoadedRequest loaded = heap.loaded();
  Reporter reporter(options.hooks, 1);
  Result result;
  result.scene = State::scene_of(heap);
  result.scene.index = options.index.value_or(result.scene.index);
  reporter.phase("quality", result.scene.index, result.scene.parts.size());
  State::measure_drift(result.scene, loaded, heap.solver(), options.hooks);
  Prover* prover = State::proves(loaded.request, options) ? &state_->heap_prover.of(loaded, heap.solver()) : nullptr;
  state_->finish(result, loaded, resolved_sensors(loaded), options, prover);
  return result;
}

}  // namespace bin_scenes
