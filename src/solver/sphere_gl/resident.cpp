#include "solver/sphere_gl/resident.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace bin_scenes::sphere_gl {

namespace {

/// Infinity becomes the largest finite number: not every device compares with infinity.
float finite(double value) {
  constexpr auto most = static_cast<double>(std::numeric_limits<float>::max());
  return static_cast<float>(std::min(std::max(value, -most), most));
}

int part_of(gpu::uint body, bool known) {
  return known && body != SPHERE_GROUND ? static_cast<int>(body) : -1;
}

}  // namespace

std::vector<Batch::Slot> longest_first(const std::vector<const Resident*>& residents) {
  std::vector<std::pair<int, Batch::Slot>> worlds;
  for (const Resident* r : residents) {
    const StepPlan plan = r->world.plan();
    worlds.emplace_back(plan.sub_steps * (1 + plan.sweeps + plan.relaxing_sweeps), r->slot);
  }
  std::stable_sort(worlds.begin(), worlds.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Batch::Slot> slots;
  for (const auto& [sweeps, slot] : worlds) slots.push_back(slot);
  return slots;
}

std::vector<std::uint32_t> touched(sphere::World world, std::size_t body) {
  for (sphere::Body& b : world.bodies) sphere::put_to_sleep(world.settings, b);
  sphere::wake(world.bodies[body]);
  if (world.bodies[body].inverse_mass == 0) world.bodies[body].inverse_mass = 1;
  sphere::find_pairs(world);
  sphere::find_contacts(world);
  return sphere::touched_by(world, static_cast<std::uint32_t>(body));
}

void upload_changes(Batch& batch, Resident& r) {
  batch.upload_states(r.slot, r.world, r.changed, r.marks);
  for (const std::size_t body : r.changed) r.marks[body].enters = false;
  r.changed.clear();
  if (std::exchange(r.worst_taken, false)) batch.forget_worst(r.slot);
}

void make_room_for(Batch& batch, Resident& r, gpu::uint& samples, gpu::uint& candidates) {
  const gpu::uint overflow = std::exchange(r.progress.overflow, 0);
  if (overflow & SPHERE_PAIR_OVERFLOW) batch.grow_pairs(r.slot, r.progress);
  if (overflow & SPHERE_ROW_OVERFLOW) batch.grow_rows(r.slot, r.progress.rows);
  if (overflow & SPHERE_SAMPLE_OVERFLOW) samples = std::max(samples, r.progress.need);
  candidates = std::max(candidates, r.progress.need_candidates);
  r.progress.need = r.progress.need_candidates = 0;
  r.progress_changed = true;
}

void take_counters(gpu::SphereProgress& p, Profile& profile) {
  const auto take = [&](const char* name, gpu::uint& counter) { profile.count(name, std::exchange(counter, 0u)); };
  take("body_steps_in_free_fall", p.free_steps);
  take("body_steps_asleep", p.asleep_steps);
  take("pairs", p.pairs_tested);
  take("pairs_recycled", p.pairs_recycled);
  take("pairs_asleep", p.pairs_asleep);
  take("pairs_culled", p.pairs_culled);
  take("clusters_tested", p.clusters_tested);
  take("nodes_tested", p.nodes_tested);
  take("contacts", p.contacts);
  take("contacts_reduced", p.dropped);
  take("colors", p.colors);
  take("coloring_rounds", p.coloring_rounds);
  take("colorings", p.colorings);
  take("pair_lists_made", p.lists_made);
  take("steps", p.steps);
  const std::uint64_t high = std::exchange(p.nodes_possible_high, 0u);
  profile.count("nodes_possible", std::exchange(p.nodes_possible, 0u) + (high << 32));
}

void set_rules(gpu::SphereAsk& ask, const WatchRules& rules) {
  ask.lower = {finite(rules.lower.x()), finite(rules.lower.y()), finite(rules.lower.z()), finite(rules.rest_move)};
  ask.upper = {finite(rules.upper.x()), finite(rules.upper.y()), finite(rules.upper.z()), finite(rules.rest_turn)};
}

void set_ask(gpu::SphereAsk& to, const WatchAsk& from) {
  to.observation = from.observation;
  to.seconds = static_cast<float>(from.seconds);
  to.flags = (from.rest_anew ? SPHERE_REST_ANEW : 0u) | (from.energy_anew ? SPHERE_ENERGY_ANEW : 0u) |
             (from.driven ? SPHERE_DRIVEN : 0u);
  to.since = {from.since[0], from.since[1], from.since[2], from.since[3]};
  to.rested = from.rested;
}

WatchSeen seen_of(const gpu::SphereSeen& from) {
  WatchSeen seen;
  seen.observation = from.observation;
  seen.outside = from.outside;
  seen.fast = from.fast;
  seen.awake = from.awake;
  seen.unrested = from.unrested;
  seen.moved = {from.moved01 & 0xffffu, from.moved01 >> 16, from.moved23 & 0xffffu, from.moved23 >> 16};
  return seen;
}

WatchedEnergy energy_of(const gpu::SphereAudit& audit) {
  WatchedEnergy energy;
  energy.parts.gain = audit.gain;
  energy.parts.time = audit.gain_observation;
  energy.parts.part = part_of(audit.gainer, audit.gain > 0);
  energy.parts.thrown = {audit.ratio, static_cast<double>(audit.ratio_observation),
                         part_of(audit.thrown, audit.ratio > 0), part_of(audit.beside, audit.ratio > 0)};
  energy.all = {audit.world_gain, static_cast<double>(audit.world_observation)};
  return energy;
}

void read_residents(const void* from, const std::vector<Resident*>& residents, Profile& profile) {
  const std::size_t count = residents.size();
  const auto* progress = static_cast<const gpu::SphereProgress*>(from);
  const auto* worst = reinterpret_cast<const gpu::SphereWorst*>(progress + count);
  const auto* audit = reinterpret_cast<const gpu::SphereAudit*>(worst + count);
  const auto* state = reinterpret_cast<const gpu::SphereState*>(audit + count);
  for (std::size_t k = 0; k < count; state += residents[k]->world.bodies.size(), ++k) {
    Resident* const r = residents[k];
    if (r->left > 0) continue;
    r->progress = progress[k];
    take_counters(r->progress, profile);
    r->counted = true;
    r->worst = worst[k];
    r->audit = audit[k];
    for (std::size_t i = 0; i < r->world.bodies.size(); ++i) {
      if (r->changed.count(i) != 0) continue;  // a change that has not gone up
      read_state(state[i], r->world.bodies[i]);
      r->marks[i].moved = state[i].flags.w;
      if (i < r->bodies) r->watched_bodies[i] = {state[i].flags.w, (state[i].flags.x & SPHERE_OUTSIDE) != 0};
    }
    r->known = true;
    r->unread = 0;
  }
}

}  // namespace bin_scenes::sphere_gl
