#include "bin_scenes/core/types.hpp"
#include "core/read_file.hpp"
#include "dataset/verify.hpp"
#include "output/bop_image.hpp"
#include "output/evaluation_mesh.hpp"

#include <array>
#include <cstring>

namespace bin_scenes {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

/// Vertices of the binary PLY files that this project writes: three floats each, first in the file's data.
std::vector<std::array<double, 3>> read_vertices(const std::string& path) {
  const std::string bytes = read_file(path), end = "end_header\n", element = "element vertex ";
  const std::size_t count_at = bytes.find(element), data = bytes.find(end);
  std::vector<std::array<double, 3>> vertices;
  if (count_at == std::string::npos || data == std::string::npos) return vertices;
  const std::size_t count = std::stoul(bytes.substr(count_at + element.size(), 12));
  const char* at = bytes.data() + data + end.size();
  if (data + end.size() + count * 12 > bytes.size()) return vertices;
  for (std::size_t i = 0; i < count; ++i, at += 12) {
    float v[3];
    std::memcpy(v, at, sizeof v);
    vertices.push_back({static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
  }
  return vertices;
}

struct Bounds3 {
  Vec3 lower = Vec3::Constant(1e300), upper = Vec3::Constant(-1e300);
  explicit Bounds3(const std::vector<std::array<double, 3>>& vertices) {
    for (const auto& v : vertices) {
      lower = lower.cwiseMin(Vec3(v[0], v[1], v[2]));
      upper = upper.cwiseMax(Vec3(v[0], v[1], v[2]));
    }
  }
};

bool info_fits(const Json& model, const std::vector<std::array<double, 3>>& vertices) {
  const Bounds3 bounds(vertices);
  const Vec3 size = bounds.upper - bounds.lower;
  const double diameter = model.value("diameter", 0.0);
  bool good = !vertices.empty() && diameter >= size.maxCoeff() * 0.999 && diameter <= size.norm() * 1.001 &&
              std::abs(model.value("size_x", 0.0) - size.x()) < 1e-3 * diameter &&
              std::abs(model.value("min_z", 0.0) - bounds.lower.z()) < 1e-3 * diameter;
  for (const Json& symmetry : model.value("symmetries_discrete", Json::array())) {
    Mat3 turn;
    for (int i = 0; i < 9; ++i) turn(i / 3, i % 3) = symmetry.at(static_cast<std::size_t>(4 * (i / 3) + i % 3));
    good &= (turn * turn.transpose() - Mat3::Identity()).norm() < 1e-6;
  }
  return good;
}

std::string model_path(const fs::path& models, const std::string& id) {
  return (models / ("obj_" + six_digits(std::stoul(id)) + ".ply")).string();
}

/// models_eval: the same objects, as large, with the same models_info.json.
void verify_evaluation_models(const fs::path& folder, const Json& info, const std::map<int, BopModel>& models,
                              Findings& findings) {
  const auto own = json_map_in(folder / "models_info.json");
  findings.expect(own == info, "model_eval", folder.string(), "models_info.json is not that of models");
  verify_files(folder, findings);
  for (const auto& [id, model] : models) {
    const std::string path = model_path(folder, std::to_string(id));
    const Bounds3 whole(model.vertices), resampled(fs::exists(path) ? read_vertices(path) : decltype(model.vertices)());
    const double size = (whole.upper - whole.lower).norm();
    findings.expect((whole.lower - resampled.lower).norm() < evaluation_spacing * size &&
                        (whole.upper - resampled.upper).norm() < evaluation_spacing * size,
                    "model_eval", path, "is missing, or has not the size of the model");
  }
}

}  // namespace

std::map<int, BopModel> verify_models(const DataFolder& folder, Findings& findings) {
  const fs::path models = folder.root / "bop" / "models";
  std::map<int, BopModel> all;
  const auto info = json_map_in(models / "models_info.json");
  if (!findings.expect(info.has_value(), "model_info", models.string(), "models_info.json is missing or damaged"))
    return all;
  verify_files(models, findings);
  for (const auto& [key, model] : info->items()) {
    const std::string path = model_path(models, key);
    const auto vertices = fs::exists(path) ? read_vertices(path) : std::vector<std::array<double, 3>>();
    findings.expect(info_fits(model, vertices), "model_info", path, "models_info does not fit the model");
    all[std::stoi(key)].vertices = vertices;
  }
  verify_evaluation_models(folder.root / "bop" / "models_eval", *info, all, findings);
  return all;
}

}  // namespace bin_scenes
