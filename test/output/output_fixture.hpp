/// A directory of its own, and a small scene and image with something of everything in them.
#pragma once

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <string>

namespace bin_scenes {

class OutputTest : public ::testing::Test {
 protected:
  OutputTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    dir = std::filesystem::temp_directory_path() / ("bin_scenes_output_" + std::to_string(::getpid()) + info->name());
    std::filesystem::create_directories(dir);
  }
  ~OutputTest() override { std::filesystem::remove_all(dir); }

  std::string path(const std::string& name) const { return (dir / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream file(dir / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Names in the directory, hidden ones too: what was left behind shows.
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(dir), {}));
  }

  std::filesystem::path dir;
};

inline ErrorKind kind_of_failure(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_FALSE(error.remedy().empty());
    return error.kind();
  }
  ADD_FAILURE() << "did not fail";
  return ErrorKind::input;
}

/// 8 x 6 pixels: a slope of the bin, part 0 in columns 1-2, part 2 in column 5, nothing seen in the last column.
inline RangeImage small_image() {
  RangeImage image;
  image.sensor.name = "left";
  image.sensor.width = 8;
  image.sensor.height = 6;
  image.width = 8;
  image.height = 6;
  image.sensor.k = {10, 0, 3.5, 0, 10, 2.5, 0, 0, 1};
  Pose pose;
  pose.position = Vec3(0.1, -0.2, 0.9);
  pose.orientation = Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()));
  image.sensor.pose = pose;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      const bool seen = x < 7;
      image.depth.push_back(seen ? 0.8f + 0.01f * static_cast<float>(x) + 0.0001f * static_cast<float>(y) : nan);
      image.label.push_back(x == 1 || x == 2 ? 1 : x == 5 ? 3 : 0);
      image.normal.push_back(seen ? std::array<float, 3>{0, 0, -1} : std::array<float, 3>{nan, nan, nan});
      image.validity.push_back(seen ? 0 : 1);
      image.snr.push_back(seen ? 12.34f + static_cast<float>(y) : 0.0f);
      image.intensity.push_back(seen ? 0.5f + 0.05f * static_cast<float>(x) : nan);
    }
  }
  image.visible = {12, 0, 6};
  image.total = {24, 10, 6};
  return image;
}

inline Scene small_scene() {
  Scene scene;
  scene.seed = 18446744073709551615u;
  scene.index = 12;
  for (int id = 0; id < 3; ++id) {
    ScenePart part;
    part.id = id;
    part.line = id == 1 ? 1 : 0;
    part.model = id == 1 ? "nut \"M8\".stl" : "bolt.stl";
    part.pose.position = Vec3(0.1 * id + 1.0 / 3.0, -1e-17, 5e-324);
    part.pose.orientation = Quat(0.1 + id, 0.2, 0.3, 0.4).normalized();
    part.state = id == 1 ? PartState::escaped : PartState::resting;
    scene.parts.push_back(part);
  }
  scene.parts[0].visible_fraction["left"] = 0.1 + 0.2;  // not 0.3: all digits have to be there
  scene.parts[1].velocity.linear.x() = 1.0 / 7.0;
  scene.sensors = {small_image().sensor};
  scene.report.at_rest = true;
  scene.report.reasons = {"1 part escaped"};
  scene.report.solver = "bullet";
  scene.report.device = "cpu";
  scene.report.simulated_s = 2.1;
  scene.report.steps = 210;
  scene.report.escaped = {1};
  scene.report.state_hash = 0xfedcba9876543210u;
  scene.report.penetration.pair = {0, 2};
  scene.report.flags = {{"mesh_repaired", "1 hole closed", "close it in the CAD"}};
  return scene;
}

}  // namespace bin_scenes
