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

namespace {

constexpr const char* scene_head = R"head(# scene.json

<!-- Made by `bin_scenes reference --scene > docs/use/scene.md` from src/scene/report_keys.hpp and
src/config/scene_file_keys.hpp; a test compares. -->

This page lists all keys of the file `scene.json`, which each scene has. The file contains the poses and states of the
parts, the sensors, and a report on the quality of the scene. For example, this Python program prints the positions of
all parts that are at rest:

```python
import json
scene = json.load(open("scenes/scene_000000/scene.json"))
print([p["pose"]["position"] for p in scene["parts"] if p["state"] == "resting"])
```

All values are in SI units unless the table states another unit. The z axis points up, and the components of a
quaternion are ordered x y z w. Numbers are written such that they have the same bits when they are read again. A
number that is not finite is written as null. If a request is run twice on one class of devices, only
`report.wall_s`, `report.stages_ms` and `report.counters` may differ.

In C++, `read_scene_file()` of `bin_scenes/config/scene_file.hpp` reads the file as a struct. In Python,
`scene.report` is the map `report`.

## Keys

)head";

}  // namespace

std::string scene_reference() {
  SceneFile scene;
  config::KeyCollector<config::SceneColumns> collector;
  visit(collector, scene);
  return scene_head + config::key_chapters(collector.entries, false);
}

}  // namespace bin_scenes
