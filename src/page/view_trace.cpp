#include "page/view_trace.hpp"

#include "bin_scenes/core/error.hpp"
#include "output/trace_lines.hpp"
#include "page/html.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <set>

namespace bin_scenes {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t pose_numbers = 7, contact_numbers = 9;

[[noreturn]] void refuse(const std::string& what, const std::string& where) {
  throw input_error(what, where, "make it anew with its scene: generate --overwrite --trace FILE.jsonl");
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw input_error("there is no such trace", path, "name a file that generate --trace FILE.jsonl wrote");
    Json first;
    if (!next(first) || !first.is_object() || first.value("format", "") != trace_lines_format)
      refuse("is no trace that bin_scenes wrote as .jsonl", path);
    weight_ = first.at("weight").get<double>();
    for (Json sample; next(sample);) samples_.push_back(std::move(sample));
    if (samples_.empty()) refuse("holds no sample", path);
  }

  double weight() const { return weight_; }
  /// Samples that are shown, at even distances; the first and the last are among them.
  std::vector<const Json*> shown() const {
    std::vector<const Json*> out;
    const std::size_t last = samples_.size() - 1, count = std::min(samples_.size(), most_samples);
    for (std::size_t k = 0; k < count; ++k) out.push_back(&samples_[count == 1 ? 0 : k * last / (count - 1)]);
    return out;
  }

 private:
  bool next(Json& line) {
    std::string text;
    if (!std::getline(file_, text)) return false;
    ++number_;
    line = Json::parse(text, nullptr, false);
    if (line.is_discarded()) refuse("is damaged", path_ + " (line " + std::to_string(number_) + ")");
    return true;
  }

  std::string path_;
  std::ifstream file_;
  std::size_t number_ = 0;
  double weight_ = 1.0;
  std::vector<Json> samples_;
};

/// Appends the numbers of a row from `first` on.
void append(std::vector<float>& to, const Json& row, std::size_t first, std::size_t count) {
  for (std::size_t i = first; i < first + count; ++i) to.push_back(row.at(i).get<float>());
}

Json packed_trace(const Reader& reader, const SceneFile& scene, const std::string& path) {
  const std::vector<const Json*> samples = reader.shown();
  std::map<int, std::size_t> place_of;
  for (const Json* sample : samples)
    for (const Json& row : sample->at("parts")) place_of.emplace(row.at(0).get<int>(), 0);
  Json ids = Json::array();
  for (auto& [id, place] : place_of) place = ids.size(), ids.push_back(id);
  for (const ScenePart& part : scene.parts)
    if (part.pose.finite() && !place_of.count(part.id))
      refuse("is the trace of another scene: it lacks part " + std::to_string(part.id), path);

  std::vector<float> poses(samples.size() * place_of.size() * pose_numbers, std::numeric_limits<float>::quiet_NaN());
  std::vector<float> contacts;
  std::vector<std::uint8_t> actions;
  std::vector<std::int32_t> pairs;
  Json times = Json::array(), counts = Json::array();
  for (std::size_t s = 0; s < samples.size(); ++s) {
    times.push_back(samples[s]->at("time").get<double>());
    for (const Json& row : samples[s]->at("parts")) {
      const std::size_t place = place_of.at(row.at(0).get<int>());
      for (std::size_t i = 0; i < pose_numbers; ++i)
        poses[(s * place_of.size() + place) * pose_numbers + i] = row.at(1 + i).get<float>();
    }
    counts.push_back(samples[s]->at("contacts").size());
    for (const Json& row : samples[s]->at("contacts")) {
      pairs.insert(pairs.end(), {row.at(0).get<std::int32_t>(), row.at(1).get<std::int32_t>()});
      append(contacts, row, 2, contact_numbers);
      actions.push_back(row.at(2 + contact_numbers).get<std::uint8_t>());
    }
  }
  Json names = Json::array();
  for (const auto action :
       {ContactAction::resting, ContactAction::sliding, ContactAction::pushed_apart, ContactAction::impact})
    names.push_back(name_of(action));
  return {{"times", times},
          {"ids", ids},
          {"poses", packed(poses)},
          {"counts", counts},
          {"contacts", packed(contacts)},
          {"actions", packed(actions)},
          {"action_names", names},
          {"pairs", packed(pairs)},
          {"weight", reader.weight()}};
}

}  // namespace

Json view_trace(const std::string& path, const SceneFile& scene) {
  try {
    return packed_trace(Reader(path), scene, path);
  } catch (const Json::exception& error) {
    refuse(std::string("is no trace that bin_scenes wrote: ") + error.what(), path);
  }
}

}  // namespace bin_scenes
