#include "part_cache.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>

namespace bin_scenes {
namespace {

/// Formats whose geometry is in the one file: only for them do the file's bytes say what the mesh is.
bool self_contained(const std::string& extension) {
  for (const char* known : {"stl", "obj", "ply", "dae", "off", "step", "stp", "iges", "igs"}) {
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

/// Everything the loaded mesh depends on.
std::string load_key(const ModelFile& file, const std::string& extension, const LoadOptions& o) {
  return file.sha256 + " " + extension + " " + (o.unit ? name_of(*o.unit) : "own") + " " + key_text(o.scale) +
         key_text(o.weld) + key_text(o.max_hole) + (o.thickness ? key_text(*o.thickness) : "solid ") +
         (o.require_closed ? "closed " : "open ") + (o.tessellation.chord ? key_text(*o.tessellation.chord) : "own ") +
         key_text(o.tessellation.angle) + o.solid;
}

}  // namespace

std::shared_ptr<const PartModel> PartModel::load(const std::string& path, const LoadOptions& options) {
  const ModelFile file = read_model_file(path);
  const std::string extension = extension_of(path);
  if (!self_contained(extension)) {
    ++PartWorkCounter::built;
    return make(load_mesh(file, options), path);
  }
  const std::string key = load_key(file, extension, options);
  // Two lines of a request that name the same file share its proxies as long as anyone holds the part.
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const PartModel>> loaded;
  const std::lock_guard<std::mutex> lock(mutex);
  std::weak_ptr<const PartModel>& known = loaded[path + "\n" + key];
  if (const auto part = known.lock()) return part;
  const auto part = make(cached<LoadedMesh>("mesh", key, [&] { return load_mesh(file, options); }), path);
  known = part;
  return part;
}

}  // namespace bin_scenes
