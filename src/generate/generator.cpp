#include "bin_scenes/generate/generator.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "generate/judging.hpp"
#include "generate/model_store.hpp"

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
    tell(progress);
  }
  void poured(Progress progress) {
    poured_ = progress.fraction;
    tell(progress);
  }
  void handed_on() { ++handed_on_; }

 private:
  void tell(Progress progress) {
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
  for (std::size_t line = 0; line < next.parts.size(); ++line) {
    PartLine& part_line = next.parts[line];
    part_line.poses.clear();
    part_line.velocities.clear();
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      const ScenePart& part = scene.parts[i];
      if (part.line != line || part.state == PartState::escaped || part.state == PartState::not_poured) continue;
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
  std::unique_ptr<RangeCamera> camera;

  void load(const Request& request, Reporter& reporter) {
    reporter.phase("load", request.first, request.part_count());
    estimate_memory(request, {});
    models.load(request);
    estimate_memory(request, models.parts());
  }

  void measure_drift(Scene& scene, const Request& request, Solver& solver, const RunHooks& hooks) {
    std::vector<std::size_t> kept;
    const Request next = going_on(request, scene, drift_seconds, kept);
    if (kept.empty()) return;
    RunHooks quiet;
    quiet.cancel = hooks.cancel;
    const Scene moved = pour(next, models.parts(), solver, {scene.index}, quiet, models.bin()).at(0);
    Scene before;
    for (const std::size_t i : kept) {
      before.parts.push_back(scene.parts[i]);
      before.parts.back().id = static_cast<int>(before.parts.size()) - 1;  // as the re-run counts them
    }
    scene.report.drift = drift(before, moved, models.parts());
  }

  void see(Result& result, const Request& request, bool silhouettes) {
    Scene& scene = result.scene;
    if (!camera) camera = std::make_unique<RangeCamera>();
    result.images = camera->render(scene, request, models.parts(), models.bin(), silhouettes);
    for (const RangeImage& image : result.images) {
      for (ScenePart& part : scene.parts) {
        const double seen = static_cast<double>(image.visible.at(part.id));
        const double alone = static_cast<double>(image.total.at(part.id));
        part.visible_fraction[image.sensor.name] = alone > 0 ? seen / alone : 0.0;
      }
    }
  }
};

Generator::Generator() : state_(std::make_unique<State>()) {}
Generator::~Generator() = default;

const std::vector<PartModelPtr>& Generator::parts() const {
  return state_->models.parts();
}
const PartModelPtr& Generator::bin_model() const {
  return state_->models.bin();
}

void Generator::generate(const Request& request, const Options& options, const std::function<void(Result&&)>& done) {
  const CancelScope scope(options.hooks.cancel);
  check(request);
  Reporter reporter(options.hooks, request.scenes);
  Profile loading;
  {
    StageTimer timer(loading, "load");
    state_->load(request, reporter);
  }
  const std::vector<PartModelPtr>& parts = state_->models.parts();
  const PartModelPtr& bin_model = state_->models.bin();
  std::string solver_reason;
  std::unique_ptr<Solver> solver;
  {
    StageTimer timer(loading, "prepare");
    reporter.phase("prepare", request.first, request.part_count());
    solver = make_solver(request, parts, solver_reason);
  }

  const auto judge_one = [&](Scene& scene) {
    Profile judging;
    {
      StageTimer timer(judging, "quality");
      judge(scene, request, parts, bin_model);
    }
    scene.report.profile.merge(judging);
  };
  const auto hand_on = [&](Scene&& scene) {
    Result result;
    result.scene = std::move(scene);
    result.scene.sensors.clear();
    for (const Sensor& sensor : request.sensors) result.scene.sensors.push_back(resolved(sensor, request.bin));
    if (options.render && !request.sensors.empty()) {
      Profile rendering;
      {
        StageTimer timer(rendering, "render");
        reporter.phase("render", result.scene.index, result.scene.parts.size());
        state_->see(result, request, options.silhouettes);
      }
      result.scene.report.profile.merge(rendering);
    }
    reporter.handed_on();
    done(std::move(result));
  };
  Judging judging(judge_one, hand_on);

  const SceneList scenes{request.scenes, [&](std::size_t place) { return request.first + place; }};
  RunHooks hooks = options.hooks;
  hooks.progress = [&](const Progress& progress) {
    reporter.poured(progress);
    judging.hand_on_judged();
  };
  pour(request, parts, *solver, scenes, hooks, bin_model, [&](std::size_t place, Scene&& scene) {
    Report& report = scene.report;
    for (const PartModelPtr& part : parts) scene.model_sha256.push_back(part->load_report().content_sha256);
    report.solver_reason = solver_reason;
    if (place == 0) report.profile.merge(loading);
    for (auto part = parts.begin(); part != parts.end(); ++part) {  // a repaired mesh matters to each scene of it
      if (std::find(parts.begin(), part, *part) != part) continue;
      for (const Flag& flag : (*part)->load_report().flags) report.flags.push_back(flag);
    }
    reporter.phase("quality", scene.index, scene.parts.size());
    if (request.drift_check) state_->measure_drift(scene, request, *solver, options.hooks);
    judging.add(place, std::move(scene));
    judging.hand_on_judged();
  });
  judging.finish();
}

}  // namespace bin_scenes
