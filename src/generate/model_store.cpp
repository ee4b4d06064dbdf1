#include "generate/model_store.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "core/formatted.hpp"
#include "generate/bin_walls.hpp"
#include "grasp/finger_boxes.hpp"

#include <algorithm>
#include <filesystem>

namespace bin_scenes {

namespace {

/// Every bit of a number counts: sizes that differ by less than a printed digit are different parts.
std::string text_of(double number) {
  return formatted("%a", number);
}

/// Everything the loaded model depends on. Where the request does not give the digest of the file, its time and size
/// stand for its contents, so that an edited file is read again. (The disk cache below goes by the contents
/// themselves.)
std::string key_of(const std::string& path, const std::string& sha256, const LoadOptions& options) {
  std::string key = path + "|" + (options.unit ? name_of(*options.unit) : "-") + "|" + text_of(options.scale) + "|" +
                    (options.thickness ? text_of(*options.thickness) : "-") +
                    (options.tessellation.chord ? "|" + text_of(*options.tessellation.chord) : "|-") + "|" +
                    text_of(options.tessellation.angle) + "|" + options.solid +
                    (options.require_closed ? "|closed|" : "|open|");
  if (!sha256.empty()) return key + sha256;
  std::error_code ignored;
  key += std::to_string(std::filesystem::file_size(path, ignored)) + "|";
  return key + std::to_string(std::filesystem::last_write_time(path, ignored).time_since_epoch().count());
}

PartModelPtr load_checked(const std::string& path, const std::string& sha256, const LoadOptions& options) {
  PartModelPtr model = PartModel::load(path, options);
  if (!sha256.empty() && model->load_report().content_sha256 != sha256) {
    throw input_error("the file has changed since the request was read", path, "ask again");
  }
  return model;
}

void check_models(const LoadedRequest& loaded) {
  const auto& [request, parts, bin] = loaded;
  BIN_SCENES_ASSERT(parts.size() == request.parts.size() && (bin != nullptr) == (request.bin.kind == Bin::Kind::mesh));
  if (bin) {
    double largest = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (request.parts[i].unit) largest = std::max(largest, parts[i]->diagonal());
    check_plausible_bin(bin->mesh(), request.bin, largest);
    check_bin_walls(*bin, request);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartLine& line = request.parts[i];
    if (line.stays() && line.unit) continue;  // a floor or a machine bed may well be larger than the bin
    const LoadReport& file = parts[i]->load_report();
    const std::optional<Unit> stated = is_cad(file.format) ? std::optional<Unit>(file.unit) : line.unit;
    check_plausible_size(parts[i]->mesh(), request.bin, line.path, stated, bin ? &bin->mesh() : nullptr);
  }
}

}  // namespace

void ModelStore::load(const Request& request) {
  std::map<std::string, PartModelPtr> used;
  const auto get = [&](const std::string& path, const std::string& sha256, const LoadOptions& options) {
    const std::string key = key_of(path, sha256, options);
    PartModelPtr& model = used[key];
    if (!model) {
      const auto known = models_.find(key);
      model = known != models_.end() ? known->second : load_checked(path, sha256, options);
    }
    return model;
  };

  PartModelPtr bin;
  if (request.bin.kind == Bin::Kind::mesh) {
    LoadOptions options;
    options.unit = request.bin.unit;
    options.require_closed = false;
    bin = get(request.bin.mesh, request.bin.mesh_sha256, options);
  }
  std::vector<PartModelPtr> parts;
  for (const PartLine& line : request.parts) {
    parts.push_back(get(line.path, line.sha256, load_options(line)));
  }
  check_models({request, parts, bin});
  Request completed = request;
  for (std::size_t i = 0; i < completed.grippers.size(); ++i) {
    Gripper& gripper = completed.grippers[i];
    if (gripper.finger_mesh.empty() || gripper.type != Gripper::Type::parallel) continue;
    LoadOptions options;
    options.scale = gripper.finger_mesh_scale;
    gripper.finger_boxes = boxes_around(get(gripper.finger_mesh, "", options)->mesh(), gripper,
                                        "grippers[" + std::to_string(i) + "].finger_mesh");
  }
  keep(std::move(used));
  loaded_ = {std::move(completed), std::move(parts), std::move(bin)};
}

void ModelStore::keep(std::map<std::string, PartModelPtr>&& used) {
  std::vector<std::string> order;
  for (const std::string& key : order_)
    if (used.count(key) == 0) order.push_back(key);
  order.erase(order.begin(), order.end() - static_cast<std::ptrdiff_t>(std::min(order.size(), most_unused)));
  for (const std::string& key : order) used.emplace(key, models_.at(key));
  for (const auto& [key, model] : used)
    if (std::find(order.begin(), order.end(), key) == order.end()) order.push_back(key);
  models_ = std::move(used);
  order_ = std::move(order);
  BIN_SCENES_ASSERT(models_.size() == order_.size());
}

}  // namespace bin_scenes
