/// Reads a plan's own keys, then the rest as a request with draws in place of values. The ends of each draw are put
/// into a request and checked, so that a bad one is found before hours of work.
#include "bin_scenes/config/plan.hpp"

#include "bin_scenes/core/sha256.hpp"
#include "config/bop_plan.hpp"
#include "config/plan_misfit.hpp"
#include "config/plan_objects.hpp"
#include "config/plan_state.hpp"
#include "config/read_document.hpp"
#include "config/rigs.hpp"
#include "config/yaml_text.hpp"
#include "core/read_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;
using config::Distribution;

namespace {

using config::own_value;
using Kind = Distribution::Kind;

constexpr double usual_tolerance = 0.0015;   ///< m, of bop.visible: measured
constexpr std::size_t largest_shard = 1000;  ///< images: BOP's limit
constexpr std::size_t most_ends = 64;        ///< of one distribution that are tried on the request

class PlanFile {
 public:
  explicit PlanFile(const std::string& path) : path_(path), source_(path, {}) { source_.collect(&errors_); }

  Plan read() {
    plan_.text = read_file(path_, config::longest_text);
    const YAML::Node root = config::load_yaml(plan_.text, path_);
    if (!root.IsMap()) throw input_error("the plan is not a map of keys", path_, "see docs/use/datasets.md");
    if (!own_value(root, "request") && own_value(root, "parts"))
      throw input_error("this is a request and not a plan of a data set", path_,
                        "write `scenes: N` and `request: FILE` in a plan");
    YAML::Node deciding = YAML::Clone(root);
    deciding.remove("scenes");
    deciding_ = config::flow_text(deciding);
    auto state = std::make_shared<Plan::State>();
    state_ = state.get();
    read_keys(root);
    read_request(own_value(root, "request"));
    read_bop();
    if (errors_.empty()) try_ends();
    if (errors_.empty()) objects_.check_names(symmetries_complaint());
    if (errors_.empty()) check_outputs();
    if (!errors_.empty()) throw PlanErrors(errors_);
    plan_.objects = objects_.all;
    plan_.sha256 = digest();
    plan_.state = state;
    return plan_;
  }

 private:
  void complain(const std::string& problem, const std::string& key, const std::string& remedy) {
    errors_.push_back(input_error("'" + key + "': " + problem, source_.where(key), remedy));
  }

