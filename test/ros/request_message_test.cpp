#include "request_message.hpp"

#include "bin_scenes/core/error.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace bin_scenes {
namespace {

namespace msgs = bin_scenes_msgs;

const std::string models = std::getenv("BIN_SCENES_MODELS");
const PathRules all_rules = {{models}, "the roots", {}};

msgs::SceneRequest one_bolt() {
  msgs::SceneRequest message;
  message.parts.resize(1);
  message.parts[0].model = "bolt_hex.stl";
  message.parts[0].unit = "mm";
  return message;
}

std::string error_of(const msgs::SceneRequest& message, const PathRules& rules = all_rules) {
  try {
    request_from(message, rules);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "";
}

TEST(RequestMessage, AnEmptyOneOverridesNothing) {
  EXPECT_TRUE(overrides_from({}).empty());
}

TEST(RequestMessage, LeftOutFieldsHaveTheDefaultsOfAFile) {
  const Request typed = request_from(one_bolt(), all_rules);
  const Request file = read_request_text("parts: [{model: bolt_hex.stl, unit: mm}]", models, {}, all_rules);
  EXPECT_EQ(write_request(typed), write_request(file));
  EXPECT_EQ(typed.text_sha256, file.text_sha256);
}

TEST(RequestMessage, SaysTheSameAsAFile) {
  msgs::SceneRequest m = one_bolt();
  m.seed = {7};
  m.index = {3};
  m.bin.inner_size.x = 0.5;
  m.bin.inner_size.y = 0.4;
  m.bin.inner_size.z = 0.1;
  m.bin.wall_thickness = {0.002};
  m.bin.friction = {0.0};
  m.bin.restitution = {0.25};
  m.gravity.resize(1);  // weightless, on purpose
  m.parts[0].scale = 1.5;
  m.parts[0].density = 7850.0;
  m.parts[0].friction = {0.0};
  m.parts[0].restitution = {0.0};
  m.parts[0].poses.resize(2);
  m.parts[0].poses[1].position.z = 0.1;
  m.parts[0].poses[1].orientation.x = 1.0;
  m.parts[0].velocities.resize(2);
  m.parts[0].velocities[0].angular.y = -1.0 / 3.0;
  m.pour_pattern = "given";
  m.solver = "bullet";
  m.sensors.resize(1);
  m.sensors[0].name = "top";
  m.sensors[0].width = 320;
  m.sensors[0].height = 200;
  m.sensors[0].fov = 0.5;
  m.sensors[0].pose.position.z = 1.0;
  m.sensors[0].pose.orientation.x = 1.0;
  m.sensors[0].near = 0.2;
  m.sensors[0].far = 3.0;
  m.seconds = 1.5;
  m.set = {"accept.escaped=true"};
  const Request file = read_request_text(R"(
seed: 7
first: 3
bin: {inner_size: [0.5, 0.4, 0.1], wall_thickness: 0.002, friction: 0, restitution: 0.25}
gravity: [0, 0, 0]
parts:
  - {model: bolt_hex.stl, unit: mm, count: 2, scale: 1.5, density: 7850, friction: 0, restitution: 0,
     poses: [[0, 0, 0, 0, 0, 0, 1], [0, 0, 0.1, 1, 0, 0, 0]],
     velocities: [[0, 0, 0, 0, -0.33333333333333331, 0], [0, 0, 0, 0, 0, 0]]}
pour: {pattern: given}
solver: {type: bullet}
sensors: [{name: top, width: 320, height: 200, fov: 0.5, pose: [0, 0, 1, 1, 0, 0, 0], near: 0.2, far: 3}]
seconds: 1.5
accept: {escaped: true}
)",
                                         models, {}, all_rules);
  EXPECT_EQ(write_request(request_from(m, all_rules)), write_request(file));
}

TEST(RequestMessage, SurfaceAndMotionAreThoseOfAFile) {
  msgs::SceneRequest m = one_bolt();
  msgs::PartLine& part = m.parts[0];
  part.fixed = true;
  part.poses.resize(1);
  part.poses[0].position.z = 0.1;
  part.surface.material = "brass";
  part.surface.albedo = {0.2};
  part.surface.gloss = {0.0};
  part.surface.roughness = {0.7};
  part.surface.anisotropy = {0.6};
  part.surface.along.y = 1.0;
  part.surface.texture_scratches = {0.1};
  part.surface.texture_oil = {0.0};
  part.surface.texture_rust = {0.3};
  part.motion.times = {0.5, 1.0};
  part.motion.poses.resize(2);
  part.motion.poses[1].position.x = 0.05;
  part.motion.shake.x = 0.01;
  part.motion.tilt.z = 0.02;
  part.motion.frequency = {3.0};
  part.motion.seconds = {2.0};
  const Request file = read_request_text(R"(
parts:
  - model: bolt_hex.stl
    unit: mm
    fixed: true
    poses: [[0, 0, 0.1, 0, 0, 0, 1]]
    surface: {material: brass, albedo: 0.2, gloss: 0, roughness: 0.7, anisotropy: 0.6, along: [0, 1, 0],
      texture: {scratches: 0.1, oil: 0, rust: 0.3}}
    motion: {times: [0.5, 1], poses: [[0, 0, 0, 0, 0, 0, 1], [0.05, 0, 0, 0, 0, 0, 1]], shake: [0.01, 0, 0],
      tilt: [0, 0, 0.02], frequency: 3, seconds: 2}
)",
                                         models, {}, all_rules);
  EXPECT_EQ(write_request(request_from(m, all_rules)), write_request(file));
  part.motion = {};
  part.motion.belt.y = 0.3;
  EXPECT_EQ(request_from(m, all_rules).parts[0].motion.belt, Vec3(0, 0.3, 0));
  part.surface.albedo = {0.2, 0.3};
  EXPECT_NE(error_of(m).find("parts[0].surface.albedo"), std::string::npos) << error_of(m);
}

