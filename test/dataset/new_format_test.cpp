/// A new kind of output as a worked example: heights of the parts as CSV. This file is all that it takes in a program
/// of its own; in this tree it would be five: src/output/heights.cpp, its name in src/output/CMakeLists.txt and in
/// scene_formats(), its entry in output_format.cpp, and its row in docs/use/outputs.md.
#include "bin_scenes/config/plan.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/output_format.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "config/config_fixture.hpp"
#include "dataset/scene_store.hpp"
#include "dataset/whole_folders.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;

void write_heights(const std::string& folder, const SceneOutput& output) {
  std::string text = "id,height\n";
  for (const ScenePart& part : output.scene.parts)
    text += std::to_string(part.id) + "," + std::to_string(part.pose.position.z()) + "\n";
  write_text(folder + "/heights.csv", text);
}

class NewFormat : public ConfigTest {
 protected:
  static void SetUpTestSuite() {
    register_output_format({{"heights", SceneFormat::Needs::scene}, write_heights, [](const Request&) {
                              return std::vector<std::string>{"heights.csv"};
                            }});
  }

  /// Folder of the scene, made as `generate` does.
  std::string made(const std::set<std::string>& formats) {
    Generator::Result result;
    result.scene.parts.resize(2);
    for (int id : {0, 1}) {
      ScenePart& part = result.scene.parts[static_cast<std::size_t>(id)];
      part.id = id;
      part.pose = {Vec3(0.0, 0.0, 0.25 * id), Quat::Identity()};
    }
    const std::string folder = (fs::path(out()) / "scene_000000").string();
    WholeFolders folders;
    folders.write(folder, [&](const std::string& hidden) { write_scene_files(hidden, formats, result, loaded()); });
    folders.commit();
    return folder;
  }
  std::string out() const { return (dir / "out").string(); }
  static LoadedRequest loaded() {
    LoadedRequest loaded;
    loaded.request.parts.resize(1);
    loaded.request.parts[0].model = "part.stl";
    loaded.parts.resize(1);
    return loaded;
  }
};

TEST_F(NewFormat, IsWritten) {
  std::ifstream file(made({"heights"}) + "/heights.csv");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "id,height\n0,0.000000\n1,0.250000\n");
}

TEST_F(NewFormat, BelongsToAWholeScene) {
  const SceneStore store(out(), {"json", "heights"});
  made({"json"});
  EXPECT_EQ(store.find(0, Request()), SceneStore::Found::nothing) << "its file is missing";
  fs::remove_all(out());
  made({"heights"});
  EXPECT_EQ(store.find(0, Request()), SceneStore::Found::accepted);
}

TEST_F(NewFormat, IsKnownToCommandsAndPlans) {
  EXPECT_NO_THROW(check_formats({"heights"}, "--formats"));
  const Plan plan = read_plan(put("plan.yaml",
                                  "seed: 1\nscenes: 1\noutputs: [json, heights]\nrequest:\n"
                                  "  parts: [{model: bolt.stl, count: 1}]\n"));
  EXPECT_TRUE(plan.wants("heights"));
  try {
    check_formats({"hights"}, "--formats");
    FAIL() << "an unknown format";
  } catch (const Error& error) {
    EXPECT_NE(error.remedy().find("heights"), std::string::npos) << error.remedy();
  }
}

TEST_F(NewFormat, HasANameOfItsOwn) {
  EXPECT_THROW(register_output_format({{"png", SceneFormat::Needs::scene}}), Error);
}

TEST(OutputFormats, AllButThoseWithFoldersOfTheirOwnHaveAWriter) {
  for (const OutputFormat& format : output_formats())
    EXPECT_EQ(bool(format.write), format.name != "json" && format.name != "bop") << format.name;
}

}  // namespace
}  // namespace bin_scenes
