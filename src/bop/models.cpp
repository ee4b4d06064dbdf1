#include "bin_scenes/output/scene_writer.hpp"
#include "bop/evaluation_mesh.hpp"
#include "bop/image.hpp"
#include "bop/layout.hpp"

#include <filesystem>

namespace bin_scenes {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// Entry of models_info.json, mm.
Json model_info(const PartModel& part, const Symmetries& symmetries) {
  const Aabb box = part.mesh().bounds();
  const Vec3 lower = millimetres * box.lower, size = millimetres * box.size();
  Json info = {{"diameter", millimetres * diameter(part.mesh())},
               {"min_x", lower.x()},
               {"min_y", lower.y()},
               {"min_z", lower.z()},
               {"size_x", size.x()},
               {"size_y", size.y()},
               {"size_z", size.z()}};
  for (const Pose& turn : symmetries.discrete) {
    const Mat3 r = turn.orientation.toRotationMatrix();
    const Vec3 t = millimetres * turn.position;
    info["symmetries_discrete"].push_back({r(0, 0), r(0, 1), r(0, 2), t.x(), r(1, 0), r(1, 1), r(1, 2), t.y(), r(2, 0),
                                           r(2, 1), r(2, 2), t.z(), 0.0, 0.0, 0.0, 1.0});
  }
  for (const Symmetries::Axis& axis : symmetries.continuous)
    info["symmetries_continuous"].push_back(
        {{"axis", {axis.direction.x(), axis.direction.y(), axis.direction.z()}}, {"offset", in_mm(axis.point)}});
  return info;
}

}  // namespace

std::string bop_model_info(const PartModel& part, const Symmetries& symmetries) {
  return model_info(part, symmetries).dump();
}

void write_bop_models(const std::string& directory, const std::vector<PartModelPtr>& parts,
                      const std::vector<Symmetries>& given, bool for_evaluation) {
  const fs::path models(directory);
  make_directory(models);
  const std::vector<int> ids = bop_object_ids(parts);
  Json info = Json::object();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string id = std::to_string(ids[i]);
    if (info.contains(id)) continue;
    const std::string path = bop_model_file(models, static_cast<std::size_t>(ids[i])).string();
    const Mesh& mesh = parts[i]->mesh();
    write_ply(path, for_evaluation ? evaluation_mesh(mesh) : mesh, millimetres);
    info[id] = model_info(*parts[i], i < given.size() ? given[i] : find_symmetries(*parts[i]));
  }
  write_text(bop_models_info(models).string(), info.dump(1) + "\n");
}

}  // namespace bin_scenes
