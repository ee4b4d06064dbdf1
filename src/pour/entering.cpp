/// How parts enter a heap: at given poses, in a grid, or as rain from above, slice by slice while the heap has room.
#include "pour/heap_core.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace bin_scenes {

namespace {

constexpr int tries_per_part = 12;   ///< places tried for a part, in one orientation, in each slice
constexpr int misses_per_slice = 4;  ///< consecutive parts without a place after which a slice stops trying

}  // namespace

bool HeapCore::enter(std::size_t first) {
  states_.resize(plan_->world.bodies.size(), {Pose::none(), {}});  // until a part is let in
  place_.resize(states_.size(), Place::waiting);
  BIN_SCENES_ASSERT(place_.size() == states_.size() && first <= states_.size());
  start_given(first);
  const bool enters = !waiting_.empty();
  if (plan_->request.pour.pattern == Pour::Pattern::grid || plan_->world.bin.kind == Bin::Kind::none)
    start_grid();
  else
    start_rain();
  return enters;
}

void HeapCore::start_given(std::size_t first) {
  for (std::size_t b = first; b < states_.size(); ++b) {
    stop_if_cancelled();
    const PartLine& line = plan_->request.parts[plan_->line_of[b]];
    if (line.poses.empty()) {
      if (line.on_table > 0.0)
        lay_on_table(b);
      else
        waiting_.push_back(b);
      continue;
    }
    BodyState state{line.poses[plan_->copy_of[b]], {}};
    if (!line.velocities.empty() && !line.stays()) state.velocity = line.velocities[plan_->copy_of[b]];
    if (!line.stays() && outside(state.pose * part(b).mass().center)) {
      states_[b] = state;  // the walls would push it further out
      place_[b] = Place::escaped;
      continue;
    }
    insert(b, state);
  }
}

void HeapCore::lay_on_table(std::size_t body) {
  std::vector<Footprint> others;
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (place_[b] == Place::in && plan_->lying.count(plan_->line_of[b]))
      others.push_back(footprint(part(b), states_[b].pose));
  Aabb bin = plan_->bin_bounds;
  if (bin.empty()) bin.extend(Vec3::Zero());
  const std::size_t line = plan_->line_of[body];
  const Request& request = plan_->request;
  const auto pose = place_on_table(part(body), plan_->lying.at(line), bin, request.table.height.value(),
                                   request.parts[line].on_table, others, random_);
  if (pose)
    insert(body, {*pose, {}});
  else
    place_[body] = Place::no_room;
}

void HeapCore::start_grid() {
  std::vector<const PartModel*> models;
  for (const std::size_t b : waiting_) models.push_back(&part(b));
  if (models.empty()) return;
  Opening opening = plan_->opening;
  const Bin::Kind kind = plan_->world.bin.kind;
  if (kind == Bin::Kind::floor || kind == Bin::Kind::none) opening.upper.z() = opening.lower.z();
  opening.upper.z() = std::max(opening.upper.z(), top());
  const std::vector<Pose> poses = grid_poses(models, opening, plan_->request.pour.grid_spacing, random_);
  BIN_SCENES_ASSERT(poses.size() == waiting_.size());
  for (std::size_t i = 0; i < poses.size(); ++i) insert(waiting_[i], {poses[i], {}});
  waiting_.clear();
}

void HeapCore::start_rain() {
  for (std::size_t i = waiting_.size(); i > 1; --i)  // Fisher-Yates shuffle: part lines enter mixed
    std::swap(waiting_[i - 1], waiting_[random_.below(i)]);
  insert_waiting();
}

void HeapCore::insert_waiting() {
  BIN_SCENES_ASSERT(each_is(waiting_, [this](std::size_t b) { return place_[b] == Place::waiting; }));
  if (waiting_.empty()) return;
  Rain rain(plan_->opening, plan_->request.pour.drop_height);
  if (plan_->world.bin_model) rain.add(plan_->bin_cover, Pose(), true);
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (place_[b] == Place::in) rain.add(plan_->covers[plan_->line_of[b]], states_[b].pose, time_ > 0.0 && slow(b));
  // The last chance of those that wait. What is large and finds no place must not keep out what is small, behind it.
  const bool at_rest = time_ > 0.0 && all_rest();
  std::map<std::size_t, int> misses;  // of all, or at rest by part line
  std::vector<std::size_t> still;
  for (const std::size_t b : waiting_) {
    std::optional<Pose> pose;
    const Cover& shape = plan_->covers[plan_->line_of[b]];
    int& missed = misses[at_rest ? plan_->line_of[b] : 0];
    if (missed < misses_per_slice && !cancelled()) pose = rain.place(part(b), shape, random_, tries_per_part);
    if (!pose) {
      ++missed;
      still.push_back(b);
      continue;
    }
    missed = 0;
    insert(b, {*pose, {}});
    rain.add(shape, *pose, false);
  }
  // All parts rest and none of the waiting ones finds a place: the bin is full.
  if (still.size() == waiting_.size() && at_rest && !cancelled()) {
    for (const std::size_t b : still) place_[b] = Place::no_room;
    still.clear();
  }
  waiting_ = std::move(still);
}

double HeapCore::top() const {
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (place_[b] != Place::in) continue;
    for (const Cover::Ball& ball : plan_->covers[plan_->line_of[b]].balls)
      highest = std::max(highest, (states_[b].pose * ball.center).z() + ball.radius);
  }
  return highest;
}

/// Cuts the raised walls down to the rim, once all parts are in.
void HeapCore::cut_walls() {
  walls_raised_ = false;
  // No part touches the walls above the rim, and nothing carries one there.
  if (top() <= plan_->world.wall_height && motion_seconds() == 0.0) return;
  earlier_steps_ += solver_.steps(id_);
  leave_world();  // first: both at once would hold twice the memory
  make_world(false);
  set_solver_phase();
}

}  // namespace bin_scenes
