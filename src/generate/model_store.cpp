#include "generate/model_store.hpp"

#include <algorithm>
#include <filesystem>

namespace bin_scenes {

namespace {

/// Everything the loaded model depends on; time and size of the file stand for its contents, so that an edited file
/// is read again. (The disk cache below goes by the contents themselves.)
std::string key_of(const std::string& path, const LoadOptions& options) {
  std::error_code ignored;
  std::string key = path + "|" + (options.unit ? name_of(*options.unit) : "-") + "|" + std::to_string(options.scale) +
                    "|" + (options.thickness ? std::to_string(*options.thickness) : "-") +
                    (options.require_closed ? "|closed|" : "|open|");
  key += std::to_string(std::filesystem::file_size(path, ignored)) + "|";
  return key + std::to_string(std::filesystem::last_write_time(path, ignored).time_since_epoch().count());
}

void check_sizes(const Request& request, const std::vector<PartModelPtr>& parts, const PartModelPtr& bin) {
  if (bin) {
    double largest = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (request.parts[i].unit) largest = std::max(largest, parts[i]->diagonal());
    check_plausible_bin(bin->mesh(), request.bin, largest);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartLine& line = request.parts[i];
    check_plausible_size(parts[i]->mesh(), request.bin, line.path, line.unit, bin ? &bin->mesh() : nullptr);
  }
}

}  // namespace

void ModelStore::load(const Request& request) {
  std::map<std::string, PartModelPtr> used;
  const auto get = [&](const std::string& path, const LoadOptions& options) {
    const std::string key = key_of(path, options);
    PartModelPtr& model = used[key];
    if (!model) {
      const auto known = models_.find(key);
      model = known != models_.end() ? known->second : PartModel::load(path, options);
    }
    return model;
  };

  PartModelPtr bin;
  if (request.bin.kind == Bin::Kind::mesh) {
    LoadOptions options;
    options.unit = request.bin.unit;
    options.require_closed = false;
    bin = get(request.bin.mesh, options);
  }
  std::vector<PartModelPtr> parts;
  for (const PartLine& line : request.parts) {
    LoadOptions options;
    options.unit = line.unit;
    options.scale = line.scale;
    options.thickness = line.thickness;
    parts.push_back(get(line.path, options));
  }
  check_sizes(request, parts, bin);
  models_ = std::move(used);
  parts_ = std::move(parts);
  bin_ = std::move(bin);
}

}  // namespace bin_scenes
