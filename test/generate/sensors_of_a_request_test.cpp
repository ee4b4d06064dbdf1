#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"
#include "box_mesh.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace bin_scenes {
namespace {

class SensorsOfARequest : public ::testing::Test {
 protected:
  SensorsOfARequest() {
    path = std::filesystem::temp_directory_path() / ("bin_scenes_sensors_" + std::to_string(::getpid()) + ".stl");
    std::ofstream(path) << box_stl(0.04);
  }
  ~SensorsOfARequest() override { std::filesystem::remove(path); }

  Request boxes(std::size_t count) const {
    Request r;
    r.solver.type = SolverType::bullet;
    r.bin.inner_size = Vec3(0.2, 0.2, 0.2);
    r.parts.emplace_back();
    r.parts[0].model = "box.stl";
    r.parts[0].path = path.string();
    r.parts[0].count = count;
    return r;
  }
  static std::vector<Generator::Result> run(const Request& request, const Generator::Options& options) {
    std::vector<Generator::Result> results;
    Generator().generate(request, options, [&](Generator::Result&& result) { results.push_back(std::move(result)); });
    return results;
  }

  std::filesystem::path path;
};

TEST_F(SensorsOfARequest, ImagesCostNothingUnlessTheyAreWanted) {
  Request request = boxes(3);
  request.sensors.resize(2);
  request.sensors[0].model = "structured_light";
  request.sensors[1].name = "exact";
  for (Sensor& sensor : request.sensors) sensor.width = 64, sensor.height = 48;
  Generator::Options options;
  for (const bool wanted : {false, true}) {
    options.render = wanted;
    Generator::Result result = std::move(run(request, options).at(0));
    auto& counters = result.scene.report.profile.counters;
    EXPECT_EQ(result.images.size(), wanted ? 2u : 0u);
    EXPECT_EQ(counters["views"], wanted ? 2u : 0u);
    EXPECT_EQ(counters["silhouettes"], wanted ? 6u : 0u);
    EXPECT_EQ(counters["noisy_images"], wanted ? 1u : 0u) << "none of the exact sensor";
  }
}

TEST_F(SensorsOfARequest, SensorsThatCanNotMeasureAreRefusedBeforeAnythingIsPoured) {
  const Vec3 in_the_box(0.0, 0.0, 0.1);
  const struct {
    const char* words;  ///< of the message
    std::function<void(Request&)> spoil;
  } cases[] = {
      {"the camera stands inside part 0",
       [&](Request& r) {
         r.sensors[0].pose = Pose{in_the_box, Quat(0, 1, 0, 0)};
       }},
      {"the projector stands inside part 0",
       [&](Request& r) {
         r.sensors[0].projector.pose = Pose{in_the_box, Quat(0, 1, 0, 0)};
       }},
      {"below the floor",
       [](Request& r) {
         r.sensors[0].pose = Pose{Vec3(0, 0, -1), Quat::Identity()};
       }},
      {"the projector looks away",
       [](Request& r) {
         r.sensors[0].projector.pose = Pose{Vec3(0, 0, 1), Quat::Identity()};
       }},
      {"is 0, so that nothing can be measured by triangulation",
       [](Request& r) { r.sensors[0].projector.baseline = 0.0; }},
      {"read_noise", [](Request& r) { r.sensors[0].imager.read_noise = -1.0; }},
      {"the request needs about", [](Request& r) { r.sensors[0].width = r.sensors[0].height = 16384; }},
      {"the request needs about",
       [](Request& r) {
         r.sensors[0].model = "laser_line";
         r.sensors[0].scan.profiles = 65536;
       }},
      {"too few for a projector",
       [](Request& r) { r.sensors[0].settings.of<StructuredLightSettings>().gray_bits = 3; }},
  };
  for (const auto& [words, spoil] : cases) {
    Request request = boxes(1);
    request.parts[0].poses = {Pose{in_the_box, Quat::Identity()}};
    request.parts[0].fixed = true;
    request.sensors.resize(1);
    request.sensors[0].model = "structured_light";
    spoil(request);
    bool poured = false;
    Generator::Options options;
    options.hooks.progress = [&](const Progress& progress) { poured |= progress.simulated_s > 0.0; };
    try {
      run(request, options);
      ADD_FAILURE() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << words << ": " << error.what();
      EXPECT_FALSE(poured) << words;
    }
  }
}

}  // namespace
}  // namespace bin_scenes
