/// Buffers of all worlds, their growth, and the dispatches of a step. CPU form of each pass: src/solver/sphere/passes.
#include "solver/sphere_gl/batch.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/gl/device.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

namespace bin_scenes::sphere_gl {

namespace {

constexpr std::size_t status_words = sizeof(gpu::SphereStatus) / sizeof(gpu::uint);
constexpr std::size_t job_words = sizeof(gpu::SphereJob) / sizeof(gpu::uint);

bool is_software(const Capacity& capacity) {
  return gl::Device::current().software() && !capacity.as_on_card;
}

/// Groups that fill a device; each takes pair after pair.
std::size_t groups_at_once(const Capacity& capacity) {
  return is_software(capacity) ? 8 : 2048;
}

/// Grows by an eighth at least: few copies, little room that is never used.
template <class T>
void at_least(gl::Buffer<T>& buffer, std::size_t count) {
  if (buffer.size() < count || buffer.size() == 0)
    buffer.grow(std::max<std::size_t>({count, buffer.size() + buffer.size() / 8, 1}));
}

/// Rows that are needed where all contacts are solved. A block of manifolds has as many for each as its longest needs,
/// and manifolds are in order of the contacts that press: 256 connecting rods with 2,671 contacts need 4,290 rows.
std::size_t rows_for(std::size_t contacts) {
  return contacts + 5 * contacts / 8;
}

/// Of a list of pairs that may come near: each two bodies, and each with the ground.
std::size_t most_entries(std::size_t bodies) {
  return bodies * (bodies + 1) / 2;
}

/// Room for what a list needs now and, most likely, in the steps to come.
std::size_t grown(std::size_t old, std::size_t need) {
  return std::max(old + old / 16, need + need / 16) + 1;
}

template <class T>
void move_within(gl::Buffer<T>& buffer, std::size_t from, std::size_t to, std::size_t count) {
  if (from == to || count == 0) return;
  if (from < to + count && to < from + count) {  // a copy within a buffer may not overlap
    gl::Storage aside("sphere.aside");
    aside.allocate(count * sizeof(T));
    aside.copy_from(buffer.storage(), from * sizeof(T), 0, count * sizeof(T));
    buffer.storage().copy_from(aside, 0, to * sizeof(T), count * sizeof(T));
    return;
  }
  buffer.storage().copy_from(buffer.storage(), from * sizeof(T), to * sizeof(T), count * sizeof(T));
}

gl::Program pass(const char* name, const gl::Defines& defines = {}) {
  return gl::Program::compute(std::string("sphere/") + name + ".comp", defines);
}

/// A pass of a group a world. A color of 256 parts has some 70 manifolds, and there are as many bodies as invocations;
/// on a software device an invocation that waits costs as much as one that works.
gl::Program world_pass(const char* name, const Capacity& capacity) {
  std::size_t group = capacity.world_group;
  if (group == 0) group = is_software(capacity) ? SPHERE_WORLD_GROUP : 256;
  return pass(name, {{"SPHERE_WORLD_GROUP", std::to_string(group)}});
}

/// On an H200 groups of 32 found the contacts of 264 worlds in 101 ms a step, groups of 64 in 441 ms (gpu.md).
std::size_t pair_group(const Capacity& capacity) {
  if (capacity.pair_group > 0) return capacity.pair_group;
  return is_software(capacity) ? SPHERE_PAIR_GROUP : 32;
}

}  // namespace

Batch::Batch(const Capacity& capacity)
    : capacity_(capacity),
      contact_groups_(groups_at_once(capacity)),
      pair_group_(pair_group(capacity)),
      find_pairs_(world_pass("find_pairs", capacity)),
      list_jobs_(pass("list_jobs")),
      color_manifolds_(world_pass("color_manifolds", capacity)),
      solve_(world_pass("solve", capacity)),
      note_depths_(world_pass("note_depths", capacity)),
      update_sleep_(world_pass("update_sleep", capacity)),
      begin_watch_(world_pass("begin_watch", capacity)),
      watch_rest_(world_pass("watch_rest", capacity)),
      audit_energy_(world_pass("audit_energy", capacity)) {
  const gl::Defines group = {{"SPHERE_PAIR_GROUP", std::to_string(pair_group_)}};
  collect_samples_ = pass("collect_samples", group);
  test_samples_ = pass("test_samples", group);
  offer_contacts_ = pass("offer_contacts", group);
  choose_contacts_ = pass("choose_contacts", group);
  prepare_rows_ = pass("prepare_rows");
}

std::size_t Batch::most_candidates() const {
  constexpr std::size_t of_a_pair = 200000;  // no part has as many nodes and edges
  if (!(settings_block_.recycle > 0)) return std::numeric_limits<std::size_t>::max();  // each attempt begins anew
  if (capacity_.most_candidates > 0) return capacity_.most_candidates;
  const double most =
      std::min(static_cast<double>(gl::Device::current().limits().storage_bytes), 0.25 * capacity_.memory) /
      sizeof(gpu::SphereCandidate);
  return std::max(of_a_pair, static_cast<std::size_t>(most));
}

void Batch::make_room() {
  const std::size_t bodies = body_arena_.size(), pairs = pair_arena_.size();
  at_least(settings_, 1);
  at_least(running_, slots_.size());
  at_least(worlds_, slots_.size());
  at_least(progress_, slots_.size());
  at_least(worst_, slots_.size());
  at_least(asks_, slots_.size());
  at_least(audits_, slots_.size());
  at_least(seen_, slots_.size());
  at_least(colors_, slots_.size() * (SPHERE_COLORS + 1));
  at_least(planes_, plane_arena_.size());
  at_least(bodies_, bodies);
  at_least(states_, bodies);
  at_least(watched_, bodies);
  at_least(tensors_, bodies);
  at_least(ranges_, bodies);
  at_least(boxes_, bodies);
  at_least(near_, word_arena_.size());
  at_least(pairs_, 2 * pairs);
  at_least(free_, pairs);
  at_least(manifolds_, pairs);
  at_least(contacts_, SPHERE_MAX_CONTACTS * pairs);
  at_least(order_, pairs);
  at_least(rows_, row_arena_.size() * SPHERE_ROW_PARTS);
  at_least(impulses_, row_arena_.size() * SPHERE_ROW_PARTS);
  if (jobs_.size() < status_words + job_words * pairs) {
    at_least(jobs_, status_words + job_words * pairs);
    gpu::SphereStatus none{};
    none.groups = none.sample_groups = none.touch_groups = {0, 1, 1, 0};
    jobs_.storage().write(0, &none, sizeof none);
  }
  const auto room = [&](std::size_t least) {
    return std::max<std::size_t>(1, std::min(std::max(least, capacity_.candidates * pairs), most_candidates()));
  };
  const std::size_t samples = room(least_samples_);
  near_samples_.grow(samples * SPHERE_SAMPLE_KINDS / 2);
  touches_.grow(samples);
  candidate_list_.grow(room(least_candidates_));
  settings_block_.samples = static_cast<gpu::uint>(samples);
  settings_block_.candidates = static_cast<gpu::uint>(candidate_list_.size());
  bound_ = false;
}

void Batch::take_region(Slot slot, const sphere::World& world) {
  Region& r = regions_[slot];
  r.bodies = world.bodies.size();
  BIN_SCENES_ASSERT(r.bodies <= SPHERE_MAX_BODIES);
  r.words = (r.bodies + 31) / 32;
  r.planes = world.planes.size();
  r.capacity = std::max(capacity_.pairs * r.bodies, world.manifolds.size());
  std::size_t contacts = 0;
  for (const sphere::Manifold& m : world.manifolds) contacts += m.contacts.size();
  r.rows = std::max(capacity_.rows * r.bodies, rows_for(contacts));
  r.first_body = body_arena_.take(r.bodies);
  r.first_word = word_arena_.take(r.bodies * r.words + most_entries(r.bodies));
  r.first_plane = plane_arena_.take(r.planes);
  r.first_pair = pair_arena_.take(r.capacity);
  r.first_row = row_arena_.take(r.rows);
  r.sharing_sweeps = static_cast<std::size_t>(world.impact_sweeps(false));
  r.impact_sweeps = static_cast<std::size_t>(world.impact_sweeps(true));
}

Batch::Slot Batch::add(const sphere::World& world, gpu::SphereProgress& progress) {
  const Slot slot = slots_.take(1);
  if (slot >= regions_.size()) {
    regions_.resize(slot + 1);
    host_worlds_.resize(slot + 1);
  }
  take_region(slot, world);
  const Region& r = regions_[slot];
  settings_block_ = to_gpu(world.settings);
  settings_block_.contact_groups = static_cast<gpu::uint>(contact_groups_);
  make_room();

  gpu::SphereWorld& w = host_worlds_[slot];
  w.gravity = vec4(world.gravity, world.smallest_size);
  w.ground = {world.ground_friction, world.ground_restitution, world.wall_top, world.thinnest};
  w.tolerance = {world.tolerance(false), world.tolerance(true), world.exact_impacts ? 1.0f : 0.0f, 0};
  upload_world(slot);
  std::vector<gpu::SpherePlane> planes;
  for (const sphere::Plane& plane : world.planes) planes.push_back(to_gpu(plane));
  planes_.upload(r.first_plane, planes.data(), planes.size());
  std::vector<gpu::SphereBody> bodies;
  for (const sphere::Body& b : world.bodies) {
    const sphere::Shape& shape = *world.shapes[b.shape];
    bodies.push_back(to_gpu(b, shape.diagonal, shapes_.index_of(shape), static_cast<gpu::uint>(slot)));
  }
  bodies_.upload(r.first_body, bodies.data(), bodies.size());
  upload_states(slot, world);
  progress = upload_pairs(slot, world);
  copy_phase(world, progress);
  progress.cold_steps = static_cast<gpu::uint>(world.cold_steps);
  progress.struck = world.struck ? 1 : 0;
  upload_progress({{slot, progress}});
  forget_worst(slot);
  return slot;
}

gpu::SphereProgress Batch::upload_pairs(Slot slot, const sphere::World& world) {
  const Region& r = regions_[slot];
  ManifoldImage image = to_gpu(world, static_cast<gpu::uint>(r.first_body));
  ranges_.upload(r.first_body, image.ranges.data(), r.bodies);
  pairs_.upload(2 * r.first_pair, image.pairs.data(), image.pairs.size());
  manifolds_.upload(r.first_pair, image.manifolds.data(), image.manifolds.size());
  contacts_.upload(SPHERE_MAX_CONTACTS * r.first_pair, image.contacts.data(), image.contacts.size());
  const std::size_t free = r.capacity - image.pairs.size();
  std::vector<gpu::uint> slots(free);
  for (std::size_t i = 0; i < free; ++i) slots[i] = static_cast<gpu::uint>(r.capacity - 1 - i);
  free_.upload(r.first_pair, slots.data(), free);
  gpu::SphereProgress progress{};
  progress.pairs = static_cast<gpu::uint>(image.pairs.size());
  progress.free_slots = static_cast<gpu::uint>(free);
  return progress;
}

void Batch::upload_world(Slot slot) {
  const Region& r = regions_[slot];
  const auto word = [](std::size_t n) { return static_cast<gpu::uint>(n); };
  host_worlds_[slot].bodies = {word(r.first_body), word(r.bodies), word(r.words), word(r.first_word)};
  host_worlds_[slot].pairs = {word(r.first_pair), word(r.capacity), word(r.first_plane), word(r.planes)};
  host_worlds_[slot].rows = {word(r.first_row), word(r.rows), word(r.impact_sweeps), word(r.sharing_sweeps)};
  worlds_.upload(slot, &host_worlds_[slot], 1);
}

void Batch::remove(Slot slot) {
  const Region& r = regions_[slot];
  body_arena_.give(r.first_body);
  word_arena_.give(r.first_word);
  plane_arena_.give(r.first_plane);
  pair_arena_.give(r.first_pair);
  row_arena_.give(r.first_row);
  slots_.give(slot);
}

void Batch::upload_states(Slot slot, const sphere::World& world, const std::set<std::size_t>& bodies,
                          const std::vector<Mark>& marks) {
  std::vector<gpu::SphereState> states;
  for (auto body = bodies.begin(); body != bodies.end();) {
    const std::size_t first = *body;
    states.clear();
    for (; body != bodies.end() && *body == first + states.size(); ++body) {
      states.push_back(state_of(world.bodies[*body]));
      states.back().flags.z = marks[*body].enters ? 1u : 0u;
      states.back().flags.w = marks[*body].moved;
    }
    states_.upload(regions_[slot].first_body + first, states.data(), states.size());
  }
}

void Batch::upload_states(Slot slot, const sphere::World& world) {
  std::vector<gpu::SphereState> states;
  for (const sphere::Body& b : world.bodies) states.push_back(state_of(b));
  states_.upload(regions_[slot].first_body, states.data(), states.size());
}

namespace {

/// Entries by slot; neighbours are one copy.
template <class T>
void upload_by_slot(gl::Buffer<T>& buffer, std::vector<std::pair<Batch::Slot, T>> entries) {
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<T> neighbours;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& [slot, entry] = entries[i];
    neighbours.push_back(entry);
    if (i + 1 < entries.size() && entries[i + 1].first == slot + 1) continue;
    buffer.upload(slot + 1 - neighbours.size(), neighbours.data(), neighbours.size());
    neighbours.clear();
  }
}

template <class T>
void add_range(std::vector<gl::ReadBack::Range>& ranges, const gl::Buffer<T>& buffer, std::size_t first,
               std::size_t count) {
  ranges.push_back({&buffer.storage(), first * sizeof(T), count * sizeof(T)});
}

}  // namespace

