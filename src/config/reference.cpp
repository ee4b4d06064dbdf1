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
      text += "\n" + level + " `" + e.path + "`: " + e.text + "\n\n" +
              (fresh ? below : "The keys of `" + same->second + "`.\n");
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

std::string request_reference() {
  std::string text =
      "# The request\n"
      "\n"
      "<!-- Made by `bin_scenes reference > docs/use/request.md` from src/scene/keys.hpp and src/sensor; a test "
      "compares. -->\n"
      "\n"
      "A request is a YAML file. `bin_scenes generate` reads it, and so does the node's parameter `request`. Units\n"
      "are SI, z points up, quaternions are x y z w. Every key but `parts` has a default. An unknown key, a key\n"
      "given twice or a value of the wrong type is an error that names file and line.\n"
      "\n"
      "`--set path=value` overrides a key by its path: `--set solver.type=bullet`, `--set parts[0].count=20` or\n"
      "`--set 'bin.inner_size=[0.6, 0.4, 0.3]'`. The options `--seed`, `--scenes`, `--first`, `--solver` and\n"
      "`--seconds` of `bin_scenes generate` override the keys of the same name (`--solver` overrides\n"
      "`solver.type`).\n"
      "\n"
      "`--seconds T` simulates exactly T seconds; the last step is cut short if necessary. `--trace FILE.csv`\n"
      "writes one row a part and sample, `time,id,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz`: the pose of the model\n"
      "frame and the velocity of the centre of mass, in the bin frame. Samples are taken at the start, at the\n"
      "steps nearest to multiples of 1 / `--trace-rate` (Hz of simulated time, default 100), and at the end.\n"
      "`--trace FILE.bag` and `--trace FILE.mcap` write the poses as messages on `/tf`, the parts as markers that\n"
      "follow them, and the contacts of each sample on `/contacts`, for `rosbag play --clock` and RViz, or for\n"
      "Foxglove. `--trace FILE.jsonl` writes poses and contacts for the time slider of `bin_scenes view SCENE --trace\n"
      "FILE.jsonl`. The colour of a contact point states what the contact does: green rests, yellow slides, magenta "
      "is\n"
      "pushed apart (an overlap of more than 0.1 % of the diagonal of the smaller part), red is an impact since the\n"
      "previous sample.\n"
      "\n"
      "```yaml\n"
      "seed: 7\n"
      "bin: {inner_size: [0.40, 0.30, 0.20], friction: 0.5}   # or {mesh: path.stl}, {floor: true}, {none: true}\n"
      "parts:\n"
      "  - {model: bolt.stl, unit: mm, count: 60, density: 7850}\n"
      "sensors:\n"
      "  - {name: camera, width: 640, height: 480}\n"
      "```\n"
      "\n"
      "## Keys\n"
      "\n";
  return text + config::key_chapters(config::reference(), true);
}

}  // namespace bin_scenes
