#include "config/plan_objects.hpp"

#include "config/values.hpp"

#include <algorithm>

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
  digests += request.bin.mesh_sha256;
  for (const PartLine& line : request.parts) {
    const auto same = [&](const PlanObject& object) { return is_of(object, line); };
    if (std::any_of(all.begin(), all.end(), same)) continue;
    PlanObject object{line.model,     line.path,         line.sha256, line.unit, line.scale,
                      line.thickness, line.tessellation, line.solid,  {},        {}};
    try {
      const YAML::Node& given = symmetries;  // read alone: a node that is not there stays so
      if (given.IsMap() && given[object.model]) read_symmetries(given[object.model], object);
    } catch (const Mismatch& mismatch) {
      complain("of '" + object.model + "': expected " + mismatch.expected);
    }
    all.push_back(object);
    digests += line.sha256;
  }
}

}  // namespace bin_scenes::config
