/// A heap behind its public face: changes, settling with a clock, and the scene of now. Scenes of a request are heaps
/// that settle together and leave one by one.
#include "bin_scenes/pour/heap.hpp"

#include "pour/settle_heaps.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <chrono>
#include <cmath>
#include <map>

namespace bin_scenes {

struct Heap::State {
  std::shared_ptr<Solver> solver;
  std::string solver_reason;
  HeapCore core;
  std::chrono::steady_clock::time_point begin;  ///< of the last settle
  double wall_s = 0.0;                          ///< likewise
  Profile profile;                              ///< likewise

  State(std::shared_ptr<const PourPlan> plan, std::shared_ptr<Solver> with, std::string reason, std::size_t index)
      : solver(std::move(with)), solver_reason(std::move(reason)), core(std::move(plan), *solver, index) {}

  void check_ids(const std::vector<int>& ids) const;
  void start_clock() { begin = std::chrono::steady_clock::now(); }
  void stop_clock() { wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); }
};

namespace {
constexpr double longest_lift = 10.0;  ///< m
}

Heap::Heap(const LoadedRequest& loaded, std::shared_ptr<Solver> solver, std::size_t index, std::string solver_reason)
    : state_(std::make_unique<State>(std::make_shared<PourPlan>(loaded), std::move(solver), std::move(solver_reason),
                                     index)) {}
Heap::Heap(std::unique_ptr<State> state) : state_(std::move(state)) {}
Heap::Heap(Heap&&) noexcept = default;
Heap& Heap::operator=(Heap&&) noexcept = default;
Heap::~Heap() = default;

std::vector<int> Heap::add(const std::vector<NewParts>& lines) {
  const PourPlan& before = state_->core.plan();
  LoadedRequest loaded = this->loaded();
  for (const NewParts& more : lines) {
    loaded.request.parts.push_back(more.line);
    loaded.parts.push_back(more.part);
  }
  Pour::Pattern& pattern = loaded.request.pour.pattern;
  if (pattern == Pour::Pattern::given) pattern = Pour::Pattern::rain;
  const std::size_t first = before.world.bodies.size();
  auto plan = std::make_shared<PourPlan>(loaded);
  std::vector<int> ids;
  for (std::size_t b = first; b < plan->world.bodies.size(); ++b) ids.push_back(static_cast<int>(b));
  if (!ids.empty()) state_->core.extend(std::move(plan));
  return ids;
}

void Heap::State::check_ids(const std::vector<int>& ids) const {
  for (const int id : ids)
    if (!core.has(id))
      throw input_error("there is no part " + std::to_string(id) + " in the heap", "ids",
                        "name parts whose state is neither not_poured nor removed");
}

void Heap::remove(const std::vector<int>& ids) {
  state_->check_ids(ids);
  for (const int id : ids) state_->core.remove(static_cast<std::size_t>(id));
}

void Heap::lift(const std::vector<int>& ids, const Vec3& direction, double distance, const RunHooks& hooks) {
  state_->check_ids(ids);
  for (const int id : ids)
    if (state_->core.plan().world.bodies[static_cast<std::size_t>(id)].fixed)
      throw input_error("part " + std::to_string(id) + " is fixed", "lift", "name parts that can move, or remove() it");
  const double length = direction.norm();
  if (!(length > 0.0) || !std::isfinite(length))
    throw input_error("has length 0", "lift", "give a direction, for instance [0, 0, 1]");
  if (!(distance >= 0.0 && distance <= longest_lift))
    throw input_error("the distance is " + std::to_string(distance) + " m", "lift", "give 0 to 10 m");
  const CancelScope scope(hooks.cancel);
  try {
    state_->core.lift({ids.begin(), ids.end()}, direction / length, distance, hooks);
  } catch (...) {
    state_->core.recover();
    throw;
  }
}

void Heap::set_gravity(const Vec3& gravity) {
  if (!gravity.allFinite()) throw input_error("is not finite", "gravity", "give three finite numbers");
  state_->core.set_gravity(gravity);
}

bool Heap::settle(const RunHooks& hooks) {
  state_->start_clock();
  const Profile before = state_->solver->profile();
  HeapCore& core = state_->core;
  if (core.settled() && !request().seconds) return true;
  core.start_clock();
  const HeapSource source{1, [&](std::size_t) -> HeapCore& { return core; }, [](std::size_t) {}};
  const CancelScope scope(hooks.cancel);
  try {
    settle_heaps(*state_->solver, source, hooks);
  } catch (...) {
    core.recover();
    throw;
  }
  state_->profile = state_->solver->profile().since(before);
  state_->stop_clock();
  return core.at_rest();
}

Scene Heap::scene() const {
  Scene scene = state_->core.scene();
  scene.report.wall_s = state_->wall_s;
  scene.report.profile = state_->profile;
  return scene;
}

const Request& Heap::request() const {
  return state_->core.plan().request;
}
const std::vector<PartModelPtr>& Heap::parts() const {
  return state_->core.plan().world.parts;
}
LoadedRequest Heap::loaded() const {
  const PourPlan& plan = state_->core.plan();
  return {plan.request, plan.world.parts, plan.world.bin_model};
}

const std::shared_ptr<Solver>& Heap::solver() const {
  return state_->solver;
}
const std::string& Heap::solver_reason() const {
  return state_->solver_reason;
}

void settle_scenes(const LoadedRequest& loaded, const std::shared_ptr<Solver>& solver, const std::string& solver_reason,
                   const SceneList& scenes, const RunHooks& hooks,
                   const std::function<void(std::size_t, Heap&&)>& settled) {
  const CancelScope scope(hooks.cancel);
  const auto plan = std::make_shared<const PourPlan>(loaded);
  const Profile before = solver->profile();
  std::map<std::size_t, std::unique_ptr<Heap::State>> running;  // by place
  HeapSource source;
  source.count = scenes.count;
  source.next = [&](std::size_t place) -> HeapCore& {
    auto& heap = running[place] = std::make_unique<Heap::State>(plan, solver, solver_reason, scenes.index(place));
    heap->start_clock();
    return heap->core;
  };
  source.over = [&](std::size_t place) {
    std::unique_ptr<Heap::State> heap = std::move(running.at(place));
    running.erase(place);
    heap->stop_clock();
    if (scenes.count == 1) heap->profile = solver->profile().since(before);  // several share its counters
    settled(place, Heap(std::move(heap)));
  };
  settle_heaps(*solver, source, hooks);
}

}  // namespace bin_scenes
