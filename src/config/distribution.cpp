/// One table names the distributions, their arguments and how a value is drawn. Reading, errors and suggestions follow
/// from it.
#include "config/distribution.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "config/suggest.hpp"
#include "config/views.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace bin_scenes::config {

namespace {

using Kind = Distribution::Kind;

const std::vector<std::string> kinds = {"constant", "uniform", "normal", "choice", "times", "jitter", "view"};

constexpr int most_redraws = 100;  ///< of a normal value outside its bounds, which is then moved to the nearer one

std::string line_of(const YAML::Node& node, const std::string& path, Source& source) {
  source.remember(path, node);
  return source.where(path);
}

std::optional<double> number_of(const YAML::Node& node) {
  double value = 0.0;
  try {
    read_value(node, value);
  } catch (const Mismatch&) {
    return std::nullopt;
  }
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

bool is_whole(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  return text.find_first_not_of("+-0123456789") == std::string::npos;
}

/// Reads the keys of one distribution; complains instead of throwing.
class Reader {
 public:
  Reader(const YAML::Node& node, std::string path, Source& source)
      : node_(node), path_(std::move(path)), source_(source), where_(line_of(node, path_, source)) {}

  std::optional<Distribution> read() {
    Distribution d;
    const std::string kind = first_key();
    const std::string meant = nearest(kind, kinds);
    if (meant.empty()) {
      d.values = {flow_text(node_)};
      return d;
    }
    if (meant != kind) {
      complain("unknown distribution '" + kind + "': did you mean '" + meant + "'?", known_distributions());
      return std::nullopt;
    }
    const YAML::Node value = node_[kind];
    if (kind == "constant") d.values = {flow_text(value)};
    if (kind == "uniform" || kind == "normal") read_pair(d, kind, value);
    if (kind == "choice") read_choice(d, value);
    if (kind == "times") {
      d.kind = Kind::times;
      d.factor = part(value, "times");
    }
    if (kind == "jitter") read_jitter(d, value);
    if (kind == "view") read_view(d, value);
    for (const auto& item : node_) {
      const std::string name = item.first.Scalar();
      const bool known = name == kind || (kind == "normal" && (name == "min" || name == "max")) ||
                         (kind == "choice" && name == "weights");
      if (!known) complain("'" + name + "' cannot be combined with '" + kind + "'", "remove it");
    }
    return good_ ? std::optional<Distribution>(d) : std::nullopt;
  }

 private:
  /// The first key decides what a map is: maps of other keys are values. Empty for what is no map.
  std::string first_key() const {
    if (!node_.IsMap() || node_.size() == 0 || !node_.begin()->first.IsScalar()) return "";
    return node_.begin()->first.Scalar();
  }

  void complain(const std::string& problem, const std::string& remedy) {
    good_ = false;
    source_.complain(input_error("'" + path_ + "': " + problem, where_, remedy));
  }

  std::shared_ptr<Distribution> part(const YAML::Node& node, const std::string& name) {
    const auto read = read_number(node, path_ + "." + name, source_);
    if (!read) good_ = false;
    return read ? std::make_shared<Distribution>(*read) : nullptr;
  }

  void read_pair(Distribution& d, const std::string& kind, const YAML::Node& value) {
    d.kind = kind == "uniform" ? Kind::uniform : Kind::normal;
    const bool two = value.IsSequence() && value.size() == 2 && number_of(value[0]) && number_of(value[1]);
    if (!two) {
      complain(kind == "uniform" ? "uniform needs [min, max]" : "normal needs [mean, sigma]",
               "give two numbers in brackets");
      return;
    }
    d.a = *number_of(value[0]);
    d.b = *number_of(value[1]);
    d.whole = d.kind == Kind::uniform && is_whole(value[0]) && is_whole(value[1]);
    if (d.kind == Kind::uniform && d.a > d.b) complain("the minimum is above the maximum", "swap them");
    if (d.kind == Kind::normal && d.b < 0.0) complain("the standard deviation is negative", "give 0 or more");
    for (const char* end : {"min", "max"}) {
      if (!node_[end] || d.kind != Kind::normal) continue;
      const auto bound = number_of(node_[end]);
      if (!bound) complain(std::string(end) + " is not a number", "give a number, or remove this key");
      (std::string(end) == "min" ? d.min : d.max) = bound;
    }
    if (d.min && d.max && *d.min > *d.max) complain("min is above max", "swap them");
  }

  void read_choice(Distribution& d, const YAML::Node& value) {
    d.kind = Kind::choice;
    if (!value.IsSequence() || value.size() == 0) {
      complain("choice needs a list of values", "write, for instance, choice: [0.3, 0.5]");
      return;
    }
    for (const YAML::Node& item : value) d.values.push_back(flow_text(item));
    d.weights.assign(d.values.size(), 1.0);
    const YAML::Node weights = node_["weights"];
    if (!weights) return;
    if (!weights.IsSequence() || weights.size() != d.values.size()) {
      complain("the number of weights differs from the number of values", "give one weight for each value");
      return;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const auto weight = number_of(weights[i]);
      if (!weight || *weight < 0.0) complain("a weight is negative or not a number", "give numbers that are 0 or more");
      sum += d.weights[i] = weight.value_or(0.0);
    }
    if (!(sum > 0.0)) complain("all weights are 0", "give at least one above 0");
  }

  void read_jitter(Distribution& d, const YAML::Node& value) {
    d.kind = Kind::jitter;
    if (!value.IsMap() || !value["pose"]) {
      complain("jitter needs the pose that it changes",
               "write jitter: {pose: [x, y, z, qx, qy, qz, qw], move: m, turn: rad}");
      return;
    }
    for (const auto& item : value) {
      const std::string name = item.first.Scalar();
      try {
        if (name == "pose")
          read_value(item.second, d.pose);
        else if (name == "move")
          read_value(item.second, d.move);
        else if (name == "turn")
          read_value(item.second, d.angle);
        else
          complain("jitter has no key '" + name + "'", "its keys are pose, move and turn");
      } catch (const Mismatch& mismatch) {
        complain(name + ": expected " + mismatch.expected, "see docs/use/datasets.md");
      }
    }
    if (!(d.move >= 0.0) || !(d.angle >= 0.0))
      complain("move and turn must be 0 or more", "give move in m, and turn in rad");
  }

  void read_view(Distribution& d, const YAML::Node& value) {
    d.kind = Kind::view;
    if (!value.IsMap() || !value["distance"]) {
      complain("view needs a distance",
               "write view: {distance: {uniform: [0.8, 1.0]}, tilt: ..., turn: ..., target: [x, y, z]}");
      return;
    }
    for (const auto& item : value) {
      const std::string name = item.first.Scalar();
      if (name == "distance")
        d.distance = part(item.second, name);
      else if (name == "tilt")
        d.tilt = part(item.second, name);
      else if (name == "turn")
        d.turn = part(item.second, name);
      else if (name == "roll")
        d.roll = part(item.second, name);
      else if (name == "target") {
        try {
          read_value(item.second, d.target);
        } catch (const Mismatch& mismatch) {
          complain("target: expected " + mismatch.expected, "give a position (m) in the bin frame");
        }
      } else
        complain("view has no key '" + name + "'", "its keys are distance, tilt, turn, roll and target");
    }
  }

  const YAML::Node node_;
  std::string path_;
  Source& source_;
  std::string where_;
  bool good_ = true;
};

/// `factor` times a number, or times each number of a list.
std::string scaled(const YAML::Node& own, const std::function<double()>& factor) {
  if (own.IsSequence()) {
    std::string text;
    for (const YAML::Node& item : own) text += (text.empty() ? "[" : ", ") + scaled(item, factor);
    return text + "]";
  }
  const auto number = own.IsScalar() ? number_of(own) : std::nullopt;
  return number ? text_of(*number * factor()) : flow_text(own);
}

}  // namespace

std::string known_distributions() {
  std::string text;
  for (const std::string& kind : kinds) text += (text.empty() ? "known are " : ", ") + kind;
  return text;
}

std::string flow_text(const YAML::Node& node) {
  if (node.IsSequence()) {
    std::string text;
    for (const YAML::Node& item : node) text += (text.empty() ? "" : ", ") + flow_text(item);
    return "[" + text + "]";
  }
  if (node.IsMap()) {
    std::string text;
    for (const auto& item : node)
      text += (text.empty() ? "" : ", ") + flow_text(item.first) + ": " + flow_text(item.second);
    return "{" + text + "}";
  }
  if (!node.IsScalar()) return "null";
  const std::string& text = node.Scalar();
  const bool plain = !text.empty() && text.find_first_of(" \t\n,[]{}:#\"'&*!|>%@`") == std::string::npos;
  return plain ? text : text_of(text);
}

double Distribution::number(Random& random) const {
  BIN_SCENES_ASSERT(kind != Kind::uniform || a <= b);
  BIN_SCENES_ASSERT(kind != Kind::normal || (b >= 0.0 && !(min && max && *min > *max)));
  if (kind == Kind::uniform && whole) {
    return a + static_cast<double>(random.below(static_cast<std::uint64_t>(b - a) + 1));
  }
  if (kind == Kind::uniform) return random.uniform(a, b);
  if (kind == Kind::normal) {
    double value = a + b * random.normal();
    const auto outside = [&] { return (min && value < *min) || (max && value > *max); };
    for (int i = 0; i < most_redraws && outside(); ++i) value = a + b * random.normal();
    if (min) value = std::max(value, *min);
    if (max) value = std::min(value, *max);
    return value;
  }
  return a;
}

std::string Distribution::draw(Random& random, const YAML::Node& own) const {
  switch (kind) {
    case Kind::constant:
      return values[0];
    case Kind::uniform:
    case Kind::normal:
      return text_of(number(random));
    case Kind::choice: {
      double sum = 0.0;
      for (const double weight : weights) sum += weight;
      BIN_SCENES_ASSERT(weights.size() == values.size() && sum > 0.0);
      double left = random.uniform() * sum;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (left < weights[i]) return values[i];
        left -= weights[i];
      }
      return values.back();
    }
    case Kind::times:
      return scaled(own, [&] { return factor->number(random); });
    case Kind::jitter: {
      Vec3 offset;
      do {
        for (int i = 0; i < 3; ++i) offset[i] = random.uniform(-1.0, 1.0);
      } while (offset.norm() > 1.0);
      const Vec3 axis = random.orientation() * Vec3::UnitZ();
      Pose moved = pose;
      moved.position += move * offset;
      moved.orientation =
          (Quat(Eigen::AngleAxisd(random.uniform(-angle, angle), axis)) * pose.orientation).normalized();
      BIN_SCENES_ASSERT(is_rigid(moved) && (moved.position - pose.position).norm() <= move * (1.0 + 1e-12));
      return text_of(moved);
    }
    case Kind::view: {
      const double from = distance->number(random);
      const double lean = tilt ? tilt->number(random) : 0.0, around = turn ? turn->number(random) : 0.0;
      return text_of(looking_at(target, from, lean, around, roll ? roll->number(random) : 0.0));
    }
  }
  return values.at(0);
}