TEST(RequestMessage, CadFilesAreChosenFromAndRefinedAsInAFile) {
  msgs::SceneRequest m = one_bolt();
  m.parts[0].solid = "pin#2";
  m.parts[0].tessellation_chord = 1e-4;
  m.parts[0].tessellation_angle = 0.1;
  const Request request = request_from(m, all_rules);
  EXPECT_EQ(request.parts[0].solid, "pin#2");
  EXPECT_EQ(request.parts[0].tessellation.chord, 1e-4);
  EXPECT_EQ(request.parts[0].tessellation.angle, 0.1);
  m.parts[0].tessellation_angle = 2.0;
  EXPECT_NE(error_of(m).find("parts[0].tessellation.angle"), std::string::npos) << error_of(m);
}

TEST(RequestMessage, BinsOfEveryKind) {
  msgs::SceneRequest m = one_bolt();
  m.bin.kind = "floor";
  EXPECT_EQ(request_from(m, all_rules).bin.kind, Bin::Kind::floor);
  m.bin.kind = "none";
  EXPECT_EQ(request_from(m, all_rules).bin.kind, Bin::Kind::none);
  m.bin.kind = "box";
  EXPECT_EQ(request_from(m, all_rules).bin.kind, Bin::Kind::box);
  m.bin.kind = "mesh";
  EXPECT_NE(error_of(m).find("bin.mesh"), std::string::npos);
  m.bin.kind = "bucket";
  EXPECT_NE(error_of(m).find("bucket"), std::string::npos);
}

TEST(RequestMessage, FieldsComeOnTopOfTextAndSetOnTopOfFields) {
  msgs::SceneRequest m;
  m.yaml = "{seed: 1, first: 1, parts: [{model: bolt_hex.stl, unit: mm, count: 4}], seconds: 1}";
  m.seed = {2};
  m.index = {2};
  m.set = {"first=3", "parts[0].count=5"};
  const Request request = request_from(m, all_rules);
  EXPECT_EQ(request.seed, 2u);
  EXPECT_EQ(request.first, 3u);
  EXPECT_EQ(request.parts.at(0).count, 5u);
  EXPECT_EQ(request.seconds, 1.0);
}