void Batch::upload_progress(std::vector<std::pair<Slot, gpu::SphereProgress>> worlds) {
  upload_by_slot(progress_, std::move(worlds));
}

void Batch::upload_asks(std::vector<std::pair<Slot, gpu::SphereAsk>> worlds) {
  upload_by_slot(asks_, std::move(worlds));
}

void Batch::forget_worst(Slot slot) {
  const gpu::SphereWorst none{};
  worst_.upload(slot, &none, 1);
}

void Batch::request(const std::vector<Slot>& seen, const std::vector<Slot>& read, gl::ReadBack& back) const {
  std::vector<gl::ReadBack::Range> ranges;
  for (const Slot slot : seen) add_range(ranges, seen_, slot, 1);
  for (const Slot slot : read) add_range(ranges, progress_, slot, 1);
  for (const Slot slot : read) add_range(ranges, worst_, slot, 1);
  for (const Slot slot : read) add_range(ranges, audits_, slot, 1);
  for (const Slot slot : read) add_range(ranges, states_, regions_[slot].first_body, regions_[slot].bodies);
  back.request(ranges);
}

void Batch::request_progress(const std::vector<Slot>& slots, gl::ReadBack& back) const {
  std::vector<gl::ReadBack::Range> ranges;
  for (const Slot slot : slots) add_range(ranges, progress_, slot, 1);
  back.request(ranges);
}

