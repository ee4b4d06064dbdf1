/// The tool in a directory of its own, with a request for three boxes.
#pragma once

#include "box_mesh.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace bin_scenes {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class CommandLine : public ::testing::Test {
 protected:
  CommandLine() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    dir = fs::temp_directory_path() / ("bin_scenes_tool_" + std::to_string(::getpid()) + info->name());
    fs::create_directories(dir);
    put("box.stl", box_stl(0.04));
    put("request.yaml",
        "seed: 3\nbin: {inner_size: [0.2, 0.2, 0.2]}\nsolver: {type: bullet}\nparts:\n"
        "  - {model: box.stl, count: 3}\n");
  }
  ~CommandLine() override { fs::remove_all(dir); }

  void put(const std::string& name, const std::string& content) { std::ofstream(dir / name) << content; }
  std::string text(const fs::path& name) const {
    std::ifstream file(dir / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  Json json(const fs::path& name) const { return Json::parse(text(name)); }

  struct Outcome {
    int code;
    std::string out, err;
  };
  /// `before`: shell words in front of the command.
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + dir.string() + "' && " + before + " '" BIN_SCENES_TOOL "' " + arguments +
                                " >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(("bash -c \"" + command + "\"").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text("stdout.txt"), text("stderr.txt")};
  }

  /// Whether the tool was built with ROS.
  bool with_ros() const { return run("doctor").out.find("ros       ok") != std::string::npos; }

  /// Fails with the code, one line on standard error that holds the words, and no output directory.
  void expect_failure(const std::string& arguments, int code, const std::vector<std::string>& words,
                      const std::string& before = "") {
    const Outcome outcome = run(arguments, before);
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.err.compare(0, 12, "bin_scenes: "), 0) << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    for (const std::string& word : words) {
      EXPECT_NE(outcome.err.find(word), std::string::npos) << "'" << word << "' is not in: " << outcome.err;
    }
    EXPECT_FALSE(fs::exists(dir / "out")) << arguments;
  }

  /// scene.json without what wall time decides.
  Json lasting(const fs::path& name) const {
    Json scene = json(name);
    for (const char* key : {"wall_s", "stages_ms", "counters"}) scene["report"].erase(key);
    return scene;
  }

  fs::path dir;
};

}  // namespace bin_scenes
