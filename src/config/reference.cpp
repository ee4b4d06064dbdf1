#include "config/reference.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "config/values.hpp"

#include <type_traits>

namespace bin_scenes {

namespace config {

namespace {

class Collector {
 public:
  template <class Value>
  void field(const Key& key, Value& value) {
    std::string text = text_of(value);
    if (text == "[]" || text == "\"\"" || !key.written) text.clear();
    entries.push_back({prefix_ + key.name, kind_of(value), text, key.unit, key.text});
  }
  template <class Value>
  void field(const Key& key, std::optional<Value>&) {
    entries.push_back({prefix_ + key.name, kind_of(Value{}), "", key.unit, key.text});
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    nested(key, "section", ".", value);
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>&) {
    Struct item;
    nested(key, "list", "[].", item);
  }
  void bin_kind(Bin&, const BinKeys&) {}

  std::vector<Entry> entries;

 private:
  template <class Struct>
  void nested(const Key& key, const char* kind, const char* separator, Struct& value) {
    entries.push_back({prefix_ + key.name, kind, "", key.unit, key.text});
    const std::string outer = prefix_;
    prefix_ += key.name + std::string(separator);
    visit(*this, value);
    prefix_ = outer;
  }

  std::string prefix_;
};

bool heading(const Entry& entry) {
  return entry.kind == "section" || entry.kind == "list";
}

std::string escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

/// Rows of the keys directly below `prefix`, then a chapter for each section among them.
void chapter(const std::string& prefix, const std::string& level, std::string& text) {
  const auto directly_below = [&](const std::string& path) {
    return path.size() > prefix.size() && path.compare(0, prefix.size(), prefix) == 0 &&
           path.find('.', prefix.size()) == std::string::npos;
  };
  text += "| key | value | default | unit | meaning |\n|---|---|---|---|---|\n";
  for (const Entry& e : reference()) {
    if (!directly_below(e.path)) continue;
    const std::string name = e.path.substr(prefix.size());
    const std::string value = heading(e) ? (e.kind == "list" ? "list of maps, below" : "map, below") : escaped(e.kind);
    text += "| `" + name + "` | " + value + " | " + (e.value.empty() ? "" : "`" + e.value + "`") + " | " + e.unit +
            " | " + escaped(e.text) + " |\n";
  }
  for (const Entry& e : reference()) {
    if (!directly_below(e.path) || !heading(e)) continue;
    text += "\n" + level + " `" + e.path + "`: " + e.text + "\n\n";
    chapter(e.path + (e.kind == "list" ? "[]." : "."), level + "#", text);
  }
}

}  // namespace

const std::vector<Entry>& reference() {
  static const std::vector<Entry> entries = [] {
    Collector collector;
    Request defaults;
    visit(collector, defaults);
    return collector.entries;
  }();
  return entries;
}

}  // namespace config

std::string request_reference() {
  std::string text =
      "# The request\n"
      "\n"
      "<!-- Made by `bin_scenes reference > docs/request.md` from the table in src/config/keys.hpp; a test compares. "
      "-->\n"
      "\n"
      "A YAML file, read by `bin_scenes generate` and by the node's `request` parameter. SI units, z up, quaternions\n"
      "x y z w. Everything but `parts` has a default. A key that is unknown, given twice or of the wrong type is an\n"
      "error with file and line; `--set path=value` overrides a key by its path, as in `--set solver.type=bullet`,\n"
      "`--set parts[0].count=20` or `--set 'bin.inner_size=[0.6, 0.4, 0.3]'`.\n"
      "\n"
      "Some options of `bin_scenes generate` stand for keys: `--seed`, `--scenes`, `--first`, `--solver` "
      "(`solver.type`)\n"
      "and `--seconds`. `--seconds T` simulates exactly T seconds, the last step cut short if need be. `--trace "
      "FILE.csv`\n"
      "writes `time,id,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz` of every part in the bin, pose of the model frame and "
      "velocity\n"
      "of the centre of mass, in the bin frame: at the start, at the ends of the steps nearest to multiples of\n"
      "1 / `--trace-rate` (Hz of simulated time, 100 by default, at most once a step), and at the end.\n"
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
  config::chapter("", "##", text);
  return text;
}

}  // namespace bin_scenes
