#include "bin_scenes/core/error.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

TEST(Error, SaysWhereWhatAndHowToMendItInOneSentence) {
  const Error error = input_error("is not there", "bolt.stl", "check the path");
  EXPECT_STREQ(error.what(), "bolt.stl: is not there (check the path)");
  EXPECT_EQ(error.kind(), ErrorKind::input);
  EXPECT_EQ(error.problem(), "is not there");
  EXPECT_EQ(error.where(), "bolt.stl");
  EXPECT_EQ(error.remedy(), "check the path");
}

TEST(Error, LeavesOutWhatThereIsNothingToSayAbout) {
  EXPECT_STREQ(environment_error("no EGL device", "", "").what(), "no EGL device");
}

TEST(Error, KindsAreTheExitCodes) {
  EXPECT_EQ(static_cast<int>(ErrorKind::input), 2);
  EXPECT_EQ(static_cast<int>(ErrorKind::environment), 3);
}

}  // namespace
}  // namespace bin_scenes
