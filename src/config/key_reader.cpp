/// Takes the keys of a YAML map one after the other and remembers where each stood. What nobody took is an error that
/// suggests the nearest known key.
#include "config/key_reader.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "config/reference.hpp"
#include "config/suggest.hpp"

#include <algorithm>

namespace bin_scenes::config {

namespace {

/// A short list of values as it is written.
std::string shown_list(const YAML::Node& list) {
  constexpr std::size_t shortest = 9;
  std::string text;
  for (const YAML::Node& item : list) {
    if (!item.IsScalar() || list.size() >= shortest) return "a list of " + std::to_string(list.size());
    text += (text.empty() ? "" : ", ") + item.Scalar();
  }
  return "[" + text + "]";
}

std::string shown(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return node.Scalar().empty() ? "an empty text" : "'" + node.Scalar() + "'";
    case YAML::NodeType::Sequence:
      return shown_list(node);
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

/// parts[3].count -> parts[].count, as the table spells it.
std::string without_indices(const std::string& path) {
  std::string text;
  for (const char c : path) {
    if (c < '0' || c > '9' || text.empty() || (text.back() != '[')) text += c;
  }
  return text;
}

/// The key that may be meant: the same name elsewhere in the table first, then the nearest beside it, then anywhere.
std::string suggestion(const std::string& path, const std::string& name, const std::vector<std::string>& beside) {
  const std::string close = nearest(name, beside);
  if (!close.empty() && edit_distance(name, close) <= 1) return close;
  std::vector<std::string> all;
  for (const Entry& entry : reference()) {
    const std::size_t dot = entry.path.rfind('.');
    if (entry.path.substr(dot == std::string::npos ? 0 : dot + 1) == name) return entry.path;
    all.push_back(entry.path);
  }
  return close.empty() ? nearest(without_indices(path), all) : close;
}

}  // namespace

void Source::remember(const std::string& path, const YAML::Node& node) {
  if (!node.Mark().is_null()) lines_[path] = node.Mark().line + 1;
}

std::string Source::where(std::string path) const {
  while (true) {
    if (const auto set = overrides_.find(path); set != overrides_.end()) return set->second;
    const auto line = lines_.find(path);
    if (line != lines_.end()) {
      // A value inside an overridden one has the line of the override's text, which is no line of the file.
      for (std::string outer = path; !outer.empty();) {
        const std::size_t cut = outer.find_last_of(".[");
        outer.resize(cut == std::string::npos ? 0 : cut);
        if (const auto set = overrides_.find(outer); set != overrides_.end()) return set->second;
      }
      return file_ + ":" + std::to_string(line->second);
    }
    if (path.empty()) return file_;
    const std::size_t cut = path.find_last_of(".[");
    path.resize(cut == std::string::npos ? 0 : cut);
  }
}

KeyReader::KeyReader(YAML::Node map, std::string path, Source& source)
    : map_(std::move(map)), path_(std::move(path)), source_(source) {
  // yaml-cpp keeps the first of two equal keys and says nothing; a setting that is not read must be reported.
  std::set<std::string> seen;
  for (const auto& item : map_) {
    if (!item.first.IsScalar()) throw wrong_type(path_, "a map whose keys are words", item.first);
    const std::string name = item.first.Scalar();
    source_.remember(path_of(name), item.first);
    if (!seen.insert(name).second) {
      source_.complain(
          input_error("'" + path_of(name) + "' is given twice", source_.where(path_of(name)), "remove one of both"));
    }
  }
}

YAML::Node KeyReader::take(const Key& key) {
  BIN_SCENES_ASSERT(std::find(known_.begin(), known_.end(), key.name) == known_.end());  // a key of a map is taken once
  known_.push_back(key.name);
  const YAML::Node node = static_cast<const YAML::Node&>(map_)[key.name];
  if (node) found_.insert(key.name);
  return node;
}

Error KeyReader::wrong_type(const std::string& path, const std::string& expected, const YAML::Node& node,
                            const std::string& meant) const {
  return input_error(
      (path.empty() ? "the request" : "'" + path + "'") + ": expected " + expected + ", found " + shown(node),
      source_.where(path), meant.empty() ? "see docs/use/request.md" : "did you mean '" + meant + "'?");
}

void KeyReader::bin_kind(Bin& bin, const BinKeys& keys) {
  using Kind = Bin::Kind;
  std::vector<std::pair<const char*, Kind>> chosen;
  if (has("inner_size")) chosen.emplace_back("inner_size", Kind::box);
  if (has("mesh")) chosen.emplace_back("mesh", Kind::mesh);
  if (keys.floor) chosen.emplace_back("floor", Kind::floor);
  if (keys.none) chosen.emplace_back("none", Kind::none);
  if (chosen.size() > 1) {
    source_.complain(
        input_error(std::string("'bin.") + chosen[0].first + "' and 'bin." + chosen[1].first + "' are two kinds of bin",
                    source_.where(path_of(chosen[1].first)), "keep one of inner_size, mesh, floor and none"));
  }
  if (!chosen.empty()) bin.kind = chosen[0].second;
  const auto only = [&](const char* name, Kind kind, const char* owner) {
    if (has(name) && bin.kind != kind) {
      source_.complain(input_error("'bin." + std::string(name) + "' has no meaning for this kind of bin",
                                   source_.where(path_of(name)),
                                   std::string("it belongs to ") + owner + "; remove it"));
    }
  };
  only("wall_thickness", Kind::box, "a box");
  only("unit", Kind::mesh, "bin.mesh");
  only("pose", Kind::mesh, "bin.mesh");
}

void KeyReader::finish() const {
  for (const auto& item : map_) {
    const std::string name = item.first.Scalar();
    if (has(name)) continue;
    const std::string meant = suggestion(path_of(name), name, known_);
    std::string remedy = "did you mean '" + meant + "'?";
    if (meant.empty()) {
      remedy = "known here:";
      for (const std::string& known : known_) remedy += " " + known;
    }
    source_.complain(input_error("unknown key '" + path_of(name) + "'", source_.where(path_of(name)), remedy));
  }
}

}  // namespace bin_scenes::config
