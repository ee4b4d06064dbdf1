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

/// @param diagonal  of the body's part (m)
gpu::SphereBody to_gpu(const sphere::Body& body, float diagonal, std::uint32_t shape, std::uint32_t world);
gpu::SphereState state_of(const sphere::Body& body);
/// What the solver touches, and bookkeeping.
void read_state(const gpu::SphereState& state, sphere::Body& body);

gpu::SphereSettingsBlock to_gpu(const sphere::Settings& settings);
/// What follows from the phase: samples in use, softness, friction, whether forces are forgotten.
void copy_phase(const sphere::World& world, gpu::SphereProgress& progress);
gpu::SpherePlane to_gpu(const sphere::Plane& plane);

/// Pairs and manifolds of a world as one page of its list holds them; `body` counts from `first_body` on the device.
struct ManifoldImage {
  std::vector<gpu::SpherePair> pairs;
  std::vector<gpu::SphereManifold> manifolds;  ///< by slot
  std::vector<gpu::SphereContact> contacts;    ///< SPHERE_MAX_CONTACTS to a slot
  std::vector<gpu::uvec4> ranges;              ///< by body; both pages alike
};
ManifoldImage to_gpu(const sphere::World& world, std::uint32_t first_body);

std::vector<sphere::Manifold> to_cpu(const ManifoldImage& image, const sphere::World& world, std::uint32_t first_body);

}  // namespace bin_scenes::sphere_gl
