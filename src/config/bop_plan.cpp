/// Reads the map `bop` of a plan over the defaults of its rig, and checks that sensors, modalities and splits fit
/// together.
#include "config/bop_plan.hpp"

#include "config/suggest.hpp"
#include "config/values.hpp"

#include <algorithm>
#include <set>

namespace bin_scenes::config {

namespace {

using Names = std::vector<std::string>;

Names sensors_without_views(const std::vector<Sensor>& sensors) {
  Names names;
  for (const Sensor& sensor : sensors) {
    const std::string& name = sensor_of_view(sensor);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Reads one `bop` map over what is there.
class BopReader {
 public:
  using Complain = std::function<void(const std::string& problem, const std::string& key, const std::string& remedy)>;
  BopReader(BopPlan& plan, const std::vector<Sensor>& sensors, const Complain& complain)
      : plan_(plan), sensors_(sensors_without_views(sensors)), complain_(complain) {}

  void read(const YAML::Node& node) {
    if (!node) return;
    if (!node.IsMap()) return complain_("expected a map", "", "bop: {layout: industrial, visible: truth}");
    for (const auto& item : node) {
      const std::string name = item.first.Scalar();
      const YAML::Node value = item.second;
      if (name == "layout")
        choose(value, name, {"classic", "industrial"}, [&](const std::string& text) {
          plan_.layout.kind = text == "classic" ? BopLayout::Kind::classic : BopLayout::Kind::industrial;
        });
      else if (name == "format")
        choose(value, name, {"png", "tif"}, [&](const std::string& text) { plan_.layout.tif = text == "tif"; });
      else if (name == "visible")
        choose(value, name, {"truth", "measured"},
               [&](const std::string& text) { plan_.measured = text == "measured"; });
      else if (name == "masks")
        choose(value, name, {"png", "rle"}, [&](const std::string& text) { plan_.run_lengths = text == "rle"; });
      else if (name == "most_targets")
        read_most_targets(value);
      else if (name == "tolerance")
        read_tolerance(value);
      else if (name == "modalities")
        read_modalities(value);
      else if (name == "evaluate")
        read_evaluated(value);
      else if (name != "symmetries")
        complain_(
            "is unknown", name,
            "the keys are layout, format, modalities, evaluate, visible, tolerance, symmetries, masks, most_targets");
    }
  }

  /// What neither the plan nor a rig says: a grey image and depth of each sensor, evaluated on the first.
  void fill() {
    BopLayout& layout = plan_.layout;
    if (layout.kind == BopLayout::Kind::classic) return;
    std::vector<std::pair<std::string, Names>> all;
    for (const std::string& sensor : sensors_) {
      const auto given = std::find_if(layout.modalities.begin(), layout.modalities.end(),
                                      [&](const auto& item) { return item.first == sensor; });
      all.emplace_back(sensor, given == layout.modalities.end() ? Names{"gray", "depth"} : given->second);
    }
    layout.modalities = all;
    if (all.empty()) return;  // refused elsewhere: BOP shows what sensors see
    if (layout.sensor.empty()) layout.sensor = all.front().first;
    const auto of_sensor =
        std::find_if(all.begin(), all.end(), [&](const auto& item) { return item.first == layout.sensor; });
    if (of_sensor == all.end()) return;  // read_evaluated() has complained
    if (layout.modality.empty()) layout.modality = of_sensor->second.front();
    if (!has(of_sensor->second, layout.modality))
      complain_("sensor '" + layout.sensor + "' has no modality " + layout.modality, "evaluate",
                "name one of its modalities");
  }

 private:
  void choose(const YAML::Node& value, const std::string& key, const Names& known,
              const std::function<void(const std::string&)>& take) {
    const std::string text = value.IsScalar() ? value.Scalar() : "";
    if (has(known, text)) return take(text);
    complain_("expected " + known[0] + " or " + known[1], key, "see docs/use/datasets.md");
  }

  void read_tolerance(const YAML::Node& value) {
    double tolerance = 0.0;
    try {
      read_value(value, tolerance);
    } catch (const Mismatch& mismatch) {
      complain_("expected " + mismatch.expected, "tolerance", "m; bop_toolkit uses 0.005 or 0.015");
    }
    if (!(tolerance > 0.0 && tolerance <= 0.1)) complain_("must be above 0 and at most 0.1 m", "tolerance", "m");
    plan_.tolerance = tolerance;
  }

  void read_most_targets(const YAML::Node& value) {
    try {
      read_value(value, plan_.most_targets);
    } catch (const Mismatch& mismatch) {
      return complain_("expected " + mismatch.expected, "most_targets", "bop_toolkit keeps 100 estimates an image");
    }
    if (plan_.most_targets == 0) complain_("must be at least 1", "most_targets", "remove the key to allow any number");
  }

  bool is_sensor(const std::string& name, const std::string& key) {
    if (sensors_.empty() || has(sensors_, name)) return true;
    const std::string meant = nearest(name, sensors_);
    complain_("the request has no sensor '" + name + "'", key,
              meant.empty() ? "name sensors of the request" : "did you mean '" + meant + "'?");
    return false;
  }

  void read_modalities(const YAML::Node& value) {
    const char* const example = "for instance modalities: {camera: [gray, depth]}";
    if (!value.IsMap()) return complain_("expected lists by sensor", "modalities", example);
    for (const auto& item : value) {
      const std::string sensor = item.first.Scalar(), key = "modalities." + sensor;
      if (!is_sensor(sensor, key)) continue;
      Names names;
      if (item.second.IsSequence())
        for (const YAML::Node& name : item.second) names.push_back(name.IsScalar() ? name.Scalar() : "");
      if (names.empty()) complain_("expected a list", key, example);
      for (const std::string& name : names)
        if (!has({"rgb", "gray", "depth"}, name))
          complain_("modality '" + name + "' is not simulated", key, "of rgb (grey in three channels), gray and depth");
      auto& all = plan_.layout.modalities;
      all.erase(std::remove_if(all.begin(), all.end(), [&](const auto& known) { return known.first == sensor; }),
                all.end());
      all.emplace_back(sensor, names);
    }
  }

  void read_evaluated(const YAML::Node& value) {
    const auto text = [&](const char* key) {
      const YAML::Node node = value.IsMap() ? value[key] : YAML::Node();
      return node && node.IsScalar() ? node.Scalar() : std::string();
    };
    if (text("sensor").empty() || text("modality").empty())
      return complain_("expected a sensor and a modality", "evaluate",
                       "for instance evaluate: {sensor: camera, modality: gray}");
    is_sensor(text("sensor"), "evaluate");
    plan_.layout.sensor = text("sensor");
    plan_.layout.modality = text("modality");
  }

  BopPlan& plan_;
  Names sensors_;
  const Complain& complain_;
};

}  // namespace

BopPlan read_bop_plan(const YAML::Node& own, const YAML::Node& rig, const std::vector<Sensor>& sensors,
                      const std::function<void(const std::string& problem, const std::string& key,
                                               const std::string& remedy)>& complain) {
  BopPlan plan;
  BopReader reader(plan, sensors, complain);
  reader.read(rig);
  const bool rig_has_tolerance = plan.tolerance.has_value();
  reader.read(own);
  const bool own_tolerance = own && own.IsMap() && own["tolerance"];
  if (own_tolerance && !plan.measured)
    complain("has a meaning only where measured depth decides what is visible", "tolerance",
             "add visible: measured, or leave it out");
  if (rig_has_tolerance && !own_tolerance && !plan.measured) plan.tolerance.reset();
  const bool only_industrial = own && own.IsMap() && (own["format"] || own["modalities"] || own["evaluate"]);
  if (only_industrial && plan.layout.kind == BopLayout::Kind::classic)
    complain("format, modalities and evaluate belong to the layout industrial", "layout",
             "add layout: industrial, or leave them out");
  if (plan.layout.kind == BopLayout::Kind::classic) plan.layout = BopLayout();
  reader.fill();
  return plan;
}

}  // namespace bin_scenes::config
