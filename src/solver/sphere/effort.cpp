/// How much more than the default a heap asks of the solver: by its layers, the thinnest parts and the ratio of masses.
#include "solver/sphere/effort.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes::sphere {

namespace {

/// Number of layers of the full heap, with the usual assumption that parts fill a quarter of a heap's volume.
float layers_to_come(const WorldDef& def) {
  const bool mesh = def.bin.kind == Bin::Kind::mesh;
  if (!mesh && def.bin.kind != Bin::Kind::box) return 0;
  const Vec3 size = mesh ? def.bin_model->mesh().bounds().size() : def.bin.inner_size;
  double cover = 0, filled = 0;
  for (const BodyDef& body : def.bodies) {
    if (body.fixed) continue;
    const double taken = 4.0 * def.parts[body.part]->mass().volume;
    cover += std::pow(taken, 2.0 / 3.0);
    filled += taken;
  }
  if (!(filled > 0) || !(size.minCoeff() > 0)) return 0;
  return static_cast<float>(cover / (size.x() * size.y()) * std::min(1.0, size.prod() / filled));
}

/// Range of the values, extrapolated from the centre four fifths, so that one part far above the others does not make
/// the heap high.
float reach(std::vector<float>& values) {
  const auto last = static_cast<float>(values.size() - 1);
  const auto tail = static_cast<std::size_t>(0.1f * last + 0.5f);
  std::sort(values.begin(), values.end());
  const auto within = static_cast<float>(values.size() - 1 - 2 * tail);
  return within > 0 ? (values[values.size() - 1 - tail] - values[tail]) * last / within : 0;
}

/// Positions and size of the movable parts.
struct Heap {
  std::array<std::vector<float>, 3> places;  ///< m; the last array is along the axis closest to gravity
  float edge = 0;                            ///< m: mean edge of a cube with a part's diagonal

  explicit Heap(const World& world) {
    int down = 0;
    world.gravity.cwiseAbs().maxCoeff(&down);
    for (const Body& b : world.bodies) {
      if (!b.present || b.inverse_mass == 0 || !b.x.allFinite()) continue;
      for (int axis = 0; axis < 3; ++axis) places[axis].push_back(b.x[(down + 1 + axis) % 3]);
      edge += world.shapes[b.shape]->size / std::sqrt(3.0f);
    }
    if (!empty()) edge /= count();
  }
  bool empty() const { return places[0].empty(); }
  float count() const { return static_cast<float>(places[0].size()); }

  /// Height of the heap / edge of the cube that is one part's share of its volume.
  float layers() {
    const Vec3f size = Vec3f(reach(places[0]), reach(places[1]), reach(places[2])) + Vec3f::Constant(edge);
    return std::min(count(), size[2] / std::cbrt(size.prod() / count()));
  }
  /// All parts stand one on another, so that each carries all parts above it.
  bool is_tower() const {
    const auto within = [&](const std::vector<float>& p) {
      const auto [least, most] = std::minmax_element(p.begin(), p.end());
      return *most - *least < 0.5f * edge;
    };
    return within(places[0]) && within(places[1]);
  }
};

/// Effort with which soft contacts sag by at most `share` of a part's thickness (m) under a load of `weights` times its
/// own weight. Soft contacts are springs whose frequency is a share of the sub-step rate; their sag is load /
/// frequency^2. A plate that has sunk in by a tenth of its thickness is pushed out sideways instead of back.
float stiff_enough(const World& world, float weights, float thickness, float share) {
  if (!(thickness > 0)) return 0;
  const float h = world.whole_step / static_cast<float>(world.settings.sub_steps * world.settings.soft.refinement);
  return std::sqrt(weights * world.gravity.norm() * h * h / (share * thickness));
}

/// Effort for light parts under heavier ones: the layers above weigh as much as the mean part, or one of them is the
/// heaviest part.
float effort_of_weights(const World& world, float layers) {
  float sum = 0, heaviest = 0, most = 0;
  int count = 0;
  for (const Body& b : world.bodies) {
    if (b.inverse_mass == 0) continue;
    heaviest = std::max(heaviest, 1 / b.inverse_mass);
    sum += 1 / b.inverse_mass;
    ++count;
  }
  if (count == 0) return 0;
  const float load = std::max(layers * sum / static_cast<float>(count), heaviest);
  for (const Body& b : world.bodies)
    if (b.inverse_mass > 0)
      most = std::max(most, stiff_enough(world, load * b.inverse_mass, world.shapes[b.shape]->thickness,
                                         world.settings.loaded_part_sag));
  return std::min(most, world.settings.max_load_effort);
}

/// A tower buckles under its own weight. The load it can carry falls with the cube of its height (Greenhill 1881), and
/// stiffness grows with the square of the effort.
float effort_of_tower(const World& world, const Heap& heap) {
  const float parts = heap.count();
  return std::min(world.settings.tower_effort * parts * std::sqrt(parts), world.settings.max_tower_effort);
}

int effort_of_layers(const World& world, float layers) {
  const float thin = stiff_enough(world, layers, world.least_thickness, world.settings.thin_part_sag);
  return std::max(1, static_cast<int>(std::ceil(std::max(thin, effort_of_weights(world, layers)))));
}

}  // namespace

int effort_to_come(const World& world, const WorldDef& def) {
  return effort_of_layers(world, layers_to_come(def));
}

float mass_ratio_of(const World& world) {
  float light = 0, heavy = 0;  // inverse masses of the lightest and of the heaviest part
  for (const Body& b : world.bodies) {
    if (b.inverse_mass == 0) continue;
    light = std::max(light, b.inverse_mass);
    heavy = heavy > 0 ? std::min(heavy, b.inverse_mass) : b.inverse_mass;
  }
  BIN_SCENES_ASSERT(light >= heavy);
  return heavy > 0 ? light / heavy : 1;
}

int effort_of_masses(const World& world) {
  const float work = std::sqrt(mass_ratio_of(world) / world.settings.default_mass_ratio);
  return static_cast<int>(std::ceil(std::min(std::max(work, 1.0f), world.settings.max_mass_effort)));
}

float push_speed_of_masses(const World& world) {
  // The bias of a contact presses with at most mass x a2 x push speed in a sub-step (softly() in contact.h); the mass
  // is that of the light part. It has to carry the weight of the heavy one, and as much again to lift it.
  const Softness& stiff = world.settings.stiff;
  const float angle = 2.0f * static_cast<float>(M_PI) * stiff.hertz_share;
  const float a2 = angle * (2.0f * stiff.damping_ratio + angle);
  const float h = world.whole_step / static_cast<float>(world.settings.sub_steps);
  const float needed = 2.0f * world.mass_ratio * world.gravity.norm() * h / (a2 * world.smallest_size);
  return std::max(world.settings.push_speed, needed);
}

int effort_of(const World& world) {
  Heap heap(world);
  if (heap.empty() || world.gravity.isZero()) return effort_of_layers(world, 0);  // no part lies on another
  const float layers = heap.layers();
  const float work =
      std::max(layers / world.settings.default_layers, heap.is_tower() ? effort_of_tower(world, heap) : 0);
  return std::max(static_cast<int>(std::ceil(work)), effort_of_layers(world, layers));
}

}  // namespace bin_scenes::sphere
