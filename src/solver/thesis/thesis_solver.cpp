/// Turns parts into spheres, collects worlds into a batch and runs it by the passes on the device (passes.cpp).
#include "bin_scenes/solver/thesis_solver.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/traffic.hpp"
#include "memory.hpp"
#include "passes.hpp"
#include "solver/step_limit.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace bin_scenes {

namespace {
constexpr std::size_t most_contacts = 64;  // per sphere; a sphere among equal ones touches a dozen
// Steps between observations of the status. One waits for the device and lays the grid anew about the bodies.
constexpr std::uint64_t steps_per_look = 8;

VoxelOptions voxels_of(const PartModel& part, const ThesisSettings& settings) {
  VoxelOptions options;
  options.voxels = settings.voxels;
  options.tightness = settings.tightness;
  const double longest = part.mesh().bounds().size().maxCoeff();
  for (const double share : settings.radii) options.radii.push_back(share * longest);
  return options;
}
}  // namespace

struct ThesisSolver::State {
  std::shared_ptr<gl::Device> device = gl::Device::shared();  ///< first: what is on it goes before it
  ThesisSettings settings;
  thesis::Capacity capacity;
  thesis::Passes passes;
  std::map<WorldId, thesis::World> worlds;
  WorldId next = 0;
  Profile profile;

  explicit State(const ThesisSettings& given) : settings(given) {
    capacity.contacts = static_cast<std::size_t>(std::max(1, given.contacts_per_sphere));
  }
  ~State() { device->try_make_current(); }

  thesis::World& world(WorldId id) {
    const auto found = worlds.find(id);
    BIN_SCENES_ASSERT(found != worlds.end());
    return found->second;
  }

  /// @param share  of a whole step that each of them is
  void run(const std::vector<thesis::World*>& batch, std::uint64_t steps, double share);
  bool grow_if_full(const gpu::ThesisStatus& status, std::size_t moving_spheres,
                    const std::vector<gpu::ThesisNeed>& needs);
  std::vector<std::vector<thesis::World*>> split(const std::vector<thesis::World*>& all) const;
};

ThesisSolver::ThesisSolver(const ThesisSettings& settings) : state_(std::make_unique<State>(settings)) {}
ThesisSolver::~ThesisSolver() = default;

WorldId ThesisSolver::add_world(const WorldDef& def) {
  const ThesisSettings& settings = state_->settings;
  std::vector<thesis::Shape> shapes;
  for (const PartModelPtr& part : def.parts)
    shapes.push_back(thesis::make_shape(part->spheres(voxels_of(*part, settings)).spheres, part->mass()));
  thesis::World world = thesis::make_world(def, shapes, settings);
  if (def.bin.kind == Bin::Kind::mesh && def.bin_model && !shapes.empty()) {
    // As fine as the finest part, so that nothing slips between the bin's spheres.
    double radius = std::numeric_limits<double>::infinity();
    for (const thesis::Shape& shape : shapes)
      for (const Sphere& sphere : shape.spheres) radius = std::min(radius, sphere.radius);
    const double pitch = 2.0 * radius * settings.tightness;
    VoxelOptions options;
    options.tightness = settings.tightness;
    options.voxels = static_cast<int>(std::ceil(def.bin_model->mesh().bounds().size().maxCoeff() / pitch));
    for (const Sphere& sphere : def.bin_model->spheres(options).spheres)
      world.bin_spheres.push_back(
          {def.bin.pose * sphere.center, sphere.radius, def.bin.pose.orientation * sphere.normal});
  }
  return add_world(std::move(world));
}

WorldId ThesisSolver::add_world(thesis::World world) {
  state_->worlds.emplace(state_->next, std::move(world));
  return state_->next++;
}

void ThesisSolver::remove_world(WorldId world) {
  state_->worlds.erase(world);
}

void ThesisSolver::insert(WorldId id, std::size_t body, const BodyState& state) {
  thesis::World& world = state_->world(id);
  BIN_SCENES_ASSERT(body < world.bodies.size() && is_rigid(state.pose));
  world.states[body] = thesis::to_state(state, world.shapes[world.bodies[body].part]);
  world.present[body] = true;
}

void ThesisSolver::remove(WorldId id, std::size_t body) {
  thesis::World& world = state_->world(id);
  BIN_SCENES_ASSERT(body < world.bodies.size());
  world.present[body] = false;
}

bool ThesisSolver::set_phase(WorldId, const Phase&) {
  return false;
}

double ThesisSolver::advance(const std::vector<WorldId>& ids, double seconds) {
  state_->device->make_current();
  const gl::TrafficCount count(state_->profile);
  const Steps steps = steps_in(seconds, step_size());
  std::vector<thesis::World*> worlds;
  for (WorldId id : ids) {
    worlds.push_back(&state_->world(id));
    worlds.back()->steps += steps.count();
  }
  for (const std::vector<thesis::World*>& batch : state_->split(worlds)) {
    state_->run(batch, steps.whole, 1.0);
    if (steps.rest > 0.0) state_->run(batch, 1, steps.rest / step_size());
  }
  state_->profile.count("steps", steps.count() * worlds.size());
  state_->passes.timer().collect(state_->profile, true);
  state_->profile.counters["gl_bytes_held"] = state_->passes.bytes();
  return static_cast<double>(steps.whole) * step_size() + steps.rest;
}

