/// Determines how many bodies a world on the device may have: a work group of the device must be able to hold all of
/// them. Larger worlds run on the CPU.
#pragma once

#include "bin_scenes/gl/device.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

namespace bin_scenes::sphere_gl {

/// Whether it is a software device that is also used like one.
bool is_software(const Capacity& capacity, const gl::Device& device);
/// Bodies of a world that a work group of the device can hold.
std::size_t most_bodies(const Capacity& capacity, const gl::Device& device);
/// Throws for a world of more bodies than that.
void check_bodies(std::size_t bodies, std::size_t most, const gl::Device& device);

}  // namespace bin_scenes::sphere_gl
