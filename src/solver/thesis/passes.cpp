/// Loads the arrays to the device and dispatches the passes of shaders/thesis in order. CPU form:
/// test/solver/thesis/twin.cpp.
#include "passes.hpp"

#include <cstddef>
#include <cstring>

namespace bin_scenes::thesis {

namespace {

gl::Program pass(const std::string& name, const gl::Defines& defines = {}) {
  return gl::Program::compute("thesis/" + name + ".comp", defines);
}
/// Whether the device held something else before; then it holds `values` now.
template <class T>
bool upload_if_new(gl::Buffer<T>& buffer, std::vector<T>& held, const std::vector<T>& values) {
  if (held.size() == values.size() && std::memcmp(held.data(), values.data(), values.size() * sizeof(T)) == 0)
    return false;
  buffer.upload(values);
  held = values;
  return true;
}
gl::Program detect_pass(std::size_t capacity) {
  return pass("detect", {{"CAPACITY", std::to_string(capacity) + "u"}});
}

}  // namespace

Passes::Passes()
    : force_(pass("force")),
      move_to_world_(pass("move_to_world")),
      count_cells_(pass("count_cells")),
      scatter_(pass("scatter")),
      reorder_(pass("reorder")),
      plan_(pass("plan")),
      count_pairs_(pass("count_pairs")),
      split_mass_(pass("split_mass")),
      impulse_(pass("impulse")),
      pre_velocity_(pass("pre_velocity")),
      velocity_(pass("velocity")),
      position_(pass("position")),
      status_back_(sizeof(gpu::ThesisStatus)) {}

void Passes::step() {
  begin_step();
  force();          // gravity, world inertia
  move_to_world();  // sphere centres

  count_cells();  // sorted grid
  prefix_sum();
  scatter();
  reorder();

  detect();  // contacts, and how many per body pair
  plan();
  count_pairs();
  plan();
  split_mass();

  for (gpu::uint i = 0; i < held_.settings.iterations; ++i) {
    impulse();
    pre_velocity();
    velocity();
  }
  position();
}

void Passes::begin_step() {
  bind();
  status_.storage().fill(0, offsetof(gpu::ThesisStatus, touching_spheres), 3 * sizeof(gpu::uint));
  neighbours_.fill(THESIS_NO_KEY, 0, std::size_t{held_.settings.bodies} * held_.settings.neighbour_slots);
}

void Passes::force() {
  held_.states.clear();
  gl::Stage stage(timer_, "force");
  gl::dispatch(force_, held_.settings.bodies);
}

void Passes::move_to_world() {
  gl::Stage stage(timer_, "move_to_world");
  move_to_world_.set("first", 0u);
  move_to_world_.set("count", held_.settings.moving_spheres);
  gl::dispatch(move_to_world_, held_.settings.moving_spheres);
}

void Passes::count_cells() {
  gl::Stage stage(timer_, "count_cells");
  gl::dispatch(count_cells_, held_.settings.spheres);
}

void Passes::prefix_sum() {
  gl::Stage stage(timer_, "prefix_sum");
  prefix_sum_.run(cell_counts_, cell_starts_, held_.settings.cells);
  bind();  // the sum has bindings of its own
}

void Passes::scatter() {
  gl::Stage stage(timer_, "scatter");
  gl::dispatch(scatter_, held_.settings.spheres);
}

void Passes::reorder() {
  gl::Stage stage(timer_, "reorder");
  gl::dispatch(reorder_, held_.settings.spheres);
}

void Passes::detect() {
  gl::Stage stage(timer_, "detect");
  gl::dispatch(detect_, held_.settings.spheres);
}

void Passes::plan() {
  gl::dispatch_groups(plan_, 1, gl::Barrier::arguments);
}

void Passes::count_pairs() {
  gl::Stage stage(timer_, "count_pairs");
  gl::dispatch_indirect(count_pairs_, status_.storage(), offsetof(gpu::ThesisStatus, sphere_groups));
}

void Passes::split_mass() {
  gl::Stage stage(timer_, "split_mass");
  gl::dispatch_indirect(split_mass_, status_.storage(), offsetof(gpu::ThesisStatus, sphere_groups));
}

void Passes::impulse() {
  gl::Stage stage(timer_, "impulse");
  gl::dispatch_indirect(impulse_, status_.storage(), offsetof(gpu::ThesisStatus, sphere_groups));
}

void Passes::pre_velocity() {
  gl::Stage stage(timer_, "pre_velocity");
  gl::dispatch_indirect(pre_velocity_, status_.storage(), offsetof(gpu::ThesisStatus, sphere_groups));
}

void Passes::velocity() {
  held_.states.clear();
  gl::Stage stage(timer_, "velocity");
  gl::dispatch_indirect(velocity_, status_.storage(), offsetof(gpu::ThesisStatus, body_groups));
}

void Passes::position() {
  held_.states.clear();
  gl::Stage stage(timer_, "position");
  gl::dispatch(position_, held_.settings.bodies);
}

void Passes::load(const Memory& memory) {
  const gpu::uint old_capacity = held_.settings.capacity;
  held_.settings = memory.settings;
  if (held_.settings.capacity != old_capacity) detect_ = detect_pass(held_.settings.capacity);
  upload_if_new(settings_, held_settings_, {held_.settings});
  upload_if_new(worlds_, held_.worlds, memory.worlds);
  upload_if_new(sheets_, held_.sheets, memory.sheets);
  bool placed = !upload_if_new(bodies_, held_.bodies, memory.bodies);  // what never moves
  placed &= !upload_if_new(shapes_, held_.shapes, memory.shapes);
  placed &= !upload_if_new(spheres_, held_.spheres, memory.spheres);
  placed &= !upload_if_new(states_, held_.states, memory.states);
  const auto at_least = [](auto& buffer, std::size_t count) {
    if (buffer.size() < count || buffer.size() == 0) buffer.resize(count);
  };
  at_least(needs_, memory.needs.size());
  needs_.fill(0, 0, memory.needs.size());
  at_least(worlds_, 1);
  at_least(sheets_, 1);
  at_least(inertias_, held_.settings.bodies);
  at_least(centers_, held_.settings.spheres);
  at_least(sphere_cells_, held_.settings.spheres);
  at_least(cell_counts_, held_.settings.cells);
  at_least(cell_starts_, std::size_t{held_.settings.cells} + 1);
  at_least(members_, held_.settings.spheres);
  at_least(sorted_, held_.settings.spheres);
  at_least(contact_ranges_, held_.settings.moving_spheres);
  at_least(neighbour_counts_, held_.settings.bodies);
  at_least(touching_spheres_, held_.settings.moving_spheres);
  at_least(touching_bodies_, held_.settings.bodies);
  at_least(pushes_, held_.settings.moving_spheres);
  at_least(status_, 1);
  at_least(contacts_, held_.settings.slots);
  at_least(neighbours_, std::size_t{held_.settings.bodies} * held_.settings.neighbour_slots);
  status_.clear();
  cell_counts_.fill(0, 0, held_.settings.cells);

  if (placed) return;
  bind();
  move_to_world_.set("first", held_.settings.moving_spheres);
  move_to_world_.set("count", held_.settings.spheres - held_.settings.moving_spheres);
  gl::dispatch(move_to_world_, held_.settings.spheres - held_.settings.moving_spheres);
}

const std::vector<gpu::ThesisState>& Passes::states() {
  if (held_.states.empty()) held_.states = states_.download(0, held_.settings.bodies);
  return held_.states;
}

gpu::ThesisStatus Passes::status() {
  status_back_.request(status_.storage(), 0, sizeof(gpu::ThesisStatus));
  return status_back_.wait_as<gpu::ThesisStatus>();
}

std::vector<gpu::ThesisNeed> Passes::needs() const {
  return needs_.download();
}

std::size_t Passes::bytes() const {
  std::size_t sum = 0;
  for (const gl::Storage* s : {&settings_.storage(),
                               &worlds_.storage(),
                               &sheets_.storage(),
                               &bodies_.storage(),
                               &states_.storage(),
                               &inertias_.storage(),
                               &shapes_.storage(),
                               &spheres_.storage(),
                               &centers_.storage(),
                               &sphere_cells_.storage(),
                               &cell_counts_.storage(),
                               &cell_starts_.storage(),
                               &members_.storage(),
                               &sorted_.storage(),
                               &contact_ranges_.storage(),
                               &contacts_.storage(),
                               &neighbours_.storage(),
                               &neighbour_counts_.storage(),
                               &touching_spheres_.storage(),
                               &touching_bodies_.storage(),
                               &pushes_.storage(),
                               &status_.storage(),
                               &needs_.storage()})
    sum += s->bytes();
  return sum;
}

void Passes::bind() const {
  settings_.bind(BIND_SETTINGS);
  worlds_.bind(BIND_WORLDS);
  sheets_.bind(BIND_SHEETS);
  bodies_.bind(BIND_BODIES);
  states_.bind(BIND_STATES);
  inertias_.bind(BIND_INERTIAS);
  shapes_.bind(BIND_SHAPES);
  spheres_.bind(BIND_SPHERES);
  centers_.bind(BIND_CENTERS);
  sphere_cells_.bind(BIND_SPHERE_CELLS);
  cell_counts_.bind(BIND_CELL_COUNTS);
  cell_starts_.bind(BIND_CELL_STARTS);
  members_.bind(BIND_MEMBERS);
  sorted_.bind(BIND_SORTED);
  contact_ranges_.bind(BIND_CONTACT_RANGES);
  contacts_.bind(BIND_CONTACTS);
  neighbours_.bind(BIND_NEIGHBOURS);
  neighbour_counts_.bind(BIND_NEIGHBOUR_COUNTS);
  touching_spheres_.bind(BIND_TOUCHING_SPHERES);
  touching_bodies_.bind(BIND_TOUCHING_BODIES);
  pushes_.bind(BIND_PUSHES);
  status_.bind(BIND_STATUS);
  needs_.bind(BIND_NEEDS);
}

Memory Passes::download() const {
  Memory m;
  m.settings = held_.settings;
  size_scratch(m);
  const auto fetch = [](const auto& buffer, auto& values) { values = buffer.download(0, values.size()); };
  m.worlds = worlds_.download();
  m.sheets = sheets_.download();
  m.bodies = bodies_.download(0, held_.settings.bodies);
  m.shapes = shapes_.download();
  m.spheres = spheres_.download(0, held_.settings.spheres);
  m.states = states_.download(0, held_.settings.bodies);
  fetch(inertias_, m.inertias);
  fetch(centers_, m.centers);
  fetch(sphere_cells_, m.sphere_cells);
  fetch(cell_counts_, m.cell_counts);
  fetch(cell_starts_, m.cell_starts);
  fetch(members_, m.members);
  fetch(sorted_, m.sorted);
  fetch(contact_ranges_, m.contact_ranges);
  fetch(contacts_, m.contacts);
  fetch(neighbours_, m.neighbours);
  fetch(neighbour_counts_, m.neighbour_counts);
  fetch(touching_spheres_, m.touching_spheres);
  fetch(touching_bodies_, m.touching_bodies);
  fetch(pushes_, m.pushes);
  m.status = status_.download().front();
  m.needs = needs();
  return m;
}

}  // namespace bin_scenes::thesis
