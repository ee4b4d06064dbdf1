/// Determines how many bodies a world on the device may have: a work group of the device must be able to hold all of
/// them. Larger worlds run on the CPU.
#pragma once

#include "bin_scenes/gl/device.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

namespace bin_scenes::sphere_gl {

/// Returns whether the device is a software device, and is not used like a graphics card (Capacity::as_on_card).
bool is_software(const Capacity& capacity, const gl::Device& device);
/// Returns the largest number of bodies of a world that a work group of the device can hold.
std::size_t most_bodies(const Capacity& capacity, const gl::Device& device);
/// Throws an input Error if a world has more bodies than `most`.
void check_bodies(std::size_t bodies, std::size_t most, const gl::Device& device);

}  // namespace bin_scenes::sphere_gl
