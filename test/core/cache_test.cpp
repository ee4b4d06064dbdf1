#include "bin_scenes/core/cache.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;

class CacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bin_scenes_cache_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    unsetenv("BIN_SCENES_CACHE");
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// The one file in the cache.
  fs::path file() const {
    fs::path only;
    for (const auto& entry : fs::directory_iterator(folder_ / "bin_scenes")) {
      EXPECT_TRUE(only.empty()) << "two files: " << only << ", " << entry.path();
      only = entry.path();
    }
    return only;
  }

  fs::path folder_;
  const Cache& cache_ = Cache::global();
};

TEST(Sha256, KnownDigests) {  // FIPS 180-2, appendix B
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_F(CacheTest, GivesBackWhatWasWritten) {
  EXPECT_FALSE(cache_.read("field", "key"));
  const Bytes bytes = {1, 2, 3, 0, 255};
  cache_.write("field", "key", bytes);
  EXPECT_EQ(cache_.read("field", "key"), bytes);
  EXPECT_FALSE(cache_.read("field", "other"));
  EXPECT_FALSE(cache_.read("hulls", "key"));
  cache_.write("field", "key", {});
  EXPECT_EQ(cache_.read("field", "key"), Bytes{});
  file();  // no temporary file is left behind
}

TEST_F(CacheTest, AnyKeyIsSafe) {
  const std::string key = "../../../etc/passwd\n" + std::string(500, 'x') + '\0' + "/";
  cache_.write("mesh", key, {42});
  EXPECT_EQ(cache_.read("mesh", key), Bytes{42});
}

TEST_F(CacheTest, ADamagedFileIsNotTrusted) {
  const Bytes bytes(1000, 7);
  for (const int offset : {0, 9, 20, 60, 900}) {
    cache_.write("field", "key", bytes);
    ASSERT_TRUE(cache_.read("field", "key"));
    std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(offset);
    stream.put('\x55');
    stream.close();
    EXPECT_FALSE(cache_.read("field", "key")) << "byte " << offset;
  }
  for (const std::uintmax_t size : {0u, 5u, 79u, 80u, 500u, 1079u, 2000u}) {
    cache_.write("field", "key", bytes);
    ASSERT_TRUE(cache_.read("field", "key"));
    fs::resize_file(file(), size);
    EXPECT_FALSE(cache_.read("field", "key")) << size << " bytes long";
  }
  cache_.write("field", "key", bytes);
  EXPECT_EQ(cache_.read("field", "key"), bytes);
}

TEST_F(CacheTest, AFileUnderAnotherNameIsNotTrusted) {
  cache_.write("field", "a", {1});
  const fs::path first = file();
  fs::rename(first, folder_ / "kept");
  cache_.write("field", "b", {2});
  fs::copy_file(folder_ / "kept", file(), fs::copy_options::overwrite_existing);
  EXPECT_FALSE(cache_.read("field", "b"));
}

// Opening a pipe that nobody writes to waits for ever; the time limit of the test would tell.
TEST_F(CacheTest, APipeInTheCacheIsPassedOverAtOnceAndReplaced) {
  const Bytes bytes = {1, 2, 3};
  cache_.write("field", "key", bytes);
  const fs::path place = file();
  fs::remove(place);
  ASSERT_EQ(mkfifo(place.c_str(), 0600), 0);
  EXPECT_FALSE(cache_.read("field", "key"));
  cache_.write("field", "key", bytes);
  EXPECT_EQ(cache_.read("field", "key"), bytes);
}

TEST_F(CacheTest, CanBeSwitchedOff) {
  cache_.write("field", "key", {1});
  setenv("BIN_SCENES_CACHE", "off", 1);
  EXPECT_FALSE(cache_.read("field", "key"));
  EXPECT_EQ(cache_.directory(), "");
  unsetenv("BIN_SCENES_CACHE");
  EXPECT_TRUE(cache_.read("field", "key"));
}

TEST_F(CacheTest, FollowsTheXdgRules) {
  EXPECT_EQ(cache_.directory(), (folder_ / "bin_scenes").string());
  setenv("HOME", "/home/someone", 1);
  setenv("XDG_CACHE_HOME", "relative/path", 1);
  EXPECT_EQ(cache_.directory(), "/home/someone/.cache/bin_scenes");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(cache_.directory(), "/home/someone/.cache/bin_scenes");
}

TEST_F(CacheTest, AnUnwritablePlaceIsNoError) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "bin_scenes") << "a file where the folder should be";
  cache_.write("field", "key", {1});
  EXPECT_FALSE(cache_.read("field", "key"));
}

TEST_F(CacheTest, TwoProcessesWritingAtOnceDoNoHarm) {
  const auto contents = [](int round) { return Bytes(100000 + round, static_cast<std::uint8_t>(round)); };
  const pid_t child = fork();
  const int rounds = 100;
  bool whole = true;
  for (int round = 0; round < rounds; ++round) {
    cache_.write("field", "key", contents(round));
    const auto bytes = cache_.read("field", "key");
    whole = whole && bytes && bytes->size() > 0 && *bytes == contents(bytes->data()[0]);
  }
  if (child == 0) _exit(whole ? 0 : 1);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(whole);
  EXPECT_EQ(status, 0);
  file();
}

}  // namespace
}  // namespace bin_scenes
