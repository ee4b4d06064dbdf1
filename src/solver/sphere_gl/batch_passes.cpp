/// The passes of a step, and what they are bound to; batch.cpp holds the worlds and their memory.
#include "solver/sphere_gl/batch.hpp"

#include <algorithm>
#include <cstddef>

namespace bin_scenes::sphere_gl {

void Batch::run(const std::vector<Slot>& slots, float share) {
  std::vector<gpu::uint> list;
  for (const Slot slot : slots) list.push_back(static_cast<gpu::uint>(slot));
  running_.upload(0, list.data(), list.size());
  running_count_ = list.size();
  most_pairs_ = 0;
  for (const Slot slot : slots) most_pairs_ = std::max(most_pairs_, regions_[slot].capacity);
  gpu::SphereSettingsBlock settings = settings_block_;
  settings.time_step *= share;
  settings_.upload(0, &settings, 1);
  if (!bound_) bind();
}

void Batch::bind() const {
  shapes_.bind();
  settings_.bind(BIND_SETTINGS);
  running_.bind(BIND_RUNNING);
  worlds_.bind(BIND_WORLDS);
  progress_.bind(BIND_PROGRESS);
  planes_.bind(BIND_PLANES);
  bodies_.bind(BIND_BODIES);
  states_.bind(BIND_STATES);
  tensors_.bind(BIND_TENSORS);
  near_.bind(BIND_NEAR);
  boxes_.bind(BIND_BOXES);
  ranges_.bind(BIND_RANGES);
  pairs_.bind(BIND_PAIRS);
  free_.bind(BIND_FREE);
  manifolds_.bind(BIND_MANIFOLDS);
  contacts_.bind(BIND_CONTACTS);
  jobs_.bind(BIND_JOBS);
  near_samples_.bind(BIND_SAMPLES);
  touches_.bind(BIND_TOUCHES);
  candidate_list_.bind(BIND_CANDIDATES);
  colors_.bind(BIND_COLORS);
  order_.bind(BIND_ORDER);
  rows_.bind(BIND_ROWS);
  impulses_.bind(BIND_IMPULSES);
  worst_.bind(BIND_WORST);
  asks_.bind(BIND_ASKS);
  watched_.bind(BIND_WATCHED);
  audits_.bind(BIND_AUDITS);
  seen_.bind(BIND_SEEN);
}

void Batch::find_pairs() {
  gl::Stage stage(timer_, "find_pairs");
  gl::dispatch_groups(find_pairs_, running_count_);
}

void Batch::find_contacts() {
  const gl::Storage& status = jobs_.storage();
  {
    gl::Stage stage(timer_, "list_jobs");
    const std::size_t groups = (most_pairs_ + SPHERE_JOB_GROUP - 1) / SPHERE_JOB_GROUP;
    list_jobs_.set("groups_of_a_world", static_cast<unsigned>(groups));
    gl::dispatch_groups(list_jobs_, groups * running_count_, gl::Barrier::arguments);
  }
  {
    gl::Stage stage(timer_, "collect_samples");
    gl::dispatch_indirect(collect_samples_, status, offsetof(gpu::SphereStatus, groups), gl::Barrier::arguments);
  }
  {
    gl::Stage stage(timer_, "test_samples");
    gl::dispatch_indirect(test_samples_, status, offsetof(gpu::SphereStatus, sample_groups), gl::Barrier::arguments);
  }
  {
    gl::Stage stage(timer_, "offer_contacts");
    gl::dispatch_indirect(offer_contacts_, status, offsetof(gpu::SphereStatus, touch_groups));
  }
  gl::Stage stage(timer_, "choose_contacts");
  gl::dispatch_indirect(choose_contacts_, status, offsetof(gpu::SphereStatus, groups));
}

void Batch::color_manifolds() {
  gl::Stage stage(timer_, "color_manifolds");
  gl::dispatch_groups(color_manifolds_, running_count_);
}

void Batch::prepare_rows() {
  gl::Stage stage(timer_, "prepare_rows");
  gl::dispatch_groups(prepare_rows_, SPHERE_PREPARE_GROUPS * running_count_);
}

void Batch::solve() {
  gl::Stage stage(timer_, "solve");
  gl::dispatch_groups(solve_, running_count_);
}

void Batch::note_depths() {
  gl::Stage stage(timer_, "note_depths");
  gl::dispatch_groups(note_depths_, running_count_);
}

void Batch::update_sleep() {
  gl::Stage stage(timer_, "update_sleep");
  gl::dispatch_groups(update_sleep_, running_count_);
}

void Batch::begin_watch() {
  gl::Stage stage(timer_, "begin_watch");
  gl::dispatch_groups(begin_watch_, running_count_);
}

void Batch::watch_rest() {
  gl::Stage stage(timer_, "watch_rest");
  gl::dispatch_groups(watch_rest_, running_count_);
}

void Batch::audit_energy() {
  gl::Stage stage(timer_, "audit_energy");
  gl::dispatch_groups(audit_energy_, running_count_);
}

void Batch::step() {
  find_pairs();
  find_contacts();
  color_manifolds();
  prepare_rows();
  note_depths();
  solve();
  update_sleep();
}

std::size_t Batch::bytes() const {
  std::size_t sum = shapes_.bytes();
  for (const gl::Storage* s :
       {&settings_.storage(),     &running_.storage(),   &worlds_.storage(),         &progress_.storage(),
        &planes_.storage(),       &bodies_.storage(),    &states_.storage(),         &tensors_.storage(),
        &near_.storage(),         &boxes_.storage(),     &ranges_.storage(),         &pairs_.storage(),
        &free_.storage(),         &manifolds_.storage(), &contacts_.storage(),       &jobs_.storage(),
        &near_samples_.storage(), &touches_.storage(),   &candidate_list_.storage(), &colors_.storage(),
        &order_.storage(),        &rows_.storage(),      &impulses_.storage(),       &worst_.storage(),
        &asks_.storage(),         &watched_.storage(),   &audits_.storage(),         &seen_.storage()})
    sum += s->bytes();
  return sum;
}

std::size_t Batch::bytes_shared() const {
  return shapes_.bytes() + settings_.storage().bytes();
}

}  // namespace bin_scenes::sphere_gl
