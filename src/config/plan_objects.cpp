#include "config/plan_objects.hpp"

#include "config/read_document.hpp"
#include "config/suggest.hpp"
#include "config/values.hpp"

#include <algorithm>
#include <filesystem>

namespace bin_scenes::config {

namespace {

void read_symmetries(const YAML::Node& given, PlanObject& object) {
  object.continuous.emplace();
  object.discrete.emplace();
  for (const auto& item : given) {
    const std::string name = item.first.Scalar();
    for (const YAML::Node& value : item.second) {
      std::vector<double> v;
      read_value(value, v);
      if (name == "continuous" && v.size() == 3)
        object.continuous->push_back(Vec3(v[0], v[1], v[2]).normalized());
      else if (name == "discrete" && v.size() == 4)
        object.discrete->push_back(Quat(v[3], v[0], v[1], v[2]).normalized());
      else
        throw Mismatch{"continuous: [[x, y, z], ...] and discrete: [[qx, qy, qz, qw], ...]"};
    }
  }
}

}  // namespace

void PlanObjects::add(const Request& request, const Complain& complain) {
  digests += request.bin.mesh_sha256 + digests_of_pictures(request);
  for (const PartLine& line : request.parts) {
    if (line.distractor) {
      digests += line.sha256;
      continue;
    }
    const auto same = [&](const PlanObject& object) { return is_of(object, line); };
    if (std::any_of(all.begin(), all.end(), same)) continue;
    PlanObject object;
    object.model = line.model;
    object.path = line.path;
    object.sha256 = line.sha256;
    object.unit = line.unit;
    object.scale = line.scale;
    object.thickness = line.thickness;
    object.tessellation = line.tessellation;
    object.solid = line.solid;
    try {
      const YAML::Node& given = symmetries;  // read alone: a node that is not there stays so
      if (given.IsMap() && given[object.model]) read_symmetries(given[object.model], object);
    } catch (const Mismatch& mismatch) {
      complain("of '" + object.model + "': expected " + mismatch.expected, "in the model's frame");
    }
    all.push_back(object);
    digests += line.sha256;
  }
}

void PlanObjects::check_names(const Complain& complain) const {
  if (!symmetries.IsDefined() || symmetries.IsNull()) return;
  if (!symmetries.IsMap())
    return complain("expected a map by model", "for instance {cup.stl: {continuous: [[0, 0, 1]]}}");
  std::vector<std::string> models;
  for (const PlanObject& object : all) models.push_back(object.model);
  for (const auto& item : symmetries) {
    const std::string name = item.first.Scalar();
    if (std::find(models.begin(), models.end(), name) != models.end()) continue;
    const auto same_file = std::find_if(models.begin(), models.end(), [&](const std::string& model) {
      return std::filesystem::path(model).filename() == std::filesystem::path(name).filename();
    });
    const std::string meant = same_file != models.end() ? *same_file : nearest(name, models);
    complain("'" + name + "' is no model of the plan",
             meant.empty() ? "write it as the request does" : "did you mean '" + meant + "'?");
  }
}

}  // namespace bin_scenes::config
