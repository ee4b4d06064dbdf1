#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/traffic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace bin_scenes::gl {
namespace {

TEST(Device, OpensTheSoftwareRendererWhenAsked) {
  Device& device = Device::current();  // the tests set BIN_SCENES_GL=software
  const std::vector<DeviceInfo> all = Device::enumerate();
  if (std::none_of(all.begin(), all.end(), [](const DeviceInfo& info) { return info.usable && info.software; }))
    GTEST_SKIP() << "there is none here, but " << device.renderer();
  EXPECT_TRUE(device.software()) << device.renderer();
  EXPECT_FALSE(device.version().empty());
}

TEST(Device, EachThreadCountsItsOwnTraffic) {
  Profile profile;
  {
    const TrafficCount count(profile);
    ++traffic().dispatches;
    std::thread([] { traffic().dispatches += 100; }).join();
  }
  EXPECT_EQ(profile.counters.at("gl_dispatches"), 1u);
}

TEST(Device, LimitsHoldWhatThePassesRelyOn) {
  const Limits& limits = Device::current().limits();
  EXPECT_GE(limits.storage_blocks, 8);
  EXPECT_GE(limits.invocations, 1024);
  EXPECT_GE(limits.shared_bytes, 32768);
  EXPECT_GE(limits.groups_per_axis, 65535);
  EXPECT_GE(limits.storage_bytes, 1LL << 27);
}

TEST(Device, EnumerationNamesEveryDeviceAndLeavesTheContextCurrent) {
  const std::string renderer = Device::current().renderer();
  const std::vector<DeviceInfo> infos = Device::enumerate();
  ASSERT_FALSE(infos.empty());
  bool usable = false;
  for (const DeviceInfo& info : infos) {
    EXPECT_FALSE(info.name.empty());
    EXPECT_EQ(info.usable, info.detail.empty()) << info.name << ": " << info.detail;
    usable = usable || info.usable;
  }
  EXPECT_TRUE(usable);
  EXPECT_EQ(Device::current().renderer(), renderer);
  Device::current().make_current();
}

TEST(Device, TwoDevicesLiveSideBySide) {
  {
    Device second;
    EXPECT_FALSE(second.renderer().empty());
  }
  Device::current().make_current();
  EXPECT_FALSE(Device::current().renderer().empty());
}

}  // namespace
}  // namespace bin_scenes::gl
