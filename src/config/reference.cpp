/// The page about the request: a table a section, from the visitor of its keys.
#include "config/reference.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/assertion.hpp"
#include "config/key_collector.hpp"
#include "config/values.hpp"

#include <cmath>
#include <map>
#include <type_traits>

namespace bin_scenes {

namespace config {

namespace {

/// "number in [0, 10]"; "(" where the least itself is excluded.
std::string kind_in(const Range& range, const std::string& kind) {
  BIN_SCENES_ASSERT(range.least < range.most);
  if (!std::isfinite(range.least)) return kind;
  const std::string least = text_of(range.least), plain = kind.substr(0, kind.find(','));
  if (std::isfinite(range.most))
    return (kind.find('[') == std::string::npos ? plain : kind + ", each") + " in " + (range.above ? "(" : "[") +
           least + ", " + text_of(range.most) + "]";
  return plain + (range.above ? " above " + least : ", " + least + " or more");
}

struct RequestColumns {
  template <class Value>
  static std::string kind(const Key& key, const Value& value) {
    return kind_in(key.range, kind_of(value));
  }
  template <class Value>
  static std::string value(const Key& key, const Value& value) {
    const std::string text = text_of(value);
    return text == "[]" || text == "\"\"" || !key.written ? "" : text;
  }
};

bool heading(const Entry& entry) {
  return entry.kind == "section" || entry.kind == "list";
}

std::string escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

class ChapterWriter {
 public:
  ChapterWriter(const std::vector<Entry>& entries, bool defaults) : entries_(entries), defaults_(defaults) {}

  /// Rows of the keys directly below `prefix`, then a chapter for each section among them. One with the same keys and
  /// defaults as an earlier one names that.
  std::string chapter(const std::string& prefix, const std::string& level) {
    const auto directly_below = [&](const std::string& path) {
      return path.size() > prefix.size() && path.compare(0, prefix.size(), prefix) == 0 &&
             path.find('.', prefix.size()) == std::string::npos;
    };
    std::string text = defaults_ ? "| key | value | default | unit | meaning |\n|---|---|---|---|---|\n"
                                 : "| key | value | unit | meaning |\n|---|---|---|---|\n";
    for (const Entry& e : entries_)
      if (directly_below(e.path)) text += row(e, prefix);
    for (const Entry& e : entries_) {
      if (!directly_below(e.path) || !heading(e)) continue;
      const std::string below = chapter(e.path + (e.kind == "list" ? "[]." : "."), level + "#");
      const auto [same, fresh] = known_.emplace(below, e.path);
      text += "\n" + level + " `" + e.path + "`\n" + e.text + "\n\n" +
              (fresh ? below : "This section has the same keys as `" + same->second + "`.\n");
    }
    return text;
  }

 private:
  std::string row(const Entry& e, const std::string& prefix) const {
    const std::string value = heading(e) ? (e.kind == "list" ? "list of maps, below" : "map, below") : escaped(e.kind);
    const std::string by_default = e.value.empty() ? " | " : " | `" + e.value + "`";
    return "| `" + e.path.substr(prefix.size()) + "` | " + value + (defaults_ ? by_default : "") + " | " + e.unit +
           " | " + escaped(e.text) + " |\n";
  }

  const std::vector<Entry>& entries_;
  bool defaults_;
  std::map<std::string, std::string> known_;  ///< what a chapter has below its heading -> its path
};

}  // namespace

const std::vector<Entry>& reference() {
  static const std::vector<Entry> entries = [] {
    KeyCollector<RequestColumns> collector;
    Request defaults;
    visit(collector, defaults);
    return collector.entries;
  }();
  return entries;
}

std::string key_chapters(const std::vector<Entry>& entries, bool defaults) {
  return ChapterWriter(entries, defaults).chapter("", "##");
}

}  // namespace config

namespace {

constexpr const char* request_head = R"head(# The request

<!-- Made by `bin_scenes reference > docs/use/request.md` from src/scene/keys.hpp and src/sensor; a test compares. -->

This page lists all keys of a request. A request is a YAML file that describes the bin, the parts, the pour, the
solver and the sensors. The command `bin_scenes generate` and the parameter `request` of the ROS node read this
file. For example, this request pours 60 bolts into a box and takes a depth image of them:

```yaml
seed: 7
bin: {inner_size: [0.40, 0.30, 0.20], friction: 0.5}   # or {mesh: path.stl}, {floor: true}, {none: true}
parts:
  - {model: bolt.stl, unit: mm, count: 60, density: 7850}
sensors:
  - {name: camera, width: 640, height: 480}
```

All values are in SI units unless the table states another unit. The z axis points up, and the components of a
quaternion are ordered x y z w. Only the key `parts`, with a `model` in each of its entries, is required. An unknown
key, a key that is given twice, or a value of the wrong type is an error that states the file and the line.

## Options of the command line

`--set path=value` overrides a key by its path, for example `--set solver.type=bullet`, `--set parts[0].count=20` or
`--set 'bin.inner_size=[0.6, 0.4, 0.3]'`. The options `--seed`, `--scenes`, `--first`, `--solver` and `--seconds` of
`bin_scenes generate` override the keys of the same name; `--solver` overrides `solver.type`.

`--seconds T` simulates exactly T seconds. The last time step is shortened if necessary.

`--trace FILE` records the motion of the parts. Samples are recorded at the start, at the time steps nearest to
multiples of 1 / `--trace-rate` (in Hz of simulated time; the default is 100), and at the end. The extension of the
file determines its content:

- `--trace FILE.csv` writes one row for each part and sample, with the columns
  `time,id,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz`: the pose of the model frame and the velocity of the centre of mass, in
  the bin frame.
- `--trace FILE.bag` and `--trace FILE.mcap` write the poses as messages on the topic `/tf`, the parts as markers that
  follow them, and the contacts of each sample on the topic `/contacts`. RViz shows the bag with `rosbag play --clock`,
  and Foxglove opens both files.
- `--trace FILE.jsonl` writes poses and contacts for the time slider of `bin_scenes view SCENE --trace FILE.jsonl`.

The colour of a contact point shows the action of the contact: green points rest, yellow points slide, and magenta
points are pushed apart because the overlap exceeds 0.1 % of the diagonal of the smaller part. Red points had an impact
since the previous sample.

## Keys

The column *value* states the type and the range of a value. A square bracket includes the limit in the range, and a
round bracket excludes it. If the column *default* is empty, the column *meaning* states what happens without the key
wherever this is not obvious.

)head";

}  // namespace

std::string request_reference() {
  return request_head + config::key_chapters(config::reference(), true);
}

}  // namespace bin_scenes
