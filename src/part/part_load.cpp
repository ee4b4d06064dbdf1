#include "part_cache.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

namespace bin_scenes {
namespace {

/// Formats whose geometry is in the one file: only for them do the file's bytes say what the mesh is.
bool self_contained(const std::string& extension) {
  for (const char* known : {"stl", "obj", "ply", "dae", "off"}) {
    if (extension == known) return true;
  }
  return false;
}

std::string extension_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  std::string extension = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// Of a file's contents; nothing if it is none that load_mesh would read.
std::optional<std::string> digest_of(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return std::nullopt;
  if (std::filesystem::file_size(path, failed) > max_model_file_size || failed) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 18);
  Sha256 digest;
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0) {
    digest.add(piece.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof()) return std::nullopt;
  return digest.hex();
}

/// Everything the loaded mesh depends on; empty if the file cannot be read (load_mesh then says why).
std::string load_key(const std::string& path, const std::string& extension, const LoadOptions& o) {
  const std::optional<std::string> digest = digest_of(path);
  if (!digest) return {};
  return *digest + " " + extension + " " + (o.unit ? name_of(*o.unit) : "own") + " " + key_text(o.scale) +
         key_text(o.weld) + key_text(o.max_hole) + (o.thickness ? key_text(*o.thickness) : "solid ") +
         (o.require_closed ? "closed" : "open");
}

}  // namespace

std::shared_ptr<const PartModel> PartModel::load(const std::string& path, const LoadOptions& options) {
  const std::string extension = extension_of(path);
  const std::string key = self_contained(extension) ? load_key(path, extension, options) : std::string();
  if (key.empty()) {
    ++PartWorkCounter::built;
    return make(load_mesh(path, options), path);
  }
  // Two lines of a request that name the same file share its proxies as long as anyone holds the part.
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const PartModel>> loaded;
  const std::lock_guard<std::mutex> lock(mutex);
  std::weak_ptr<const PartModel>& known = loaded[path + "\n" + key];
  if (const auto part = known.lock()) return part;
  const auto part = make(cached<LoadedMesh>("mesh", key, [&] { return load_mesh(path, options); }), path);
  known = part;
  return part;
}

}  // namespace bin_scenes
