#include "bin_scenes/core/error.hpp"
#include "bop/evaluation_mesh.hpp"
#include "bop/json_file.hpp"
#include "bop/verify.hpp"
#include "output/ply.hpp"

namespace bin_scenes {

namespace fs = std::filesystem;
using StoredJson = nlohmann::json;

namespace {

/// Vertices of a model (mm); none if its file is missing or damaged.
std::vector<Vec3> vertices_in(const std::string& path) {
  try {
    return read_ply(path).vertices;
  } catch (const Error&) {
    return {};
  }
}

Aabb bounds_of(const std::vector<Vec3>& vertices) {
  Aabb bounds;
  for (const Vec3& v : vertices) bounds.extend(v);
  return bounds;
}

bool info_fits(const StoredJson& model, const std::vector<Vec3>& vertices) {
  const Aabb bounds = bounds_of(vertices);
  const Vec3 size = bounds.size();
  const double diameter = model.value("diameter", 0.0);
  bool good = !vertices.empty() && diameter >= size.maxCoeff() * 0.999 && diameter <= size.norm() * 1.001 &&
              std::abs(model.value("size_x", 0.0) - size.x()) < 1e-3 * diameter &&
              std::abs(model.value("min_z", 0.0) - bounds.lower.z()) < 1e-3 * diameter;
  for (const StoredJson& symmetry : model.value("symmetries_discrete", StoredJson::array())) {
    Mat3 turn;
    for (int i = 0; i < 9; ++i) turn(i / 3, i % 3) = symmetry.at(static_cast<std::size_t>(4 * (i / 3) + i % 3));
    good &= (turn * turn.transpose() - Mat3::Identity()).norm() < 1e-6;
  }
  return good;
}

/// models_eval: the same objects, as large, with the same models_info.json.
void verify_evaluation_models(const fs::path& folder, const StoredJson& info, const std::map<int, BopModel>& models,
                              Findings& findings) {
  const auto own = json_map_in<StoredJson>(bop_models_info(folder));
  findings.expect(own == info, "model_eval", folder.string(), "models_info.json is not that of models");
  for (const auto& [id, model] : models) {
    const std::string path = bop_model_file(folder, static_cast<std::size_t>(id)).string();
    const Aabb whole = bounds_of(model.vertices), resampled = bounds_of(vertices_in(path));
    const double size = whole.size().norm();
    findings.expect((whole.lower - resampled.lower).norm() < evaluation_spacing * size &&
                        (whole.upper - resampled.upper).norm() < evaluation_spacing * size,
                    "model_eval", path, "is missing, or has not the size of the model");
  }
}

}  // namespace

std::map<int, BopModel> verify_models(const BopFolder& folder, Findings& findings) {
  const fs::path models = folder.models();
  std::map<int, BopModel> all;
  const auto info = json_map_in<StoredJson>(bop_models_info(models));
  if (!findings.expect(info.has_value(), "model_info", models.string(), "models_info.json is missing or damaged"))
    return all;
  for (const auto& [key, model] : info->items()) {
    const std::string path = bop_model_file(models, std::stoul(key)).string();
    const std::vector<Vec3> vertices = vertices_in(path);
    findings.expect(info_fits(model, vertices), "model_info", path, "models_info does not fit the model");
    all[std::stoi(key)].vertices = vertices;
  }
  verify_evaluation_models(folder.models_eval(), *info, all, findings);
  return all;
}

}  // namespace bin_scenes