  void read_keys(const YAML::Node& root) {
    config::KeyReader keys(root, "", source_);
    keys.field({"seed", "", ""}, plan_.seed);
    keys.field({"scenes", "", ""}, plan_.heaps);
    keys.field({"attempts", "", ""}, plan_.attempts);
    if (plan_.heaps < 1 || plan_.heaps > 1'000'000'000)
      complain("must be 1 to 1000000000", "scenes", "give the number of heaps");
    if (plan_.attempts < 1 || plan_.attempts > 1000) complain("must be 1 to 1000", "attempts", "the default is 3");
    read_outputs(keys.node({"outputs", "", ""}));
    read_mcap(keys.node({"mcap", "", ""}));
    if (!keys.node({"request", "", ""})) complain("is missing", "request", "give a request, or the path of its file");
    read_draws(keys.node({"draw", "", ""}));
    read_amount(keys.node({"amount", "", ""}));
    keys.field({"surfaces", "", ""}, state_->surfaces);
    if (state_->surfaces < 1 || state_->surfaces > 100) complain("must be 1 to 100", "surfaces", "the default is 1");
    read_depletion(keys.node({"depletion", "", ""}));
    remember_bop(keys.node({"bop", "", ""}));
    keys.field({"not_poured", "", ""}, plan_.most_not_poured);
    if (!(plan_.most_not_poured >= 0.0 && plan_.most_not_poured <= 1.0))
      complain("must be 0 to 1", "not_poured", "give the share of a heap's parts for which the bin may have no room");
    keys.field({"shard_size", "", ""}, plan_.shard_size);
    if (plan_.shard_size < 1 || plan_.shard_size > largest_shard)
      complain("must be 1 to " + std::to_string(largest_shard), "shard_size",
               "give the number of images in a shard, which BOP limits");
    read_split(keys.node({"split", "", ""}));
    keys.finish();
  }

  void read_outputs(const YAML::Node& node) {
    plan_.formats = {"json"};
    if (!node) return;
    if (!node.IsSequence())
      return complain("expected a list", "outputs", "list some of " + format_names("and", {"shards"}));
    plan_.formats.clear();
    for (const YAML::Node& item : node) {
      const std::string name = item.IsScalar() ? item.Scalar() : "";
      if (!find_scene_format(name) && name != "shards")
        complain("unknown output '" + name + "'", "outputs", "use " + format_names("and", {"shards"}));
      plan_.formats.push_back(name);
    }
  }

  void read_mcap(const YAML::Node& node) {
    if (!node) return;
    if (!plan_.wants("mcap"))
      complain("selects the kind of MCAP file, but `outputs` does not contain mcap", "mcap", "add mcap to `outputs`");
    try {
      plan_.mcap = mcap_profile_of(node.IsScalar() ? node.Scalar() : "", source_.where("mcap"));
    } catch (const Error& error) {
      errors_.push_back(error);
    }
  }

  void read_draws(const YAML::Node& node) {
    if (!node || node.IsNull()) return;
    if (!node.IsMap())
      return complain("expected a map from keys of the request to distributions", "draw",
                      "write, for instance, parts[0].friction: {uniform: [0.3, 0.6]}");
    std::set<std::string> seen;
    for (const auto& item : node) {
      const std::string path = item.first.Scalar(), key = "draw." + path;
      source_.remember(key, item.first);
      if (!seen.insert(path).second) complain("is drawn twice", key, "remove one of both");
      if (path == "seed" || path == "scenes" || path == "first")
        complain("is a key of the plan and cannot be drawn", key, "remove it");
      const auto distribution = config::read_distribution(item.second, key, source_);
      if (distribution) state_->draws.push_back({path, source_.where(key), *distribution});
    }
  }

  void read_amount(const YAML::Node& node) {
    if (!node) return;
    if (!node.IsMap() || (!node["parts"] && !node["fill"]))
      return complain("needs parts or fill", "amount", "write, for instance, amount: {parts: {uniform: [20, 60]}}");
    for (const auto& item : node) {
      const std::string name = item.first.Scalar(), key = "amount." + name;
      source_.remember(key, item.first);
      if (name == "parts")
        state_->amount.parts = config::read_number(item.second, key, source_);
      else if (name == "fill")
        state_->amount.fill = config::read_number(item.second, key, source_);
      else if (name == "shares")
        read_shares(item.second);
      else
        complain("is unknown", key, "the keys are parts, fill and shares");
    }
    if (node["parts"] && node["fill"])
      complain("parts and fill both state the number of parts", "amount", "remove one of both");
    check_bounds(state_->amount.parts, "amount.parts", 1, 1e6);
    check_bounds(state_->amount.fill, "amount.fill", 1e-6, 1.0);
  }

  void check_bounds(const std::optional<Distribution>& d, const char* key, double lower, double upper) {
    if (!d) return;
    for (const std::string& end :
         d->kind == Kind::constant ? std::vector<std::string>{config::text_of(d->a)} : d->ends(YAML::Node())) {
      const double value = std::stod(end);
      if (value < lower || value > upper)
        complain(end + " is not within " + config::text_of(lower) + " to " + config::text_of(upper), key,
                 "correct the range, or give min and max");
    }
  }

  void read_shares(const YAML::Node& node) {
    try {
      config::read_value(node, state_->amount.shares);
    } catch (const config::Mismatch& mismatch) {
      return complain("expected " + mismatch.expected, "amount.shares", "give one number for each part line");
    }
    double sum = 0.0;
    for (const double share : state_->amount.shares) {
      if (!(share >= 0.0)) complain("a share is negative", "amount.shares", "give 0 or more");
      sum += share;
    }
    if (!(sum > 0.0)) complain("all shares are 0", "amount.shares", "give at least one above 0");
  }

  void read_depletion(const YAML::Node& node) {
    if (!node) return;
    if (!node.IsMap() || !node["steps"] || !node["take"])
      return complain("needs steps and take", "depletion",
                      "write, for instance, depletion: {steps: 4, take: {uniform: [3, 8]}}");
    for (const auto& item : node) {
      const std::string name = item.first.Scalar(), key = "depletion." + name;
      source_.remember(key, item.first);
      if (name == "take" && item.second.IsMap() && item.second["order"]) {
        read_order(item.second, key);
      } else if (name == "take") {
        state_->take = config::read_number(item.second, key, source_);
      } else if (name == "steps") {
        try {
          config::read_value(item.second, plan_.depletion.steps);
        } catch (const config::Mismatch& mismatch) {
          complain("expected " + mismatch.expected, key,
                   "give the number of scenes of a heap in addition to the first");
        }
      } else {
        complain("is unknown", key, "the keys are steps and take");
      }
    }
    check_bounds(state_->take, "depletion.take", 1, 1e6);  // a step that takes nothing would show a scene twice
    if (plan_.depletion.steps > 100'000)
      complain("must be at most 100000", "depletion.steps", "remove more parts in each step");
  }

  /// take: {order: grasp}: one part at a time.
  void read_order(const YAML::Node& take, const std::string& key) {
    if (take.size() != 1 || !take["order"].IsScalar() || take["order"].Scalar() != "grasp")
      return complain("expected {order: grasp}", key,
                      "or give a distribution of the number of highest parts that are removed in each step");
    plan_.depletion.by_grasp = true;
    state_->take = config::read_number(YAML::Load("1"), key, source_);
  }

  void remember_bop(const YAML::Node& node) {
    if (!node) return;
    bop_.emplace(node);
    if (!node.IsMap()) return;
    for (const auto& item : node) source_.remember("bop." + item.first.Scalar(), item.first);
    if (const YAML::Node symmetries = node["symmetries"]) objects_.symmetries.reset(symmetries);
  }

  /// Behind the request, whose sensors name the folders of BOP's layout.
  void read_bop() {
    const auto complain_of = [&](const std::string& problem, const std::string& key, const std::string& remedy) {
      complain(problem, key.empty() ? "bop" : "bop." + key, remedy);
    };
    const YAML::Node none(YAML::NodeType::Undefined);
    const std::vector<Sensor> sensors = errors_.empty() ? plan_.reference.sensors : std::vector<Sensor>();
    const config::BopPlan bop =
        config::read_bop_plan(bop_.value_or(none), rig_bop_.value_or(none), sensors, complain_of);
    plan_.bop = bop.layout;
    plan_.run_lengths = bop.run_lengths, plan_.most_targets = bop.most_targets;
    if (bop.measured) plan_.tolerance = bop.tolerance.value_or(usual_tolerance);
  }

  void read_split(const YAML::Node& node) {
    if (!node) return;
    const char* const example = "for instance split: {train: 0.8, val: 0.1, test: 0.1}";
    if (!node.IsMap() || node.size() == 0)
      return complain("expected a map of names and shares of heaps", "split", example);
    double sum = 0.0;
    for (const auto& item : node) {
      const std::string name = item.first.Scalar();
      double share = 0.0;
      try {
        config::read_value(item.second, share);
      } catch (const config::Mismatch& mismatch) {
        complain("share of '" + name + "': expected " + mismatch.expected, "split", example);
      }
      if (!(share >= 0.0)) complain("share of '" + name + "' is " + config::text_of(share), "split", "give 0 or more");
      if (name.empty() || name == "models" || name == "models_eval" ||
          name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
        complain("'" + name + "' cannot be the name of a split", "split",
                 "use small letters, digits and _, and not models or models_eval");
      sum += share;
      plan_.split.emplace_back(name, share);
    }
    if (std::abs(sum - 1.0) > 1e-6) complain("shares add up to " + config::text_of(sum) + ", not 1", "split", example);
  }

  /// A request file that `generate` takes serves a plan as well: what the plan decides itself is left out.
  void ignore_plan_keys() {
    for (const char* key : {"seed", "scenes", "first"}) {
      if (!own_value(state_->request, key)) continue;
      state_->request.remove(key);
      plan_.notes.push_back("'" + std::string(key) + "' of " + state_->file + " is ignored: the plan decides it");
    }
  }

  void read_request(const YAML::Node& node) {
    if (!node) return;
    state_->file = path_;
    fs::path base = fs::absolute(path_).parent_path();
    state_->request.reset(node);
    std::vector<Error> found;
    try {
      if (node.IsScalar()) {
        const fs::path file = base / node.Scalar();
        state_->file = file.lexically_normal().string();
        base = file.parent_path();
        state_->request.reset(config::load_yaml(read_file(state_->file, config::longest_text), state_->file));
        ignore_plan_keys();
      }
      if (state_->request.IsMap())
        rig_bop_.emplace(config::put_rig(state_->request, [&](const std::string&) { return state_->file; }));
      state_->base = base.string();
      plan_.reference = config::read_document(state_->request, state_->file, state_->base, {}, {}, &found);
      for (const char* key : {"seed", "scenes", "first"})
        if (own_value(state_->request, key))
          found.push_back(input_error(std::string("'") + key + "' is a key of the plan", state_->file,
                                      "remove it from the request"));
    } catch (const Error& error) {
      found.push_back(error);
    }
    errors_.insert(errors_.end(), found.begin(), found.end());
    if (errors_.empty()) note_objects(plan_.reference);
    const std::vector<double>& shares = state_->amount.shares;
    if (errors_.empty() && !shares.empty() && shares.size() != plan_.reference.parts.size())
      complain("has " + std::to_string(shares.size()) + " numbers for " + std::to_string(plan_.reference.parts.size()) +
                   " part lines",
               "amount.shares", "give one number for each part line");
  }

  /// `amount` sets the counts of all lines but those of obstacles, distractors and parts on the table.
  bool set_by_amount(const std::string& path) const {
    const std::string line = path.substr(0, path.rfind('.'));
    if (path != line + ".count" || line.rfind("parts", 0) != 0) return false;
    const auto says = [&](const char* key) {
      const YAML::Node value = own_value(state_->request, line + key);
      return value && value.Scalar() != "false" && value.Scalar() != "0";
    };
    const bool keeps = says(".fixed") || says(".distractor") || says(".on_table");
    return (state_->amount.parts || state_->amount.fill) && !keeps;
  }

  /// A draw that cannot be right is found here instead of after hours: each end is put into the request alone.
  void try_ends() {
    for (const config::Draw& draw : state_->draws) {
      if (set_by_amount(draw.path))
        complain("amount sets this value as well", "draw." + draw.path, "remove one of both");
      const YAML::Node own = own_value(state_->request, draw.path);
      if (draw.distribution.kind == Kind::times && !own) {
        complain("the request has no value to multiply", "draw." + draw.path, "write the value into the request");
        continue;
      }
      std::vector<std::string> ends = draw.distribution.ends(own);
      const bool of_parts = draw.path.rfind("parts", 0) == 0;  // each may name a model, which needs its number in BOP
      if (ends.size() > most_ends && !of_parts) ends.resize(most_ends);
      for (const std::string& end : ends) {
        std::vector<Error> found;
        try {
          const Request request = config::read_document(YAML::Clone(state_->request), state_->file, state_->base,
                                                        {{draw.path + "=" + end, draw.where}}, {}, &found);
          if (found.empty()) note_objects(request);
          if (const auto why = found.empty() ? config::misfit(plan_, request) : std::nullopt)
            found.push_back(input_error(why->problem(), draw.where, why->remedy()));
        } catch (const Error& error) {
          found.push_back(error);
        }
        if (found.empty()) continue;
        // A map that is no distribution is a value, which a key may or may not take.
        const bool map = draw.distribution.kind == Kind::constant && end[0] == '{';
        errors_.push_back(input_error("'draw." + draw.path + "' with " + end + ": " + found[0].problem(), draw.where,
                                      map ? "use distributions: " + config::known_distributions() : found[0].remedy()));
        break;
      }
    }
  }

  config::PlanObjects::Complain symmetries_complaint() {
    return [&](const std::string& problem, const std::string& remedy) { complain(problem, "bop.symmetries", remedy); };
  }
  void note_objects(const Request& request) { objects_.add(request, symmetries_complaint()); }

  void check_outputs() {
    if (const auto why = config::misfit(plan_, plan_.reference)) complain(why->problem(), "outputs", why->remedy());
    if (plan_.wants("shards") && plan_.shard_size < plan_.reference.sensors.size())
      complain("is less than the number of images of one scene", "shard_size", "give at least the number of sensors");
    if (!plan_.wants("bop") && !plan_.wants("shards")) return;
    config::note_losses(plan_, state_->amount.parts);
    for (const config::Draw& draw : state_->draws) {
      const std::size_t dot = draw.path.rfind('.');
      const std::string name = draw.path.substr(dot == std::string::npos ? 0 : dot + 1);
      if ((name == "scale" || name == "thickness") && draw.distribution.kind != Kind::choice)
        complain("BOP has one file for each model, but here each heap has models of another size", "draw." + draw.path,
                 "draw it by `choice`, or remove bop and shards from `outputs`");
    }
  }

  std::string digest() const {
    const std::string reference = write_request(config::without_places(plan_.reference));
    return sha256_hex(deciding_ + "\n" + reference + "\n" + objects_.digests);
  }

  std::string path_;
  std::string deciding_;  ///< the plan without what a data set may change: how many heaps it has
  config::Source source_;
  std::vector<Error> errors_;
  config::PlanObjects objects_;
  std::optional<YAML::Node> bop_, rig_bop_;  ///< key `bop`, and what the request's rig says of it
  Plan plan_;
  Plan::State* state_ = nullptr;
};

std::string summary_of(const std::vector<Error>& all) {
  return all.size() == 1 ? all[0].problem() : std::to_string(all.size()) + " errors";
}

}  // namespace

PlanErrors::PlanErrors(std::vector<Error> all)
    : Error(ErrorKind::input, summary_of(all), all.at(0).where(), all[0].remedy()), all_(std::move(all)) {}

Plan read_plan(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw input_error("there is no such plan file", path, "check the path");
  return PlanFile(path).read();
}

}  // namespace bin_scenes