void Batch::grow_pairs(Slot slot, gpu::SphereProgress& progress) {
  Region& r = regions_[slot];
  const std::size_t old_first = r.first_pair, old = r.capacity;
  r.capacity = grown(old, progress.need);
  const bool stays = pair_arena_.extend(old_first, r.capacity);
  if (!stays) r.first_pair = pair_arena_.take(r.capacity);  // the old region is given back when its contents are away
  make_room();
  if (progress.page == 0)
    move_within(pairs_, 2 * old_first, 2 * r.first_pair, progress.pairs);
  else
    move_within(pairs_, 2 * old_first + old, 2 * r.first_pair + r.capacity, progress.pairs);
  move_within(manifolds_, old_first, r.first_pair, old);
  move_within(contacts_, SPHERE_MAX_CONTACTS * old_first, SPHERE_MAX_CONTACTS * r.first_pair,
              SPHERE_MAX_CONTACTS * old);
  move_within(free_, old_first, r.first_pair, progress.free_slots);
  std::vector<gpu::uint> fresh(r.capacity - old);
  std::iota(fresh.begin(), fresh.end(), static_cast<gpu::uint>(old));
  free_.upload(r.first_pair + progress.free_slots, fresh.data(), fresh.size());
  progress.free_slots += static_cast<gpu::uint>(fresh.size());
  if (!stays) pair_arena_.give(old_first);
  upload_world(slot);
}

