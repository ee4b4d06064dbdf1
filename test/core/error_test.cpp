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

TEST(Error, IsOnePrintableLineBelowOneKilobyteWhateverAFilePutIn) {
  std::string hostile = "a\nb\tc\x1b[31m\x9b\xc2\x9b";
  hostile += std::string("\0end", 4);
  const Error error = input_error("bad '" + hostile + "'", "file", "remove it");
  EXPECT_STREQ(error.what(), "file: bad 'a\\nb\\tc\\x1b[31m\\x9b\\xc2\\x9b\\x00end' (remove it)");
  const std::string long_text(1'000'000, '\n');
  const std::string text = input_error("begin " + long_text + " end", "x" + long_text, long_text + "y").what();
  EXPECT_LT(text.size(), 1000u);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_NE(text.find("begin"), std::string::npos);
  EXPECT_EQ(text.back(), ')');
}

TEST(Error, KeepsLettersOfAllLanguagesWholeAlsoWhereItCuts) {
  EXPECT_STREQ(input_error("Größe 工件", "", "").what(), "Größe 工件");
  std::string umlauts;
  for (int i = 0; i < 999; ++i) umlauts += "ü";
  const std::string text = input_error(umlauts, "", "").what();
  EXPECT_EQ(text.find('\\'), std::string::npos) << text;
}

TEST(Error, KindsAreTheExitCodes) {
  EXPECT_EQ(static_cast<int>(ErrorKind::input), 2);
  EXPECT_EQ(static_cast<int>(ErrorKind::environment), 3);
}

}  // namespace
}  // namespace bin_scenes
