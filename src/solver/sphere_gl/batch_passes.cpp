/// The passes of a step, and what they are bound to; batch.cpp holds the worlds and their memory.
#include "solver/sphere_gl/batch.hpp"

#include <cstddef>

namespace bin_scenes::sphere_gl {

void Batch::run(const std::vector<Slot>& slots, float share) {
  std::vector<gpu::uint> list;
  running_large_.clear();
  for (const Slot slot : slots) {
    const Region& r = regions_[slot];
    if (r.large.bodies == 0) {
      list.push_back(static_cast<gpu::uint>(slot));
      continue;
    }
    running_large_.push_back(r.large);
    running_large_.back().sub_steps = sub_steps(r);
    running_large_.back().sweeps = r.effort * settings_block_.sweeps;
    running_large_.back().rigid = r.stiffness == SPHERE_RIGID;
    running_large_.back().cold_sweeps = r.cold ? r.effort * settings_block_.cold_sweeps : 0;
  }
  running_.upload(0, list.data(), list.size());
  running_count_ = list.size();
  at_turn_ = running_count_ == 0 && !running_large_.empty() ? &running_large_.front() : nullptr;
  gpu::SphereSettingsBlock settings = settings_block_;
  settings.time_step *= share;
  settings_.upload(0, &settings, 1);
  if (!bound_) bind();
}

unsigned Batch::sub_steps(const Region& r) const {
  return settings_block_.sub_steps * r.refinement;
}

void Batch::bind_first() const {
  settings_.bind(BIND_SETTINGS);
  running_.bind(BIND_RUNNING);
  worlds_.bind(BIND_WORLDS);
}

void Batch::bind() const {
  shapes_.bind();
  if (large_) large_->bind();
  bind_first();
  progress_.bind(BIND_PROGRESS);
  planes_.bind(BIND_PLANES);
  bodies_.bind(BIND_BODIES);
  states_.bind(BIND_STATES);
  tensors_.bind(BIND_TENSORS);
  near_.bind(BIND_NEAR);
  ranges_.bind(BIND_RANGES);
  pairs_.bind(BIND_PAIRS);
  free_.bind(BIND_FREE);
  manifolds_.bind(BIND_MANIFOLDS);
  contacts_.bind(BIND_CONTACTS);
  jobs_.bind(BIND_JOBS);
  near_samples_.bind(BIND_SAMPLES);
  candidate_list_.bind(BIND_CANDIDATES);
  colors_.bind(BIND_COLORS);
  order_.bind(BIND_ORDER);
  rows_.bind(BIND_ROWS);
}

void Batch::find_pairs() {
  gl::Stage stage(timer_, "find_pairs");
  if (at_turn_) return large_->find_pairs(*at_turn_, [this] { bind_first(); });
  gl::dispatch_groups(find_pairs_, running_count_, gl::Barrier::arguments);
}

void Batch::find_contacts() {
  const gl::Storage& status = jobs_.storage();
  {
    gl::Stage stage(timer_, "collect_samples");
    gl::dispatch_indirect(collect_samples_, status, offsetof(gpu::SphereStatus, groups), gl::Barrier::arguments);
  }
  {
    gl::Stage stage(timer_, "test_samples");
    gl::dispatch_indirect(test_samples_, status, offsetof(gpu::SphereStatus, sample_groups));
  }
  gl::Stage stage(timer_, "choose_contacts");
  gl::dispatch_indirect(choose_contacts_, status, offsetof(gpu::SphereStatus, groups));
}

void Batch::color_manifolds() {
  gl::Stage stage(timer_, "color_manifolds");
  if (at_turn_) return large_->color_manifolds(*at_turn_);
  gl::dispatch_groups(color_manifolds_, running_count_);
}

void Batch::solve() {
  gl::Stage stage(timer_, "solve");
  if (at_turn_) return large_->solve(*at_turn_);
  gl::dispatch_groups(solve_, running_count_);
}

void Batch::update_sleep() {
  gl::Stage stage(timer_, "update_sleep");
  if (at_turn_) return large_->update_sleep(*at_turn_);
  gl::dispatch_groups(update_sleep_, running_count_);
}

void Batch::step() {
  at_turn_ = nullptr;
  if (running_count_ > 0) step_at_turn();
  for (const LargeWorld& world : running_large_) {
    at_turn_ = &world;
    step_at_turn();
  }
}

void Batch::step_at_turn() {
  find_pairs();
  find_contacts();
  color_manifolds();
  solve();
  update_sleep();
}

std::size_t Batch::bytes() const {
  std::size_t sum = shapes_.bytes() + (large_ ? large_->bytes() : 0);
  for (const gl::Storage* s :
       {&settings_.storage(),       &running_.storage(),  &worlds_.storage(), &progress_.storage(),
        &planes_.storage(),         &bodies_.storage(),   &states_.storage(), &tensors_.storage(),
        &near_.storage(),           &ranges_.storage(),   &pairs_.storage(),  &free_.storage(),
        &manifolds_.storage(),      &contacts_.storage(), &jobs_.storage(),   &near_samples_.storage(),
        &candidate_list_.storage(), &colors_.storage(),   &order_.storage(),  &rows_.storage()})
    sum += s->bytes();
  return sum;
}

std::size_t Batch::bytes_shared() const {
  return shapes_.bytes() + settings_.storage().bytes();
}

}  // namespace bin_scenes::sphere_gl
