#include "bin_scenes/gl/program.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/timer.hpp"
#include "bin_scenes/gl/traffic.hpp"
#include "shared/layout_probe.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace bin_scenes::gl {
namespace {

namespace fs = std::filesystem;

class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override { Device::current().make_current(); }
};

TEST_F(ProgramTest, StructsLieAlikeInBothLanguages) {
  constexpr std::size_t count = 77;  // not a multiple of the group size
  std::vector<gpu::LayoutProbe> probes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto f = static_cast<float>(100 * i);
    const auto u = static_cast<std::uint32_t>(100 * i), s = static_cast<std::uint32_t>(i);
    probes[i] = {{f, f + 1, f + 2, f + 3},
                 {u + 4, u + 5},
                 f + 6,
                 u + 7,
                 {-static_cast<int>(s), 8, 9, 10},
                 {f + 11, f + 12},
                 {u + 16, u + 20},
                 {f + 21, f + 22, f + 23},
                 u + 24};
  }
  Buffer<gpu::LayoutProbe> in("in"), out("out");
  in.upload(probes);
  out.resize(count + 1);
  in.bind(0);
  out.bind(1);
  const Program program = Program::compute("test/layout_probe.comp");
  program.set("count", static_cast<unsigned>(count));
  dispatch(program, count);
  const std::vector<gpu::LayoutProbe> copies = out.download();
  for (std::size_t i = 0; i < count; ++i) {
    const gpu::LayoutProbe &a = probes[i], &b = copies[i];
    EXPECT_EQ(b.vector.x, a.vector.w);
    EXPECT_EQ(b.vector.y, a.vector.z);
    EXPECT_EQ(b.pair.x, a.pair.y);
    EXPECT_EQ(b.pair.y, a.pair.x);
    EXPECT_EQ(b.number, a.number + 1);
    EXPECT_EQ(b.word, a.word + 2);
    EXPECT_EQ(b.signed_words.x, a.signed_words.x - 1);
    EXPECT_EQ(b.signed_words.w, a.signed_words.w - 4);
    EXPECT_EQ(b.two.y, a.two.y * 2);
    EXPECT_EQ(b.tail[0], a.tail[0] ^ 1u);
    EXPECT_EQ(b.tail[1], a.tail[1] ^ 2u);
    EXPECT_EQ(b.three.x, a.three.z);
    EXPECT_EQ(b.three.z, a.three.y);
    EXPECT_EQ(b.behind, a.behind + 3);
  }
  EXPECT_EQ(copies[count].word, 0u) << "wrote beyond the count";
}

TEST_F(ProgramTest, TrafficIsCountedWhileItIsLookedAt) {
  const Program program = Program::compute("test/layout_probe.comp");
  program.set("count", 3u);
  Buffer<gpu::LayoutProbe> in("in"), out("out");
  in.resize(3);
  out.resize(3);
  in.bind(0);
  out.bind(1);
  Profile profile;
  {
    const TrafficCount count(profile);
    in.upload(std::vector<gpu::LayoutProbe>(3));  // a barrier, as before every copy
    dispatch(program, 3);
    dispatch(program, 3, Barrier::none);
    dispatch(program, 0);  // nothing to do, nothing asked for
    out.download(1, 2);    // two: behind what passes wrote, and before what the host reads
  }
  dispatch(program, 3);
  EXPECT_EQ(profile.counters.at("gl_dispatches"), 2u);
  EXPECT_EQ(profile.counters.at("gl_barriers"), 4u);
  EXPECT_EQ(profile.counters.at("gl_bytes_uploaded"), 3 * sizeof(gpu::LayoutProbe));
  EXPECT_EQ(profile.counters.at("gl_bytes_read_back"), 2 * sizeof(gpu::LayoutProbe));
}

TEST_F(ProgramTest, FoldedDispatchReachesEveryItemOnce) {
  constexpr std::size_t count = 70001;
  Buffer<std::uint32_t> marks("marks");
  marks.resize(count);
  marks.bind(0);
  const Program program = Program::compute("test/mark_groups.comp");
  program.set("count", static_cast<unsigned>(count));
  dispatch(program, count);
  const std::vector<std::uint32_t> seen = marks.download();
  for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(seen[i], i + 1);
}

