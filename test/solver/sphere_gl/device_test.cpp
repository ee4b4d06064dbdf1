// What solvers leave on a device, and what becomes of them when it is lost.
#include "bin_scenes/gl/device.hpp"
#include "solver/sphere_gl/handful.hpp"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>

namespace bin_scenes::sphere_gl {
namespace {

/// Mesa does not reuse names: together, the tests of this program need more than 10,000.
std::pair<int, int> buffers_and_programs() {
  std::pair<int, int> count{0, 0};
  for (GLuint id = 1; id < 1000000; ++id) count.first += glIsBuffer(id), count.second += glIsProgram(id);
  return count;
}

TEST(SphereGlDevice, SolversLeaveNoObjects) {
  const auto use_one = [](int variant) {
    const auto solver = make_gl_sphere_solver(coarse());
    const WorldId id = Handful(variant).add(*solver);
    solver->advance({id}, 0.02);
    return buffers_and_programs().first;
  };
  use_one(0);  // the device keeps programs of its own from then on
  const auto before = buffers_and_programs();
  for (int i = 0; i < 3; ++i) EXPECT_GT(use_one(i), before.first);
  EXPECT_EQ(buffers_and_programs(), before);
}

TEST(SphereGlDevice, AfterALossTheNextSolverHasADeviceOfItsOwn) {
  const auto hash = fallen(0);
  auto old = make_gl_sphere_solver(coarse());
  const WorldId id = Handful(1).add(*old);
  old->advance({id}, 0.01);
  const std::shared_ptr<gl::Device> lost = gl::Device::shared();
  lost->lose();
  const auto next = make_gl_sphere_solver(coarse());
  EXPECT_NE(gl::Device::shared(), lost);
  const WorldId again = Handful(0).add(*next);
  next->advance({again}, 0.1);
  old.reset();  // its buffers have the same names as those of the next, on another device
  next->advance({again}, 0.1);
  EXPECT_EQ(hash_of(next->states(again)), hash);
}

}  // namespace
}  // namespace bin_scenes::sphere_gl