std::vector<std::string> Distribution::ends(const YAML::Node& own) const {
  const auto of = [](const Distribution& d) {
    if (d.kind == Kind::uniform) return std::vector<double>{d.a, d.b};
    if (d.kind != Kind::normal) return std::vector<double>{d.a};
    return std::vector<double>{d.min.value_or(d.a - 4.0 * d.b), d.max.value_or(d.a + 4.0 * d.b)};
  };
  std::vector<std::string> texts;
  if (kind == Kind::constant || kind == Kind::choice) return values;
  if (kind == Kind::uniform || kind == Kind::normal) {
    for (const double end : of(*this)) texts.push_back(text_of(end));
  } else if (kind == Kind::times) {
    for (const double end : of(*factor)) texts.push_back(scaled(own, [&] { return end; }));
  } else if (kind == Kind::jitter) {
    texts.push_back(text_of(pose));
  } else {
    for (const double from : of(*distance)) {
      for (const double lean : tilt ? of(*tilt) : std::vector<double>{0.0})
        texts.push_back(text_of(looking_at(target, from, lean, 0.0, 0.0)));
    }
  }
  return texts;
}

std::optional<Distribution> read_distribution(const YAML::Node& node, const std::string& path, Source& source) {
  return Reader(node, path, source).read();
}

std::optional<Distribution> read_number(const YAML::Node& node, const std::string& path, Source& source) {
  auto read = read_distribution(node, path, source);
  if (!read || read->kind == Kind::uniform || read->kind == Kind::normal) return read;
  const auto number = node.IsScalar() ? number_of(node) : std::nullopt;
  if (number) {
    read->a = *number;
    return read;
  }
  source.complain(input_error("'" + path + "': expected a number, uniform or normal", line_of(node, path, source),
                              "write, for instance, {uniform: [0.1, 0.2]}"));
  return std::nullopt;
}

}  // namespace bin_scenes::config
