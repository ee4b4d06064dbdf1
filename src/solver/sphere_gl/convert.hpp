/// Converts between the structs of the CPU passes (solver/sphere/world.hpp) and those of the shaders (shared/sphere.h).
/// The functions only copy values and pack flags; nothing is computed.
#pragma once

#include "shared/sphere.h"
#include "solver/sphere/world.hpp"

#include <cstring>
#include <vector>

namespace bin_scenes::sphere_gl {

inline gpu::vec4 vec4(const sphere::Vec3f& v, float w = 0.0f) {
  return {v.x(), v.y(), v.z(), w};
}
inline gpu::vec3 three(const sphere::Vec3f& v) {
  return {v.x(), v.y(), v.z()};
}
inline gpu::vec4 vec4(const sphere::Quatf& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}
inline std::uint32_t word_of(float f) {
  std::uint32_t word;
  std::memcpy(&word, &f, sizeof word);
  return word;
}
inline sphere::Vec3f vec3(const gpu::vec4& v) {
  return {v.x, v.y, v.z};
}
inline sphere::Vec3f vec3(const gpu::vec3& v) {
  return {v.x, v.y, v.z};
}
inline sphere::Quatf quat(const gpu::vec4& v) {
  return {v.w, v.x, v.y, v.z};
}

/// @param diagonal  diagonal of the bounding box of the body's part (m)
gpu::SphereBody to_gpu(const sphere::Body& body, float diagonal, std::uint32_t shape, std::uint32_t world);
gpu::SphereState state_of(const sphere::Body& body);
/// Copies pose, velocities and bookkeeping of a body from a state of the device.
void read_state(const gpu::SphereState& state, sphere::Body& body);

gpu::SphereSettingsBlock to_gpu(const sphere::Settings& settings);
/// Copies the settings of the stage of settling: samples in use, softness, friction, effort, sleep, forgotten forces.
void copy_phase(const sphere::World& world, gpu::SphereProgress& progress);
gpu::SpherePlane to_gpu(const sphere::Plane& plane);

/// Pairs and manifolds of a world as on the device, where its bodies begin at the index `first_body`.
struct ManifoldImage {
  std::vector<gpu::SpherePair> pairs;
  std::vector<gpu::SphereManifold> manifolds;  ///< index: slot of the manifold
  std::vector<gpu::SphereContact> contacts;    ///< SPHERE_MAX_CONTACTS elements for each slot
  std::vector<gpu::uvec4> ranges;              ///< by body: begin and end of its pairs (as a) in page 0 and page 1
};
ManifoldImage to_gpu(const sphere::World& world, std::uint32_t first_body);

std::vector<sphere::Manifold> to_cpu(const ManifoldImage& image, const sphere::World& world, std::uint32_t first_body);

}  // namespace bin_scenes::sphere_gl