/// Worlds together as long as no buffer grows beyond half of what the driver allows; alone if need be.
std::vector<std::vector<thesis::World*>> ThesisSolver::State::split(const std::vector<thesis::World*>& all) const {
  const auto limit = static_cast<std::size_t>(device->limits().storage_bytes) / 2;
  std::vector<std::vector<thesis::World*>> batches;
  std::size_t used = 0;
  for (thesis::World* world : all) {
    if (std::none_of(world->present.begin(), world->present.end(), [](bool here) { return here; })) continue;
    const std::size_t bytes = thesis::largest_buffer(*world, settings, capacity);
    if (batches.empty() || used + bytes > limit) {
      batches.emplace_back();
      used = 0;
    }
    batches.back().push_back(world);
    used += bytes;
  }
  return batches;
}

void ThesisSolver::State::run(const std::vector<thesis::World*>& batch, std::uint64_t steps, double share) {
  for (std::uint64_t done = 0; done < steps;) {
    const std::uint64_t now = std::min(steps_per_look, steps - done);
    const double horizon = share * static_cast<double>(now) * settings.time_step / settings.sub_steps;
    std::vector<thesis::BodyIndex> index;
    const thesis::Memory memory =
        thesis::lay_out({batch.begin(), batch.end()}, settings, capacity, horizon, index, share);
    passes.load(memory);
    for (std::uint64_t i = 0; i < now; ++i) passes.step();
    const gpu::ThesisStatus status = passes.status();

    const std::vector<gpu::ThesisNeed> needs = passes.needs();
    if (grow_if_full(status, memory.settings.moving_spheres, needs)) {
      profile.count("steps_repeated", now);
      continue;  // the worlds still hold the states from before
    }
    for (std::size_t w = 0; w < batch.size(); ++w) {
      thesis::World& world = *batch[w];
      world.contacts_need = std::max<std::size_t>(world.contacts_need, needs[w].contacts);
      world.neighbours_need = std::max<std::size_t>(world.neighbours_need, needs[w].neighbours);
      world.contacts_dropped = world.contacts_dropped || needs[w].contacts > most_contacts;
    }
    const std::vector<gpu::ThesisState> states = passes.states();
    for (std::size_t b = 0; b < index.size(); ++b) {
      thesis::World& world = *batch[index[b].world];
      if (index[b].body < world.bodies.size()) world.states[index[b].body] = states[b];
    }
    profile.count("contacts", status.contacts);
    profile.count("grid_cells", memory.settings.cells * now);
    done += now;
  }
}

/// True if a buffer was full and there is room for more: the steps since the last observation are to be repeated.
bool ThesisSolver::State::grow_if_full(const gpu::ThesisStatus& status, std::size_t moving_spheres,
                                       const std::vector<gpu::ThesisNeed>& needs) {
  const thesis::Capacity before = capacity;
  if (status.overflow & THESIS_CONTACT_OVERFLOW) {
    std::size_t need = 0;
    for (const gpu::ThesisNeed& world : needs) need = std::max<std::size_t>(need, world.contacts);
    while (capacity.contacts < std::min(need, most_contacts)) capacity.contacts *= 2;
    capacity.contacts = std::min(capacity.contacts, std::max(most_contacts, before.contacts));
  }
  if (status.overflow & THESIS_SLOT_OVERFLOW)  // and a quarter more, for the steps to come
    capacity.mean_contacts = 1.25 * status.most_slots / static_cast<double>(moving_spheres);
  if (status.overflow & THESIS_NEIGHBOUR_OVERFLOW) capacity.neighbours *= 2;
  return capacity.contacts != before.contacts || capacity.mean_contacts != before.mean_contacts ||
         capacity.neighbours != before.neighbours;
}

std::vector<BodyState> ThesisSolver::states(WorldId id) const {
  const thesis::World& world = state_->world(id);
  std::vector<BodyState> states;
  for (std::size_t b = 0; b < world.bodies.size(); ++b)
    states.push_back(thesis::to_body_state(world.states[b], world.shapes[world.bodies[b].part]));
  return states;
}

std::vector<bool> ThesisSolver::asleep(WorldId id) const {
  return std::vector<bool>(state_->world(id).bodies.size(), false);
}

double ThesisSolver::step_size() const {
  return state_->settings.time_step / state_->settings.sub_steps;
}
std::uint64_t ThesisSolver::steps(WorldId world) const {
  return state_->world(world).steps;
}
const Profile& ThesisSolver::profile() const {
  return state_->profile;
}
std::string ThesisSolver::device() const {
  return state_->device->renderer();
}

std::vector<Flag> ThesisSolver::flags(WorldId id) const {
  const thesis::World& world = state_->world(id);
  const auto asked = static_cast<std::size_t>(std::max(1, state_->settings.contacts_per_sphere));
  std::vector<Flag> flags;
  if (world.contacts_dropped)
    flags.push_back({"contacts_dropped",
                     "a sphere touched " + std::to_string(world.contacts_need) + " others; the deepest " +
                         std::to_string(most_contacts) + " were kept",
                     "parts overlap heavily: raise solver.thesis.sub_steps"});
  else if (world.contacts_need > asked)
    flags.push_back({"contact_overflow",
                     "a sphere touched " + std::to_string(world.contacts_need) + " others, with room for " +
                         std::to_string(asked) + ": the buffer was grown and the steps repeated, nothing was lost",
                     "set solver.thesis.contacts_per_sphere to " + std::to_string(world.contacts_need)});
  if (world.neighbours_need > thesis::Capacity().neighbours)
    flags.push_back({"neighbour_overflow",
                     "a body touched " + std::to_string(world.neighbours_need) +
                         " others: its table was grown and the steps repeated, nothing was lost",
                     "none needed"});
  return flags;
}

}  // namespace bin_scenes
