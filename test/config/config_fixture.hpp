/// A directory of its own with a few files, gone at the end; and "this request fails with these words".
#pragma once

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace bin_scenes {

class ConfigTest : public ::testing::Test {
 protected:
  ConfigTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    dir = std::filesystem::temp_directory_path() /
          ("bin_scenes_config_" + std::to_string(::getpid()) + "_" + info->test_suite_name() + "_" + info->name());
    std::filesystem::create_directories(dir);
    put("bolt.stl", "solid bolt");
    put("nut.stl", "solid nut");
    put("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x90\x90\x90\x80\x90\x90\x90\x80");
  }
  ~ConfigTest() override { std::filesystem::remove_all(dir); }

  std::string put(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((dir / name).parent_path());
    std::ofstream(dir / name) << text;
    return (dir / name).string();
  }

  Request read(const std::string& yaml, const std::vector<Override>& overrides = {}, const PathRules& rules = {}) {
    return read_request(put("request.yaml", yaml), overrides, rules);
  }

  /// Message of the input Error that reading ends in; fails the test if it does not.
  std::string refusal(const std::string& yaml, const std::vector<Override>& overrides = {},
                      const PathRules& rules = {}) {
    try {
      read(yaml, overrides, rules);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      EXPECT_FALSE(error.remedy().empty()) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "was accepted:\n" << yaml;
    return "";
  }

  void expect_refused(const std::string& yaml, const std::vector<std::string>& words,
                      const std::vector<Override>& overrides = {}) {
    const std::string message = refusal(yaml, overrides);
    for (const std::string& word : words) {
      EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' is not in: " << message;
    }
  }

  std::filesystem::path dir;
  const std::string bolts = "parts:\n  - model: bolt.stl\n";
};

}  // namespace bin_scenes