TEST_F(ProgramTest, IndirectDispatchTakesItsCountFromTheDevice) {
  Buffer<std::uint32_t> marks("marks"), arguments("arguments");
  marks.resize(10);
  arguments.resize(3);
  marks.bind(0);
  arguments.bind(1);
  const Program ask = Program::compute("test/ask_groups.comp"), mark = Program::compute("test/mark_groups.comp");
  mark.set("count", 10u);
  for (unsigned groups : {0u, 6u}) {
    ask.set("groups", groups);
    dispatch(ask, 1);
    dispatch_indirect(mark, arguments.storage());
    const std::vector<std::uint32_t> seen = marks.download();
    for (unsigned i = 0; i < 10; ++i) EXPECT_EQ(seen[i], i < groups ? i + 1 : 0) << groups << " groups";
  }
}

TEST_F(ProgramTest, CompileErrorNamesFileAndLine) {
  try {
    Program::compute("test/broken.comp");
    FAIL() << "compiled nonsense";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("test/broken.comp:4"), std::string::npos) << error.what();
  }
}

TEST_F(ProgramTest, MissingFileIsAnErrorThatNamesIt) {
  try {
    Program::compute("test/absent.comp");
    FAIL() << "found a file that is not there";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("test/absent.comp"), std::string::npos);
  }
}

/// Its own cache directory, so that what lies on this machine does not matter.
class ProgramCacheTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    char pattern[] = "/tmp/bin_scenes_test_XXXXXX";
    directory_ = mkdtemp(pattern);
    setenv("XDG_CACHE_HOME", directory_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("XDG_CACHE_HOME");
    fs::remove_all(directory_);
  }
  static bool works(const Program& program) {
    Buffer<std::uint32_t> marks("marks");
    marks.resize(3);
    marks.bind(0);
    program.set("count", 3u);
    dispatch(program, 3);
    return marks.download() == std::vector<std::uint32_t>{1, 2, 3};
  }
  fs::path only_file() const { return fs::directory_iterator(directory_ / "bin_scenes/programs")->path(); }
  fs::path directory_;
};

TEST_F(ProgramCacheTest, SecondLoadComesFromTheCache) {
  EXPECT_FALSE(Program::compute("test/mark_groups.comp").from_cache());
  if (!fs::exists(directory_ / "bin_scenes")) GTEST_SKIP() << "the driver offers no program binaries";
  const Program second = Program::compute("test/mark_groups.comp");
  EXPECT_TRUE(second.from_cache());
  EXPECT_TRUE(works(second));
  EXPECT_FALSE(Program::compute("test/mark_groups.comp", {{"OTHER", "1"}}).from_cache()) << "another source";
}

TEST_F(ProgramCacheTest, DamagedFileIsCompiledAnew) {
  Program::compute("test/mark_groups.comp");
  if (!fs::exists(directory_ / "bin_scenes")) GTEST_SKIP() << "the driver offers no program binaries";
  const fs::path file = only_file();
  for (const bool cut : {true, false}) {
    if (cut) {
      fs::resize_file(file, fs::file_size(file) / 2);
    } else {
      std::fstream edit(file, std::ios::in | std::ios::out | std::ios::binary);
      edit.seekp(static_cast<std::streamoff>(fs::file_size(file)) - 5);
      edit.put('!').put('?');
    }
    const Program program = Program::compute("test/mark_groups.comp");
    EXPECT_FALSE(program.from_cache());
    EXPECT_TRUE(works(program));
    EXPECT_TRUE(Program::compute("test/mark_groups.comp").from_cache()) << "the damaged file was not replaced";
  }
}

TEST_F(ProgramCacheTest, WorksWhereNothingCanBeWritten) {
  setenv("XDG_CACHE_HOME", "/proc/nothing_here", 1);
  EXPECT_TRUE(works(Program::compute("test/mark_groups.comp")));
}

TEST_F(ProgramTest, TimerSumsStagesByNameWithoutLosingAny) {
  Buffer<std::uint32_t> marks("marks");
  marks.resize(50000);
  marks.bind(0);
  const Program program = Program::compute("test/mark_groups.comp");
  program.set("count", 50000u);
  Timer timer;
  for (int i = 0; i < 3; ++i) {
    Stage stage(timer, "mark_groups");
    dispatch(program, 50000);
  }
  { Stage stage(timer, "nothing"); }
  Profile profile;
  timer.collect(profile, true);
  EXPECT_EQ(profile.stages_ms.size(), 2u);
  EXPECT_GT(profile.stages_ms["mark_groups"], profile.stages_ms["nothing"]);
  EXPECT_GE(profile.stages_ms["nothing"], 0.0);
}

}  // namespace
}  // namespace bin_scenes::gl