void Batch::grow_rows(Slot slot, std::size_t need) {
  Region& r = regions_[slot];
  r.rows = need > r.rows ? grown(r.rows, need) : r.rows;
  if (!row_arena_.extend(r.first_row, r.rows)) {
    row_arena_.give(r.first_row);
    r.first_row = row_arena_.take(r.rows);
  }
  make_room();
  upload_world(slot);
}

void Batch::grow_candidates(std::size_t samples, std::size_t candidates) {
  // What one step needs is far from what the next one does: with a quarter more room few steps are repeated.
  least_samples_ = std::max(least_samples_, samples + samples / 4);
  least_candidates_ = std::max(least_candidates_, candidates + candidates / 4);
  make_room();
}

void Batch::download(Slot slot, sphere::World& world) const {
  const Region& r = regions_[slot];
  const std::vector<gpu::SphereState> states = states_.download(r.first_body, r.bodies);
  for (std::size_t i = 0; i < r.bodies; ++i) read_state(states[i], world.bodies[i]);
  world.manifolds = to_cpu(manifolds(slot), world, static_cast<std::uint32_t>(r.first_body));
}

ManifoldImage Batch::manifolds(Slot slot) const {
  const Region& r = regions_[slot];
  const gpu::SphereProgress progress = this->progress(slot);
  ManifoldImage image;
  image.pairs = pairs_.download(2 * r.first_pair + progress.page * r.capacity, progress.pairs);
  image.manifolds = manifolds_.download(r.first_pair, r.capacity);
  image.contacts = contacts_.download(SPHERE_MAX_CONTACTS * r.first_pair, SPHERE_MAX_CONTACTS * r.capacity);
  return image;
}

}  // namespace bin_scenes::sphere_gl
