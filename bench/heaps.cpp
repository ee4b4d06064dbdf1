#include "heaps.hpp"

#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/quality/quality.hpp"
#include "pour/settling.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

namespace bin_scenes::bench {

namespace {

constexpr double touching = 2e-3;  ///< clearance / diagonal that counts as a contact

/// Poured into the bin of the request, which may be an endless floor; poses of the parts.
void pour_once(Heap& heap, const std::string& path) {
  choose_solver(heap.request, "sphere");
  if (!std::filesystem::exists(path)) {
    const std::vector<PartModelPtr> parts = load_parts(heap.request);
    std::string reason;
    const std::unique_ptr<Solver> solver = make_solver(heap.request, parts, reason);
    write_text(path, scene_json(pour(heap.request, parts, *solver, {0}).front(), heap.request));
  }
  for (const ScenePart& p : read_scene_json(path).parts) heap.rest.push_back({p.pose, {}});
}

}  // namespace

Heap heap_at_rest(const std::string& part, std::size_t count, const std::string& path) {
  Heap heap;
  heap.request = bin_of(part, count);
  heap.request.bin = Bin();
  heap.request.bin.kind = Bin::Kind::floor;
  pour_once(heap, path);
  Aabb box;
  for (const BodyState& state : heap.rest) box.extend(state.pose.position);
  heap.width = std::max(box.size().x(), box.size().y()) + 3.0 * load_parts(heap.request).front()->diagonal();
  return heap;
}

Heap boxed_heap(const std::string& part, std::size_t count, double width, const std::string& path) {
  Heap heap;
  heap.request = bin_of(part, count);
  heap.request.bin.inner_size = Vec3(width, width, 0.4);  // all find room below the rim
  heap.width = width;
  pour_once(heap, path);
  return heap;
}

Heaps::Heaps(const Heap& heap, const Request& settings, std::size_t per_world, std::size_t worlds) {
  Request request = heap.request;
  request.solver = settings.solver;
  request.parts[0].count = heap.rest.size() * per_world;
  parts_ = load_parts(request);
  std::string reason;
  solver_ = make_solver(request, parts_, reason);
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(per_world))));
  const double side = heap.width * static_cast<double>(columns - 1);
  request.bin.inner_size.head<2>().array() += side;
  const WorldDef def = world_of(request, parts_);
  for (std::size_t w = 0; w < worlds; ++w) {
    const WorldId id = solver_->add_world(def);
    solver_->set_phase(id, phases::settle);
    for (std::size_t h = 0, body = 0; h < per_world; ++h) {
      const Vec3 middle(heap.width * static_cast<double>(h % columns) - 0.5 * side,
                        heap.width * static_cast<double>(h / columns) - 0.5 * side, 0.0);
      for (BodyState state : heap.rest) {
        state.pose.position += middle;
        solver_->insert(id, body++, state);
      }
    }
    worlds_.push_back(id);
  }
  bodies_ = request.parts[0].count * worlds;
}

Heaps::Cost Heaps::steps(int count) {
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_begin = cpu_seconds();
  solver_->advance(worlds_, count * solver_->step_size());
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - begin;
  return {wall.count() / count, 1e3 * (cpu_seconds() - cpu_begin) / count};
}

void Heaps::wake(double share) {
  for (const WorldId id : worlds_) {
    const std::vector<BodyState> states = solver_->states(id);
    const auto count = static_cast<std::size_t>(share * static_cast<double>(states.size()));
    for (std::size_t b = 0; b < count; ++b) solver_->insert(id, b, {states[b].pose, {}});
  }
}

double Heaps::asleep() const {
  std::size_t count = 0;
  for (const WorldId id : worlds_)
    for (const bool sleeps : solver_->asleep(id)) count += sleeps ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(bodies_);
}

double Heaps::joined() const {
  const std::vector<BodyState> states = solver_->states(worlds_.front());
  const PartModel& part = *parts_.front();
  const double limit = touching * part.diagonal();
  std::vector<Vec3> centers;
  for (const BodyState& state : states) centers.push_back(state.pose * part.mass().center);
  std::vector<bool> seen(states.size(), false);
  std::size_t largest = 0;
  for (std::size_t first = 0; first < states.size(); ++first) {
    if (seen[first]) continue;
    std::vector<std::size_t> heap = {first};
    seen[first] = true;
    for (std::size_t i = 0; i < heap.size(); ++i)
      for (std::size_t b = 0; b < states.size(); ++b) {
        if (seen[b] || (centers[b] - centers[heap[i]]).norm() > 2.0 * part.radius() + limit) continue;
        const Pose &pose = states[b].pose, &other = states[heap[i]].pose;
        if (clearance(part.query(), pose, part.query(), other, 2.0 * limit) > limit) continue;
        seen[b] = true;
        heap.push_back(b);
      }
    largest = std::max(largest, heap.size());
  }
  return static_cast<double>(largest) / static_cast<double>(states.size());
}

}  // namespace bin_scenes::bench
