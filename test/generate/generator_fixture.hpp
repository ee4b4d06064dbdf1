/// A generator and requests for boxes.
#pragma once

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"
#include "box_mesh.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

class GeneratorTest : public ::testing::Test {
 protected:
  GeneratorTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    dir = std::filesystem::temp_directory_path() / ("bin_scenes_generate_" + std::to_string(::getpid()) + info->name());
    std::filesystem::create_directories(dir);
    std::ofstream(dir / "box.stl") << box_stl(0.04);
  }
  ~GeneratorTest() override { std::filesystem::remove_all(dir); }

  Request boxes(std::size_t count) const {
    Request r;
    r.seed = 3;
    r.solver.type = SolverType::bullet;
    r.bin.inner_size = Vec3(0.2, 0.2, 0.2);
    r.parts.emplace_back();
    r.parts[0].model = "box.stl";
    r.parts[0].path = (dir / "box.stl").string();
    r.parts[0].count = count;
    return r;
  }

  std::vector<Generator::Result> run(const Request& request, Generator::Options options = {}) {
    std::vector<Generator::Result> results;
    generator.generate(request, options, [&](Generator::Result&& result) { results.push_back(std::move(result)); });
    return results;
  }

  ErrorKind failure(const Request& request) {
    try {
      run(request);
    } catch (const Error& error) {
      return error.kind();
    }
    ADD_FAILURE() << "did not fail";
    return ErrorKind::cancelled;
  }

  std::filesystem::path dir;
  Generator generator;
};

}  // namespace bin_scenes
