/// The reference of a request's keys: ranges as the reader takes them, and the page that shows it.
#include "config/reference.hpp"

#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "config/config_fixture.hpp"

#include <cctype>
#include <cstdio>
#include <iterator>
#include <map>
#include <sstream>

namespace bin_scenes {
namespace {

TEST(Reference, TellsTheRangeThatIsTaken) {
  std::map<std::string, std::string> kinds;
  for (const config::Entry& entry : config::reference()) kinds[entry.path] = entry.kind;
  EXPECT_EQ(kinds["parts[].count"], "whole number in [1, 1000000]");
  EXPECT_EQ(kinds["parts[].scale"], "number in (0, 1000000]");
  EXPECT_EQ(kinds["seed"], "whole number, 0 or more");
  EXPECT_EQ(kinds["sensors[].near"], "number above 0");
  EXPECT_EQ(kinds["bin.inner_size"], "[x, y, z], each in (0, 1000]");
  EXPECT_EQ(kinds["solver.type"], "auto | sphere | bullet");
}

TEST(Reference, TheDocumentedKeysAreThoseOfTheTable) {
  std::ifstream file(std::string(BIN_SCENES_DOCS) + "/use/request.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  char holes[64];
  std::snprintf(holes, sizeof holes, "Holes with a perimeter of at most %g %% of the diagonal",
                100.0 * LoadOptions().max_hole);
  EXPECT_NE(text.find(holes), std::string::npos);
  EXPECT_EQ(text, request_reference()) << "run: bin_scenes reference > docs/use/request.md";
}

// A reader sees one row only, in the page, in an editor or in an error message.
TEST(Reference, TextsAreSentences) {
  for (const std::string& page : {request_reference(), scene_reference()}) {
    std::istringstream lines(page);
    std::size_t rows = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("| `", 0) != 0) continue;
      ++rows;
      const std::string text = line.substr(line.rfind(" | ", line.size() - 4) + 3);
      EXPECT_FALSE(std::islower(static_cast<unsigned char>(text[0]))) << line;
      EXPECT_EQ(text.substr(text.size() - 3), ". |") << line;
    }
    EXPECT_GT(rows, 90u);
  }
}

TEST(Reference, TheDocumentedSceneIsThatOfTheTable) {
  std::ifstream file(std::string(BIN_SCENES_DOCS) + "/use/scene.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, scene_reference()) << "run: bin_scenes reference --scene > docs/use/scene.md";
}

}  // namespace
}  // namespace bin_scenes