TEST(RequestMessage, SeedZeroIsASeed) {
  msgs::SceneRequest m;
  m.yaml = "{seed: 1, parts: [{model: bolt_hex.stl, unit: mm}]}";
  m.seed = {0};
  EXPECT_EQ(request_from(m, all_rules).seed, 0u);
}

TEST(RequestMessage, ALongListStaysOneValue) {
  msgs::SceneRequest m = one_bolt();
  m.parts[0].poses.resize(200);
  for (int i = 0; i < 200; ++i) m.parts[0].poses[i].position.x = 1.0 / (i + 3);
  m.pour_pattern = "given";
  m.bin.kind = "floor";
  const Request request = request_from(m, all_rules);
  ASSERT_EQ(request.parts.at(0).poses.size(), 200u);
  for (int i = 0; i < 200; ++i) EXPECT_EQ(request.parts[0].poses[i].position.x(), 1.0 / (i + 3));
}

TEST(RequestMessage, BadInputIsOneClearError) {
  msgs::SceneRequest m = one_bolt();
  m.parts[0].friction = {0.1, 0.2};
  EXPECT_NE(error_of(m).find("parts[0].friction"), std::string::npos);
  m = one_bolt();
  m.parts[0].count = -1;
  EXPECT_NE(error_of(m).find("count"), std::string::npos);
  m = one_bolt();
  m.parts[0].unit = "parsec";
  EXPECT_NE(error_of(m).find("unit"), std::string::npos);
  EXPECT_NE(error_of(m).find("the request message"), std::string::npos) << error_of(m);
  EXPECT_EQ(error_of(m).find("--set"), std::string::npos) << "nobody typed that: " << error_of(m);
  m = one_bolt();
  m.set = {"solver.tipe=bullet"};
  EXPECT_NE(error_of(m).find("type"), std::string::npos);  // the nearest known key
  m = one_bolt();
  m.yaml = m.file = "x";
  EXPECT_NE(error_of(m).find("both"), std::string::npos);
}

TEST(RequestMessage, OutsideOfTheRootsNothingIsRead) {
  namespace fs = std::filesystem;
  const fs::path outside = fs::temp_directory_path() / ("bin_scenes_outside_" + std::to_string(getpid()));
  fs::create_directories(outside);
  const std::string file = (outside / "request.yaml").string();
  std::ofstream(file) << "parts: [{model: bolt_hex.stl}]\n";
  msgs::SceneRequest m;
  m.file = file;
  EXPECT_NE(error_of(m).find("roots"), std::string::npos);
  m.file = models + "/../" + fs::relative(file, fs::path(models).parent_path()).string();  // by the back door
  EXPECT_NE(error_of(m).find("roots"), std::string::npos);
  m = one_bolt();
  fs::copy_file(fs::path(models) / "bolt_hex.stl", outside / "bolt.stl");
  m.parts[0].model = (outside / "bolt.stl").string();
  EXPECT_NE(error_of(m), "");
  fs::remove_all(outside);
}

TEST(RequestMessage, TableAndDistractorsAreThoseOfAFile) {
  msgs::SceneRequest m = one_bolt();
  m.table.height = {-0.005};
  m.table.surface.albedo = {0.0};
  m.table.mottle = 0.25;
  m.parts.push_back(m.parts[0]);
  m.parts[1].distractor = true;
  m.parts[1].on_table = 0.1;
  const Request file = read_request_text(
      "table: {height: -0.005, surface: {albedo: 0.0}, mottle: 0.25}\n"
      "parts: [{model: bolt_hex.stl, unit: mm}, {model: bolt_hex.stl, unit: mm, distractor: true, on_table: 0.1}]",
      models, {}, all_rules);
  EXPECT_EQ(write_request(request_from(m, all_rules)), write_request(file));
  EXPECT_EQ(file.table.surface.albedo, 0.0);
  EXPECT_TRUE(file.parts[1].stays());
}

}  // namespace
}  // namespace bin_scenes
