#include "solver/sphere_gl/capacity.hpp"

#include "bin_scenes/core/error.hpp"
#include "shared/sphere.h"

#include <algorithm>

namespace bin_scenes::sphere_gl {

bool is_software(const Capacity& capacity, const gl::Device& device) {
  return device.software() && !capacity.as_on_card;
}

std::size_t most_bodies(const Capacity& capacity, const gl::Device& device) {
  if (capacity.group_bodies > 0) return std::min<std::size_t>(capacity.group_bodies, SPHERE_MAX_BODIES);
  return is_software(capacity, device) ? software_group_bodies : SPHERE_MAX_BODIES;
}

void check_bodies(std::size_t bodies, std::size_t most, const gl::Device& device) {
  if (bodies <= most) return;
  throw input_error("on " + device.renderer() + " the sphere solver takes at most " + std::to_string(most) +
                        " bodies per scene, a mesh bin counted; this scene has " + std::to_string(bodies),
                    "solver.sphere.device", "set solver.sphere.device: cpu");
}

std::size_t worlds_at_once(const Capacity& capacity, std::size_t storage_bytes, bool software) {
  constexpr double body_bytes = 6000.0;  // on the device, with a share of the common lists: docs/develop/gpu.md
  const double most = software ? 4.0 : 1024.0;
  const double bodies = static_cast<double>(std::max<std::size_t>(capacity.bodies, 1));
  const double largest_list =
      static_cast<double>(capacity.pairs * SPHERE_MAX_CONTACTS * sizeof(gpu::SphereContact)) * bodies;
  const double fit = std::min(
      {most, capacity.memory / (body_bytes * bodies), 0.5 * static_cast<double>(storage_bytes) / largest_list});
  return static_cast<std::size_t>(std::max(1.0, fit));
}

}  // namespace bin_scenes::sphere_gl
