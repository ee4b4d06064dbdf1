#include "bin_scenes/core/temporary.hpp"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {
/// What was synced, and whether the final name was there already then.
struct Sync {
  std::string path;
  bool named;
};
std::vector<Sync> syncs;
std::string watched;  ///< the final name

void note(int descriptor) {
  char path[4096] = {};
  if (readlink(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), path, sizeof path - 1) > 0)
    syncs.push_back({path, std::filesystem::exists(watched)});
}
}  // namespace

// The library calls these instead of those of the system.
extern "C" int fsync(int descriptor) {
  note(descriptor);
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}
extern "C" int syncfs(int descriptor) noexcept {
  note(descriptor);
  return static_cast<int>(syscall(SYS_syncfs, descriptor));
}

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;

class TemporaryTest : public ::testing::Test {
 protected:
  TemporaryTest() {
    dir = fs::temp_directory_path() / ("bin_scenes_temporary_" + std::to_string(getpid()));
    fs::create_directories(dir);
  }
  ~TemporaryTest() override { fs::remove_all(dir); }

  std::size_t entries() const { return std::distance(fs::directory_iterator(dir), fs::directory_iterator()); }
  std::string text(const fs::path& name) const {
    std::ifstream file(dir / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Does it in a process that is killed before it can tidy up.
  template <class Work>
  void in_a_killed_process(const Work& work) {
    const pid_t child = fork();
    if (child == 0) {
      work();
      raise(SIGKILL);
    }
    waitpid(child, nullptr, 0);
  }

  fs::path dir;
};

TEST_F(TemporaryTest, LeftoversOfAKilledProcessAreRemoved) {
  in_a_killed_process([&] {
    const Temporary file((dir / "a.txt").string()), folder((dir / "scene").string());
    std::ofstream(file.path()) << "half";
    fs::create_directory(folder.path());
    std::ofstream(folder.path() + "/scene.json") << "half";
    raise(SIGKILL);
  });
  EXPECT_EQ(entries(), 2u);
  EXPECT_EQ(remove_leftovers(dir.string()), 2u);
  EXPECT_EQ(entries(), 0u);
}

TEST_F(TemporaryTest, AProcessThatEndedWritesNoMoreThoughNobodyAskedHow) {
  const pid_t child = fork();
  if (child == 0) {
    const Temporary file((dir / "a.txt").string());
    std::ofstream(file.path()) << "half";
    raise(SIGKILL);
  }
  siginfo_t ended;
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
  EXPECT_EQ(remove_leftovers(dir.string()), 1u);
  EXPECT_EQ(entries(), 0u);
  waitpid(child, nullptr, 0);
}

TEST_F(TemporaryTest, WhatIsStillWrittenAndWhatOtherHostsWriteStays) {
  const Temporary mine((dir / "a.txt").string());
  std::ofstream(mine.path()) << "half";
  std::ofstream(dir / ".a.txt.tmp-1-0@another-host") << "half";
  std::ofstream(dir / ".hidden") << "not ours";
  std::ofstream(dir / ".a.tmp-x@y") << "not ours";
  EXPECT_EQ(remove_leftovers(dir.string()), 0u);
  EXPECT_EQ(entries(), 4u);
}

TEST_F(TemporaryTest, ADirectoryThatSteppedAsideComesBackIfItsSuccessorNeverCame) {
  in_a_killed_process([&] {
    const Temporary successor((dir / "scene").string());
    fs::create_directory(successor.path() + "-old");
    std::ofstream(successor.path() + "-old/scene.json") << "whole";
    raise(SIGKILL);
  });
  remove_leftovers(dir.string());
  EXPECT_EQ(text("scene/scene.json"), "whole");
  EXPECT_EQ(entries(), 1u);
}

// Else a loss of power leaves the name with nothing behind it.
TEST_F(TemporaryTest, ContentsAreOnTheDiskBeforeTheNameAndTheNameBeforeItReturns) {
  for (const int files : {1, 30}) {
    watched = (dir / ("scene" + std::to_string(files))).string();
    syncs.clear();
    Temporary folder(watched);
    const std::string hidden = folder.path();
    fs::create_directory(hidden);
    for (int i = 0; i < files; ++i) std::ofstream(hidden + "/" + std::to_string(i)) << "whole";
    folder.commit();
    ASSERT_GE(syncs.size(), 2u);
    EXPECT_EQ(syncs.front().path, hidden);
    for (std::size_t i = 0; i + 1 < syncs.size(); ++i) EXPECT_FALSE(syncs[i].named) << syncs[i].path;
    EXPECT_EQ(syncs.back().path, dir.string());
    EXPECT_TRUE(syncs.back().named);
  }
}

TEST_F(TemporaryTest, TwoOfOneTargetDoNotMeet) {
  const Temporary one((dir / "a.txt").string()), other((dir / "a.txt").string());
  EXPECT_NE(one.path(), other.path());
}

}  // namespace
}  // namespace bin_scenes
