/// Files that a request names: models, and the scene it goes on from.
#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "config/config_fixture.hpp"

#include <cstdlib>

namespace bin_scenes {
namespace {

TEST_F(ConfigTest, ModelsAreFoundByRelativeAbsoluteAndPackagePaths) {
  put("space/deep/my_parts/package.xml", "<package><name>my_parts</name></package>");
  put("space/deep/my_parts/meshes/ring.stl", "solid ring");
  ::setenv("ROS_PACKAGE_PATH", ("/nonexistent:" + (dir / "space").string()).c_str(), 1);
  EXPECT_EQ(read("parts: [{model: package://my_parts/meshes/ring.stl}]").parts[0].path,
            (dir / "space/deep/my_parts/meshes/ring.stl").string());
  EXPECT_EQ(read("parts: [{model: " + (dir / "nut.stl").string() + "}]").parts[0].path, (dir / "nut.stl").string());
  PathRules rules;
  rules.find_package = [&](const std::string& name) { return name == "mine" ? dir.string() : std::string(); };
  EXPECT_EQ(read("parts: [{model: package://mine/nut.stl}]", {}, rules).parts[0].path, (dir / "nut.stl").string());
  expect_refused("parts: [{model: package://absent/ring.stl}]", {"no package 'absent'", "ROS_PACKAGE_PATH"});
  expect_refused("parts: [{model: package://my_parts}]", {"does not name a file"});
  ::unsetenv("ROS_PACKAGE_PATH");
}

TEST_F(ConfigTest, MissingModelsAreNamedWithALikelyFile) {
  expect_refused("parts:\n  - model: blot.stl\n", {"request.yaml:2", "blot.stl", "did you mean 'bolt.stl'"});
  expect_refused("parts: [{model: .}]", {"not a file"});
  expect_refused("bin: {mesh: crate.stl}\n" + bolts, {"request.yaml:1", "crate.stl"});
}

TEST_F(ConfigTest, ModelsOutsideTheRootsAreRefusedThroughLinksToo) {
  put("inside/part.stl", "solid");
  put("inside-not/part.stl", "solid");
  std::filesystem::create_symlink(dir / "nut.stl", dir / "inside/link.stl");
  PathRules rules;
  rules.roots = {(dir / "inside").string() + "/"};
  rules.roots_name = "~model_roots";
  EXPECT_NO_THROW(read("parts: [{model: inside/part.stl}]", {}, rules));
  for (const char* model : {"nut.stl", "inside/../nut.stl", "inside/link.stl", "inside-not/part.stl", "absent.stl"}) {
    const std::string message = refusal("parts: [{model: " + std::string(model) + "}]", {}, rules);
    EXPECT_NE(message.find("outside of ~model_roots"), std::string::npos) << message;
  }
}

TEST_F(ConfigTest, RelativeModelsAreSearchedInEachRootAfterTheRequestsFolder) {
  put("first/other.stl", "solid");
  put("second/part.stl", "solid");
  put("second/bolt.stl", "solid");
  PathRules rules;
  rules.roots = {(dir / "first").string(), (dir / "second").string(), dir.string()};
  EXPECT_EQ(read("parts: [{model: part.stl}]", {}, rules).parts[0].path, (dir / "second/part.stl").string());
  EXPECT_EQ(read("parts: [{model: bolt.stl}]", {}, rules).parts[0].path, (dir / "bolt.stl").string());
  rules.roots_name = "~model_roots";
  EXPECT_NE(refusal("parts: [{model: absent.stl}]", {}, rules).find("~model_roots"), std::string::npos);
}

TEST_F(ConfigTest, GoesOnFromAnEarlierScene) {
  const auto part = [](int id, const char* model, int line, const char* state, double z) {
    return std::string(R"({"id": )") + std::to_string(id) + R"(, "line": )" + std::to_string(line) + R"(, "model": ")" +
           model + R"(", "pose": {"position": [0, 0, )" + std::to_string(z) +
           R"(], "orientation_xyzw": [0, 0, 0, 1]}, "state": ")" + state + R"("})";
  };
  put("scene.json", R"({"format": "bin_scenes/1", "seed": 1, "index": 0, "parts": [)" +
                        part(0, "bolt.stl", 0, "resting", 0.01) + "," + part(1, "bolt.stl", 0, "escaped", -1) + "," +
                        part(2, "nut.stl", 1, "moving", 0.03) + "]}");
  const std::string given = "pour: {pattern: given, scene: scene.json}\n";
  const Request r = read(given + "parts: [{model: bolt.stl}, {model: nut.stl}]");
  ASSERT_EQ(r.parts[0].poses.size(), 1u);
  EXPECT_EQ(r.parts[0].count, 1u);
  EXPECT_EQ(r.parts[0].poses[0].position.z(), 0.01);
  EXPECT_EQ(r.parts[1].poses[0].position.z(), 0.03);
  EXPECT_EQ(read(write_request(r)).text_sha256, r.text_sha256) << "written back, it stands on its own";
  expect_refused(given + "parts: [{model: bolt.stl, count: 2}, {model: nut.stl}]", {"is 2", "has 1"});
  expect_refused(given + "parts: [{model: nut.stl}, {model: bolt.stl}]", {"'bolt.stl' of part line 0"});
  expect_refused("pour: {scene: scene.json}\n" + bolts, {"pattern: given"});
  put("scene.json", "{}");
  expect_refused(given + bolts, {"scene.json", "format"});
}

TEST_F(ConfigTest, APartOfAnEarlierSceneIsKnownByItsBytesWhereverItLies) {
  Scene scene;
  scene.model_sha256 = {sha256_hex("solid bolt")};
  scene.parts.emplace_back();
  scene.parts[0].model = "bolt.stl";
  scene.parts[0].state = PartState::resting;
  Request made;
  made.parts.emplace_back();
  made.parts[0].model = "bolt.stl";
  put("scene.json", scene_json(scene, {made}));
  const std::string given = "pour: {pattern: given, scene: " + (dir / "scene.json").string() + "}\n";
  put("deeper/twin.stl", "solid bolt");
  EXPECT_EQ(read(given + "parts: [{model: deeper/twin.stl}]").parts[0].poses.size(), 1u);
  std::ofstream(dir / "deeper/request.yaml") << given << "parts: [{model: ../bolt.stl}]";
  EXPECT_EQ(read_request((dir / "deeper/request.yaml").string()).parts[0].poses.size(), 1u);
  put("bolt.stl", "solid other");
  expect_refused(given + "parts: [{model: bolt.stl}]", {"'bolt.stl' of part line 0"});

  // A scene of somebody else tells no bytes: its names have to do.
  scene.model_sha256.clear();
  put("scene.json", scene_json(scene, {made}));
  EXPECT_EQ(read_request((dir / "deeper/request.yaml").string()).parts[0].poses.size(), 1u);
}

TEST_F(ConfigTest, PartsThatWereNeverPouredHaveNothingToGoOnFrom) {
  Scene scene;
  for (int id = 0; id < 2; ++id) {
    scene.parts.emplace_back();
    scene.parts[id].id = id;
    scene.parts[id].model = "bolt.stl";
    scene.parts[id].state = id == 0 ? PartState::not_poured : PartState::resting;
  }
  scene.parts[0].pose = Pose::none();
  scene.parts[1].pose.position.z() = 0.5;
  put("scene.json", scene_json(scene, {}));
  const Request r = read("pour: {pattern: given, scene: scene.json}\nparts: [{model: bolt.stl}]");
  ASSERT_EQ(r.parts[0].poses.size(), 1u);
  EXPECT_EQ(r.parts[0].poses[0].position.z(), 0.5);
}

/// A hash is that of what a request's files hold, not that of where they lie.
TEST_F(ConfigTest, ThePicturesOfLampsCount) {
  const auto hash = [&](const std::string& picture, char shade) {
    put(picture, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + std::string(4, shade) + "\x10\x20\x30\x80");
    return request_hash(read("sensors: [{model: image, lamps: [{type: dome, picture: " + picture + "}]}]\n" + bolts));
  };
  const std::string before = hash("sky.hdr", 'a');
  EXPECT_NE(before, hash("sky.hdr", 'b'));
  EXPECT_EQ(before, hash("sky.hdr", 'a'));
  EXPECT_EQ(before, hash("elsewhere/sky.hdr", 'a'));
}

TEST_F(ConfigTest, ModelsAreNotTakenForDirectories) {
  std::filesystem::create_directories(dir / "out");
  std::filesystem::create_directories(dir / "bolt.st");
  const std::string number = refusal("parts: [{model: 5}]\n");
  EXPECT_EQ(number.find("did you mean"), std::string::npos) << number;
  expect_refused("parts: [{model: bolt.sl}]\n", {"did you mean 'bolt.stl'"});
}

}  // namespace
}  // namespace bin_scenes
