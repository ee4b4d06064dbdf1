// What `auto` makes of measured figures, and that they can be measured.
#include "solver/device_choice.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

DeviceFigures figures() {
  DeviceFigures f;
  f.cpu = "a processor";
  f.gpu = "a card";
  f.on_cpu = {1e-3, 6e-3, 0.5e-3};     // in proportion to the parts; two cores
  f.on_gpu = {4e-3, 4e-3, 4e-3 / 64};  // fills up by worlds and parts
  return f;
}

TEST(DeviceChoice, GoesByPartsAndScenes) {
  EXPECT_FALSE(choose_device(figures(), 64, 1).gpu);  // 1 against 4 ms
  EXPECT_TRUE(choose_device(figures(), 384, 1).gpu);  // 6 against 4 ms
  EXPECT_TRUE(choose_device(figures(), 64, 64).gpu);  // 0.5 against 0.06 ms
  EXPECT_FALSE(choose_device(figures(), 8, 2).gpu);   // 0.06 against 2 ms
}

TEST(DeviceChoice, ASlowerGpuIsNotTaken) {
  DeviceFigures slow = figures();
  slow.on_gpu = {1.0, 8.0, 0.9};
  for (const std::size_t parts : {1, 64, 384})
    for (const std::size_t scenes : {1, 64, 100000}) EXPECT_FALSE(choose_device(slow, parts, scenes).gpu);
  slow.on_gpu = slow.on_cpu;  // nor one as fast: noise would decide
  EXPECT_FALSE(choose_device(slow, 384, 1).gpu);
}

TEST(DeviceChoice, SaysTheFigures) {
  const std::string reason = choose_device(figures(), 384, 1).reason;
  EXPECT_NE(reason.find("on the GPU: a step of 384 parts takes about 6 ms on the CPU, 4 ms on the GPU"),
            std::string::npos)
      << reason;
}

TEST(DeviceChoice, WhatTheGpuCannotDoStaysOnTheCpu) {
  Request request;
  request.parts.emplace_back();
  request.bin.motion.shake = Vec3(0.01, 0, 0);
  EXPECT_EQ(choose_device(request).reason, "on the CPU: motion is not simulated on the GPU");
}

TEST(DeviceChoice, AWorldThatNoGroupHoldsRunsOnTheCpuAndSaysWhy) {
  Request request;
  request.parts.emplace_back();
  request.parts[0].count = 384;
  request.bin.kind = Bin::Kind::mesh;  // one body more
  std::string reason;
  const auto solver = make_solver({request, {}}, reason);
  EXPECT_EQ(solver->device(), "cpu");
  EXPECT_NE(reason.find("on the CPU: the GPU form takes at most 384 bodies per scene, this one has 385"),
            std::string::npos)
      << reason;
}

/// What is asked for by name is done there or refused, as where there is no OpenGL at all.
TEST(DeviceChoice, AGpuThatWasAskedForRefusesMoreBodiesThanAGroupHolds) {
  Request request;
  request.parts.emplace_back();
  request.parts[0].count = 385;
  request.solver.sphere.device = SphereSettings::Device::gpu;
  try {
    std::string reason;
    make_solver({request, {}}, reason);
    FAIL() << "385 bodies were taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    const std::string text = error.what();
    for (const char* part : {"at most", "this scene has 385", "solver.sphere.device: cpu"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(DeviceChoice, SoftwareOpenGlIsNoGpu) {
  std::string reason;
  Request request;
  request.parts.emplace_back();
  const auto solver = make_solver({request, {}}, reason);
  EXPECT_EQ(solver->device().find("llvmpipe"), std::string::npos);
  EXPECT_NE(reason.find("on the CPU: "), std::string::npos) << reason;
}

TEST(DeviceChoice, MeasuresBothDevices) {
  const DeviceFigures measured = measure_devices(1.0 / 16);
  for (const StepTimes& t : {measured.on_cpu, measured.on_gpu}) {
    EXPECT_GT(t.few_s, 0.0);
    EXPECT_GT(t.many_s, 0.0);
    EXPECT_GT(t.together_s, 0.0);
  }
  EXPECT_FALSE(measured.cpu.empty());
  EXPECT_FALSE(measured.gpu.empty());
}

}  // namespace
}  // namespace bin_scenes
