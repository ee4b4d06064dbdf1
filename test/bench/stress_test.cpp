#include "stress/trial.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace bin_scenes::stress {
namespace {

using Strings = std::vector<std::string>;

/// Takes cases of the suite and spoils them: what does not hold must be seen.
class Stress : public ::testing::Test {
 protected:
  Stress() : folder_(std::filesystem::temp_directory_path() / ("stress_" + std::to_string(::getpid()))) {
    ::setenv("BIN_SCENES_CACHE", "off", 1);
    std::filesystem::create_directories(folder_ / "models");
  }
  ~Stress() override { std::filesystem::remove_all(folder_); }

  static Case find(const std::vector<Row>& rows, const std::string& row, const std::string& name) {
    for (const Row& r : rows)
      for (const Case& c : r.cases)
        if (r.name == row && c.name.find(name) != std::string::npos) return c;
    throw std::runtime_error("no case " + name + " in row " + row);
  }
  Outcome run(const Case& c, const std::string& solver) const {
    for (const auto& [name, mesh] : c.models) write_obj(mesh, (folder_ / "models" / (name + ".obj")).string());
    return run_here(request_text(c, solver), folder_.string(), c.expect);
  }

  std::filesystem::path folder_;
};

TEST_F(Stress, SeesACubePassAPlate) {
  for (const std::string name : {"a cube at a fixed plate", "a cube at a plate in free flight"}) {
    Case c = find(speeds(false), "100 m/s", name);
    for (const std::string& solver : both) EXPECT_EQ(run(c, solver).failures, Strings()) << solver << ", " << name;
    c.request.solver.sphere.cut_steps = c.request.solver.bullet.cut_steps = false;
    for (const std::string& solver : both)
      EXPECT_EQ(run(c, solver).failures, Strings{"went through"}) << solver << ", " << name;
  }
}

TEST_F(Stress, SeesLayersThatHaveNotLanded) {
  Case c = find(numbers(false), "parts in one scene", "cubes fall on a floor");
  *c.request.seconds *= 0.5;
  for (const std::string& solver : both) EXPECT_EQ(run(c, solver).failures, Strings{"did not land"}) << solver;
}

TEST_F(Stress, SeesWhatGrowsWithEveryScene) {
  const auto judged = [](double cpu_growth, double bytes, double once = 0.0) {
    std::vector<double> cpu = {0.0}, in_use;
    for (int scene = 0; scene < 1000; ++scene) {
      cpu.push_back(cpu.back() + 1e-3 * (1.0 + cpu_growth * scene));
      in_use.push_back(1e6 + bytes * scene + (scene > 400 ? once : 0.0));
    }
    Outcome outcome;
    judge_growth(cpu, in_use, outcome);
    return outcome;
  };
  EXPECT_TRUE(judged(0.0, 0.0).survived());
  EXPECT_EQ(judged(0.0, 100.0).failures, Strings{"memory in use grew by 75000 bytes"});
  EXPECT_TRUE(judged(0.0, 0.0, 4e5).survived()) << "a buffer that is enlarged once";
  EXPECT_EQ(judged(0.0, 100.0, 4e5).failures, Strings{"memory in use grew by 75000 bytes"});
  const Outcome slower = judged(0.01, 0.0);
  ASSERT_EQ(slower.failures.size(), 1u);
  EXPECT_NEAR(slower.pace, 10.5 / 2.5, 0.01);
}

}  // namespace
}  // namespace bin_scenes::stress
