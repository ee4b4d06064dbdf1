/// docs/use/scene.md from the tables of scene.json.
#include "config/key_collector.hpp"
#include "config/scene_file_keys.hpp"
#include "config/values.hpp"

namespace bin_scenes {

namespace config {

namespace {

/// What a value looks like in JSON, where that is not as in a request.
struct SceneColumns {
  template <class Value>
  static std::string kind(const Key&, const Value& value) {
    if constexpr (std::is_same_v<Value, Pose>)
      return "{position: [x, y, z], orientation_xyzw: [x, y, z, w]}";
    else if constexpr (std::is_same_v<Value, Twist>)
      return "{linear: [x, y, z], angular: [x, y, z]}";
    else if constexpr (std::is_same_v<Value, Hexadecimal>)
      return "text of 16 hexadecimal digits";
    else if constexpr (std::is_same_v<Value, std::vector<int>>)
      return "list of whole numbers";
    else if constexpr (std::is_same_v<Value, std::vector<std::string>>)
      return "list of texts";
    else if constexpr (std::is_same_v<Value, std::array<int, 2>>)
      return "2 whole numbers";
    else if constexpr (std::is_same_v<Value, std::array<int, 4>>)
      return "4 whole numbers";
    else if constexpr (std::is_same_v<Value, std::map<std::string, double>>)
      return "map of numbers";
    else if constexpr (std::is_same_v<Value, std::map<std::string, std::uint64_t>>)
      return "map of whole numbers";
    else
      return kind_of(value);
  }
  template <class Value>
  static std::string value(const Key&, const Value&) {
    return "";
  }
};

}  // namespace

}  // namespace config

std::string scene_reference() {
  SceneFile scene;
  config::KeyCollector<config::SceneColumns> collector;
  visit(collector, scene);
  return "# scene.json\n"
         "\n"
         "<!-- Made by `bin_scenes reference --scene > docs/use/scene.md` from src/scene/report_keys.hpp and\n"
         "src/config/scene_file_keys.hpp; a test compares. -->\n"
         "\n"
         "Each scene has a file `scene.json`. Units are SI, z points up, quaternions are x y z w. Numbers read back "
         "as\n"
         "the same bits. A number that is not finite is null. Of two runs of a request on one class of device, only\n"
         "`report.wall_s`, `report.stages_ms` and `report.counters` may differ. `read_scene_file()` of\n"
         "`bin_scenes/config/scene_file.hpp` reads the file as a struct; in Python, `scene.report` is the map "
         "`report`.\n"
         "\n"
         "## Keys\n"
         "\n" +
         config::key_chapters(collector.entries, false);
}

}  // namespace bin_scenes
