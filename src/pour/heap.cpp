#include "bin_scenes/pour/heap.hpp"

#include "pour/settle_heaps.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <chrono>
#include <cmath>

namespace bin_scenes {

struct Heap::State {
  std::shared_ptr<Solver> solver;
  std::string solver_reason;
  HeapCore core;
  double wall_s = 0.0;  ///< of the last settle
  Profile profile;      ///< likewise

  State(std::shared_ptr<const PourPlan> plan, std::shared_ptr<Solver> with, std::string reason, std::size_t index)
      : solver(std::move(with)), solver_reason(std::move(reason)), core(std::move(plan), *solver, index) {}

  void check_ids(const std::vector<int>& ids) const;
};

namespace {
constexpr double longest_lift = 10.0;  ///< m
}

Heap::Heap(const Request& request, const std::vector<PartModelPtr>& parts, std::shared_ptr<Solver> solver,
           std::size_t index, PartModelPtr bin_model, std::string solver_reason)
    : state_(std::make_unique<State>(std::make_shared<PourPlan>(request, parts, std::move(bin_model)),
                                     std::move(solver), std::move(solver_reason), index)) {}
Heap::Heap(Heap&&) noexcept = default;
Heap& Heap::operator=(Heap&&) noexcept = default;
Heap::~Heap() = default;

std::vector<int> Heap::add(const std::vector<NewParts>& lines) {
  const PourPlan& before = state_->core.plan();
  Request request = before.request;
  std::vector<PartModelPtr> parts = before.world.parts;
  for (const NewParts& more : lines) {
    request.parts.push_back(more.line);
    parts.push_back(more.part);
  }
  if (request.pour.pattern == Pour::Pattern::given) request.pour.pattern = Pour::Pattern::rain;
  const std::size_t first = before.world.bodies.size();
  auto plan = std::make_shared<PourPlan>(request, parts, before.world.bin_model);
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
  const double length = direction.norm();
  if (!(length > 0.0) || !std::isfinite(length)) throw input_error("is no direction", "lift", "for instance [0, 0, 1]");
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
  const auto begin = std::chrono::steady_clock::now();
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
  state_->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
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
const PartModelPtr& Heap::bin_model() const {
  return state_->core.plan().world.bin_model;
}

const std::shared_ptr<Solver>& Heap::solver() const {
  return state_->solver;
}
const std::string& Heap::solver_reason() const {
  return state_->solver_reason;
}

}  // namespace bin_scenes
