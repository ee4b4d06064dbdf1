/// Requests that no person writes: each is refused by one printable line, and none takes time or memory beyond its
/// size.
#include "bin_scenes/core/cancel.hpp"
#include "config/yaml_text.hpp"
#include "config_fixture.hpp"

#include <algorithm>

namespace bin_scenes {
namespace {

class HostileRequest : public ConfigTest {
 protected:
  void expect_one_line(const std::string& text, const std::vector<Override>& overrides = {}) {
    try {
      read(text, overrides);
      ADD_FAILURE() << "was read: " << text.substr(0, 80);
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_LT(message.size(), 1000u);
      EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](unsigned char c) { return c >= 0x20; })) << message;
    }
  }
};

// yaml-cpp finds a null document before a token that starts no value, and does not get past it.
TEST_F(HostileRequest, PunctuationAtTheEndOfADocumentDoesNotLoop) {
  for (const char* text : {",", "{a: 1},", "]", "}", "[1],", ", ,", "a: 1\n,", "--- ,", "? ,", "[]]", "{}}", "*a",
                           "&a ,", "!t ,", "- ,", "%,", "|,\n ,"}) {
    expect_one_line(text);
  }
  expect_one_line("{}", {Override("seed=,")});
  expect_one_line("{}", {Override("seed={a: 1},")});
}

TEST_F(HostileRequest, EveryShortTextOfPunctuationEnds) {
  const std::string signs = ",{}[]:-?&*!|>#% \na'\"";
  constexpr std::size_t length = 3;
  std::size_t count = 1, read_as_a_map = 0;
  for (std::size_t i = 0; i < length; ++i) count *= signs.size();
  for (std::size_t number = 0; number < count; ++number) {
    std::string text;
    for (std::size_t i = 0, left = number; i < length; ++i, left /= signs.size()) text += signs[left % signs.size()];
    try {
      read_as_a_map += config::load_yaml(text, "text").IsMap();
    } catch (const Error&) {
    }
  }
  EXPECT_GT(read_as_a_map, 10u);  // "a: a" is one
}

TEST_F(HostileRequest, ValuesOfMegabytesAreShownByTheirEnds) {
  const std::string bolts = "parts:\n  - model: bolt.stl\n";
  expect_one_line(bolts + "seed: " + std::string(10'000'000, '7') + "\n");
  expect_one_line(bolts + "seed: \"a\\nb\\0c\\e[31m\"\n");
  expect_one_line(bolts + "    unit: \"" + std::string(1'000'000, 'x') + "\"\n");
  expect_one_line("parts: [{model: \"no\\nsuch\\0file\"}]\n");
}

// A table of distances would have 400,000 lines for each known key.
TEST_F(HostileRequest, AnUnknownKeyOfHundredsOfKilobytesIsNotCompared) {
  expect_one_line("? " + std::string(400'000, 'k') + "\n: 1\nparts:\n  - model: bolt.stl\n");
}

TEST_F(HostileRequest, BracketsWithoutEndAreRefused) {
  expect_one_line(std::string(300'000, '['));
  expect_one_line(std::string(300'000, '{'));
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += std::string(i, ' ') + "-\n";
  expect_one_line(deep);
}

TEST_F(HostileRequest, AliasesDoNotMultiplyWithoutBound) {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string name = "a" + std::to_string(i), inner = "*a" + std::to_string(i - 1);
    text += name + ": &" + name + " [";
    for (int k = 0; k < 10; ++k) text += inner + ", ";
    text += "1]\n";
  }
  expect_one_line(text);
  expect_one_line("a: &a [*a]\n");
}

TEST_F(HostileRequest, ReadingStopsWhereNobodyWantsItAnyMore) {
  const std::atomic<bool> flag{true};
  const CancelScope scope(&flag);
  std::string text = "parts:\n";
  for (int i = 0; i < 20'000; ++i) text += "  - model: bolt.stl\n";
  try {
    config::load_yaml(text, "text");
    FAIL() << "was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
}

}  // namespace
}  // namespace bin_scenes
