/// Draws the request of one heap from a plan: each key with a distribution gets a value that depends only on the plan's
/// seed, the key and the index of the heap. The rest of the request is that of the plan.
#include "config/plan_state.hpp"
#include "config/plan_surfaces.hpp"
#include "config/read_document.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace config {

YAML::Node own_value(const YAML::Node& root, const std::string& path) {
  std::vector<std::string> words(1);
  for (const char c : path) {
    if (c == '.' || c == '[')
      words.emplace_back();
    else if (c != ']')
      words.back() += c;
  }
  const YAML::Node none(YAML::NodeType::Undefined);
  YAML::Node node;
  node.reset(root);
  for (const std::string& word : words) {
    const bool index = !word.empty() && word.size() < 9 && word.find_first_not_of("0123456789") == std::string::npos;
    if (node.IsMap()) {
      const YAML::Node next = static_cast<const YAML::Node&>(node)[word];
      if (!next) return none;
      node.reset(next);
    } else if (node.IsSequence() && index && std::stoul(word) < node.size()) {
      node.reset(node[std::stoul(word)]);
    } else {
      return none;
    }
  }
  return node;
}

}  // namespace config

namespace {

constexpr std::size_t most_parts = 1'000'000;

/// Attempts after the first have seeds of their own: they draw and pour something else.
std::uint64_t seed_of(std::uint64_t seed, std::size_t attempt) {
  return attempt == 0 ? seed : Random(seed, attempt, Stream::plan).next();
}

/// Puts `total` parts, or as many as fill the volume, into the lines by their shares; a line without parts goes.
void set_counts(Request& request, const config::Amount& amount, Random& random, const Plan::VolumeOf& volume_of) {
  std::vector<std::size_t> counts(request.parts.size(), 0);
  std::vector<double> shares = amount.shares;
  shares.resize(request.parts.size(), 0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (request.parts[i].stays() || request.parts[i].distractor)
      shares[i] = 0.0, counts[i] = request.parts[i].count;
    else if (amount.shares.empty())
      shares[i] = 1.0;
    sum += shares[i];
  }
  const auto any_line = [&] {
    double left = random.uniform() * sum;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      if (left < shares[i]) return i;
      left -= shares[i];
    }
    return shares.size() - 1;
  };
  if (!(sum > 0.0)) return;
  if (amount.parts) {
    const auto total = static_cast<std::size_t>(std::llround(std::max(1.0, amount.parts->number(random))));
    for (std::size_t n = 0; n < total; ++n) ++counts[any_line()];
  } else {
    if (request.bin.kind != Bin::Kind::box)
      throw input_error("only a box has an inner volume to fill", "amount.fill", "give amount.parts instead");
    double left = amount.fill->number(random) * request.bin.inner_size.prod();
    do {
      const std::size_t line = any_line();
      left -= volume_of(request.parts[line]);
      if (++counts[line] > most_parts)
        throw input_error("takes more than " + std::to_string(most_parts) + " parts", "amount.fill", "fill less");
    } while (left > 0.0);
  }
  std::vector<PartLine> lines;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    lines.push_back(request.parts[i]);
    lines.back().count = counts[i];
  }
  request.parts = lines;
}

}  // namespace

bool Plan::wants(const std::string& format) const {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

bool Plan::wants_gray() const {
  return wants("shards") || std::any_of(formats.begin(), formats.end(), [](const std::string& name) {
           const SceneFormat* const format = find_scene_format(name);
           return format && format->gray;
         });
}

Request Plan::request(std::size_t heap, std::size_t attempt, const VolumeOf& volume_of) const {
  const Random stream(seed_of(seed, attempt), heap, Stream::plan);
  const auto drawn = [&](std::size_t kind) {  // of surfaces; all other keys are the same in every kind
    std::vector<Override> overrides;
    for (std::size_t i = 0; i < state->draws.size(); ++i) {
      const config::Draw& draw = state->draws[i];
      const bool anew = kind > 0 && config::is_of_surface(draw.path);
      Random random = stream.of_piece(anew ? 3'000'000 + 1000 * i + kind : i);
      overrides.emplace_back(
          draw.path + "=" + draw.distribution.draw(random, config::own_value(state->request, draw.path)), draw.where);
    }
    return config::read_document(YAML::Clone(state->request), state->file, state->base, overrides, PathRules());
  };
  Request request = drawn(0);
  request.seed = seed_of(seed, attempt);
  request.first = heap * (depletion.steps + 1);
  config::Amount amount = state->amount;
  config::split_surfaces(request, amount, state->draws, state->surfaces, drawn);
  if (amount.parts || amount.fill) {
    Random random = stream.of_piece(1'000'000);
    set_counts(request, amount, random, volume_of);
    check(request);
  }
  request.text_sha256 = request_hash(request);
  return request;
}

std::size_t Plan::take(std::size_t heap, std::size_t attempt, std::size_t step) const {
  Random random = Random(seed_of(seed, attempt), heap, Stream::plan).of_piece(2'000'000 + step);
  return static_cast<std::size_t>(std::llround(std::max(0.0, state->take->number(random))));
}

bool is_of(const PlanObject& object, const PartLine& line) {
  return object.sha256 == line.sha256 && object.unit == line.unit && object.scale == line.scale &&
         object.thickness == line.thickness && object.tessellation.chord == line.tessellation.chord &&
         object.tessellation.angle == line.tessellation.angle && object.solid == line.solid;
}

}  // namespace bin_scenes
