#include "output/output_fixture.hpp"

#include <nlohmann/json.hpp>

namespace bin_scenes {
namespace {

using SceneJson = OutputTest;

Request request() {
  Request r;
  r.text_sha256 = "abc";
  return r;
}

TEST_F(SceneJson, ReadsBackBitForBit) {
  const Scene scene = small_scene();
  write_text(path("scene.json"), scene_json(scene, {request()}));
  const Scene back = read_scene_json(path("scene.json"));
  EXPECT_EQ(back.seed, scene.seed);
  EXPECT_EQ(back.index, scene.index);
  ASSERT_EQ(back.parts.size(), scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart &a = scene.parts[i], &b = back.parts[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.line, b.line);
    EXPECT_EQ(a.model, b.model);
    EXPECT_EQ(a.pose.position, b.pose.position);
    EXPECT_EQ(a.pose.orientation.coeffs(), b.pose.orientation.coeffs());
    EXPECT_EQ(a.velocity.linear, b.velocity.linear);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.visible_fraction, b.visible_fraction);
  }
  EXPECT_EQ(back.report.reasons, scene.report.reasons);
  EXPECT_EQ(back.report.escaped, scene.report.escaped);
  EXPECT_EQ(back.report.state_hash, scene.report.state_hash);
  EXPECT_TRUE(back.report.at_rest);
  EXPECT_FALSE(back.report.accepted);
}

TEST_F(SceneJson, HasTheNamesOthersRelyOn) {
  const auto json = nlohmann::json::parse(scene_json(small_scene(), {request()}));
  EXPECT_EQ(json.at("format"), "bin_scenes/1");
  EXPECT_EQ(json.at("request_sha256"), "abc");
  EXPECT_EQ(json.at("bin").at("inner_size").size(), 3u);
  EXPECT_FALSE(json.contains("table")) << "there is none";
  const auto& sensor = json.at("sensors").at(0);
  EXPECT_EQ(sensor.at("frame"), "left_optical_frame");
  EXPECT_EQ(sensor.at("K").size(), 9u);
  EXPECT_EQ(sensor.at("pose").at("position").at(2), 0.9);
  const auto& part = json.at("parts").at(1);
  EXPECT_EQ(part.at("id"), 1);
  EXPECT_EQ(part.at("state"), "escaped");
  EXPECT_EQ(part.at("pose").at("orientation_xyzw").size(), 4u);
  EXPECT_TRUE(part.at("visible_fraction").is_object());
  const auto& report = json.at("report");
  for (const char* key : {"at_rest", "accepted", "reasons", "solver", "device", "finish", "simulated_s", "wall_s",
                          "steps", "stages_ms", "gap", "escaped", "flags"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  EXPECT_EQ(report.at("penetration").at("pair"), nlohmann::json({0, 2}));
  for (const char* key : {"median", "p95", "max", "bin_median", "bin_p95", "bin_max"}) {
    EXPECT_TRUE(report.at("penetration").at(key).is_number()) << key;
  }
}

TEST_F(SceneJson, TellsWhatItsModelsWereByTheirBytes) {
  Scene scene = small_scene();
  scene.model_sha256 = {"b0", "a1"};
  Request r = request();
  r.parts.resize(2);
  r.parts[0].model = "bolt.stl";
  r.parts[1].model = "../nut.stl";
  write_text(path("scene.json"), scene_json(scene, {r}));
  EXPECT_EQ(nlohmann::json::parse(text("scene.json")).at("models").at(1),
            nlohmann::json({{"model", "../nut.stl"}, {"sha256", "a1"}}));
  EXPECT_EQ(read_scene_json(path("scene.json")).model_sha256, scene.model_sha256);
}

TEST_F(SceneJson, TellsHowItsModelsWereRead) {
  Scene scene = small_scene();
  scene.model_sha256 = {"b0"};
  Request r = request();
  r.bin.kind = Bin::Kind::mesh;
  r.bin.mesh = "crate.stl";
  r.bin.mesh_sha256 = "c2";
  r.bin.unit = Unit::inch;
  r.parts.resize(1);
  r.parts[0].model = "bolt.step";
  r.parts[0].unit = Unit::millimetre;
  r.parts[0].scale = 2.0;
  r.parts[0].thickness = 0.001;
  r.parts[0].solid = "bolt";
  r.parts[0].tessellation = {1e-4, 0.1};
  const auto json = nlohmann::json::parse(scene_json(scene, {r}));
  EXPECT_EQ(json.at("models").at(0), nlohmann::json({{"model", "bolt.step"},
                                                     {"sha256", "b0"},
                                                     {"unit", "mm"},
                                                     {"scale", 2.0},
                                                     {"thickness", 0.001},
                                                     {"solid", "bolt"},
                                                     {"chord", 1e-4},
                                                     {"angle", 0.1}}));
  EXPECT_EQ(json.at("bin").at("sha256"), "c2");
  EXPECT_EQ(json.at("bin").at("unit"), "inch");
}

/// The file as a struct has everything that the file has: written again, it is the same text.
TEST_F(SceneJson, TheStructHoldsTheWholeFile) {
  Scene scene = small_scene();
  scene.model_sha256 = {"b0"};
  scene.sensors.push_back(scene.sensors[0]);
  scene.sensors[1].name = "right-2";
  scene.sensors[1].view_of = "left";
  scene.sensors[1].model = "laser_line";
  scene.sensors[1].laser.pose = Pose{Vec3(0.1, 0.0, 0.9), Quat::Identity()};
  scene.report.drift.measured = true;
  scene.report.drift.turn_p95 = 0.25;
  scene.report.profile.counters["contacts"] = 1234567890123u;
  Request r = request();
  r.bin.kind = Bin::Kind::mesh;
  r.bin.mesh = "crate.stl";
  r.parts.resize(1);
  r.parts[0].model = "bolt.stl";
  r.parts[0].scale = 2.0;
  r.table.height = -0.02;
  r.table.surface.albedo = 0.3;
  r.table.surface.texture.oil = 0.1;
  r.table.mottle = 0.25;
  LoadedRequest loaded{r};
  const std::string written = scene_json(scene, loaded);
  write_text(path("scene.json"), written);
  const SceneFile back = read_scene_file(path("scene.json"), Strictness::strict);
  EXPECT_EQ(scene_text(back), written);
  EXPECT_EQ(back.bin.kind, Bin::Kind::mesh);
  EXPECT_EQ(back.sensors.at(1).laser.pose->position, Vec3(0.1, 0.0, 0.9));
  EXPECT_FALSE(back.sensors[0].truth.has_value());
  EXPECT_EQ(back.table.height, -0.02);
  EXPECT_EQ(back.table.surface.albedo, 0.3);
  EXPECT_EQ(back.table.surface.texture.oil, 0.1);
  EXPECT_EQ(back.table.mottle, 0.25);
  EXPECT_TRUE(back.report.drift.measured);
  EXPECT_EQ(back.report.flags.at(0).code, "mesh_repaired");
}

/// Files of other programs and of earlier versions may lack keys; what this version writes may not.
TEST_F(SceneJson, OnlyAStrictReaderNeedsEveryKey) {
  const auto written = nlohmann::json::parse(scene_json(small_scene(), {request()}));
  for (const char* key : {"bin", "gravity", "request_sha256", "sensors", "report"}) {
    nlohmann::json cut = written;
    cut.erase(key);
    write_text(path("scene.json"), cut.dump());
    EXPECT_EQ(read_scene_json(path("scene.json")).parts.size(), 3u) << key;
    try {
      read_scene_file(path("scene.json"), Strictness::strict);
      ADD_FAILURE() << key;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("'" + std::string(key) + "': is missing"), std::string::npos)
          << error.what();
    }
  }
  nlohmann::json older = written;  // reports grow with each version
  older["report"].erase("jam");
  write_text(path("scene.json"), older.dump());
  EXPECT_EQ(read_scene_file(path("scene.json"), Strictness::strict).parts.size(), 3u);
}

TEST_F(SceneJson, APartWithoutAPoseStaysWithoutOne) {
  Scene scene = small_scene();
  scene.parts[1].pose = Pose::none();
  scene.parts[1].state = PartState::not_poured;
  write_text(path("scene.json"), scene_json(scene, {request()}));
  const auto json = nlohmann::json::parse(text("scene.json"));
  EXPECT_TRUE(json.at("parts").at(1).at("pose").is_null());
  EXPECT_EQ(json.at("parts").at(1).at("id"), 1);
  const Scene back = read_scene_json(path("scene.json"));
  EXPECT_TRUE(std::isnan(back.parts[1].pose.position.x()));
  EXPECT_EQ(back.parts[1].state, PartState::not_poured);
}

TEST_F(SceneJson, BrokenFilesAreNamedWithTheKey) {
  const auto expect = [&](const std::string& content, const std::string& word) {
    write_text(path("scene.json"), content);
    try {
      read_scene_json(path("scene.json"));
      ADD_FAILURE() << content;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_NE(std::string(error.what()).find("scene.json"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find("exception"), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  };
  expect("{", "is not valid JSON, or is incomplete");
  expect("{\n\"format\": \"bin_scenes/1\",\n???}", "error is at byte 29");
  expect(R"({"format": "bin_scenes/1", "seed": "one", "index": 0})", "'seed': is \"one\", but must be a whole");
  // Casts of what does not fit: found by the fuzzer.
  expect(R"({"format": "bin_scenes/1", "seed": 744444444444444444444444444444, "index": 0})", "whole number");
  expect(R"({"format": "bin_scenes/1", "seed": 1, "index": -1})", "is -1, but must be");
  expect(R"({"format": "bin_scenes/1", "seed": 1, "index": 0, "parts": [{"id": 3000000000}]})", "parts[0]");
  expect("[]", "format");
  expect(R"({"format": "bin_scenes/9"})", "bin_scenes/1");
  const std::string head = R"({"format": "bin_scenes/1", "seed": 1, "index": 0, "parts": [{"id": 0, "model": "a")";
  expect(head + "}]}", "parts[0]");
  expect(head + R"(, "pose": {"position": [0, 0], "orientation_xyzw": [0, 0, 0, 1]}, "state": "resting"}]})",
         "parts[0]");
  expect(head + R"(, "pose": {"position": [0, 0, 0], "orientation_xyzw": [0, 0, 0, 1]}, "state": "asleep"}]})",
         "asleep");
  EXPECT_THROW(read_scene_json(path("nowhere.json")), Error);
}

}  // namespace
}  // namespace bin_scenes
