/// Every model file at hand, good or broken, ends in a report or in one clear error: none crashes, none hangs.
/// Debian's assimp-testmodels where they are installed; the folder in BIN_SCENES_REAL_PARTS, or real parts beside the
/// checkout, where there are any.

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "contained.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code missing;
  for (const auto& entry : fs::recursive_directory_iterator(folder, missing)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// "closed", "open" or "error: <text>"; empty if something other than an Error came out.
std::string outcome(const fs::path& path) {
  LoadOptions options;
  options.require_closed = false;
  try {
    const LoadedMesh loaded = load_mesh(path.string(), options);
    if (loaded.mesh.empty() || loaded.report.content_sha256.size() != 64) return {};
    for (const Vec3& v : loaded.mesh.vertices) {
      if (!v.allFinite()) return {};
    }
    return loaded.report.closed ? "closed" : "open";
  } catch (const Error& error) {
    const bool complete = error.kind() == ErrorKind::input && !error.problem().empty() && !error.remedy().empty() &&
                          error.where() == path.string();
    return complete ? std::string("error: ") + error.what() : std::string();
  } catch (...) {
    return {};
  }
}

struct Tally {
  int closed = 0, open = 0, refused = 0;
};

Tally sweep(const std::vector<fs::path>& files) {
  Tally tally;
  for (const fs::path& path : files) {
    // In a process of its own, with a bound on its processor time, so that one bad file fails alone.
    const Contained run = run_contained([&] { return outcome(path); }, {30});
    EXPECT_TRUE(run.finished) << path << " " << run.failure;
    EXPECT_FALSE(run.finished && run.output.empty()) << path << ": neither a report nor a clear error";
    tally.closed += run.output == "closed";
    tally.open += run.output == "open";
    tally.refused += run.output.rfind("error", 0) == 0;
  }
  std::printf("%zu files: %d closed, %d open, %d refused\n", files.size(), tally.closed, tally.open, tally.refused);
  return tally;
}

TEST(ModelSweep, AssimpTestModels) {
  const std::vector<fs::path> files = files_in("/usr/share/assimp/models");
  if (files.empty()) GTEST_SKIP() << "package assimp-testmodels is not installed";
  const Tally tally = sweep(files);
  EXPECT_GE(tally.closed, 30);
  EXPECT_GE(tally.open, 15);
}

TEST(ModelSweep, RealParts) {
  const char* given = std::getenv("BIN_SCENES_REAL_PARTS");
  const std::vector<fs::path> files = files_in(given ? given : SHARED_MODELS);
  if (files.empty()) GTEST_SKIP() << "no real parts at hand";
  sweep(files);
}

TEST(ModelSweep, SampleParts) {
  const char* models = std::getenv("BIN_SCENES_MODELS");
  if (!models) GTEST_SKIP() << "BIN_SCENES_MODELS is not set";
  for (const fs::path& path : files_in(models)) {
    if (path.extension() != ".stl") continue;
    EXPECT_EQ(outcome(path), "closed") << path;
  }
}

/// The traps of the real parts, each by name; files that are not there are left out.
TEST(ModelSweep, RealPartsWithKnownTraps) {
  const char* given = std::getenv("BIN_SCENES_REAL_PARTS");
  const fs::path folder = given ? given : SHARED_MODELS;
  const auto load = [&](const char* name) -> std::optional<LoadedMesh> {
    if (!fs::exists(folder / name)) return std::nullopt;
    return load_mesh((folder / name).string());
  };
  const auto has = [](const LoadedMesh& loaded, const std::string& code) {
    const auto& flags = loaded.report.flags;
    return std::any_of(flags.begin(), flags.end(), [&](const Flag& flag) { return flag.code == code; });
  };
  if (const auto nut = load("nut_m20_threaded_m.obj")) {
    EXPECT_TRUE(nut->report.closed);
    EXPECT_EQ(nut->report.t_junctions_split, 84u);
    EXPECT_EQ(nut->report.holes_closed, 0u);
  }
  if (const auto tee = load("pipe_tee_mm.stl")) {
    EXPECT_TRUE(has(*tee, "degenerate_removed"));
  }
  if (const auto bracket = load("bracket_sheet_L_mm.stl")) {
    EXPECT_TRUE(bracket->report.closed);
  }
  if (const auto conrod = load("conrod_unit_mm.dae")) {
    EXPECT_TRUE(conrod->report.closed);
    EXPECT_EQ(conrod->report.unit, Unit::millimetre);
    EXPECT_EQ(conrod->report.shells, 1u);
    EXPECT_TRUE(has(*conrod, "shells_united"));
    EXPECT_TRUE(has(*conrod, "file_mended"));
    EXPECT_TRUE(has(*conrod, "hidden_holes_closed"));
    EXPECT_NEAR(conrod->mesh.bounds().size().y(), 0.646, 1e-3);  // z up: not turned
  }
  try {
    EXPECT_FALSE(load("x_washer_double_faced_m.dae")) << "encloses nothing and was accepted";
  } catch (const Error& error) {
    EXPECT_NE(error.problem().find("every face is there twice"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace bin_scenes
