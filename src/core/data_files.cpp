#include "core/data_files.hpp"

#include "bin_scenes/core/error.hpp"

#include <dlfcn.h>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

/// The shared library that holds this code, or the program.
fs::path library_file() {
  Dl_info info{};
  return dladdr(reinterpret_cast<const void*>(&data_places), &info) && info.dli_fname ? info.dli_fname : "";
}

}  // namespace

std::vector<fs::path> data_places(const fs::path& path) {
  std::vector<fs::path> places = {fs::path(BIN_SCENES_SOURCE_DIR) / path, fs::path(BIN_SCENES_INSTALL_DIR) / path};
  for (const fs::path& file : {fs::path("/proc/self/exe"), library_file()}) {
    std::error_code failed;
    const fs::path folder = fs::canonical(file, failed).parent_path();
    if (failed) continue;
    // The command line lies in bin, the library in lib, the node in lib/bin_scenes; the Python module beside its share
    // in a wheel, else in lib/python3/dist-packages/bin_scenes.
    for (const char* up : {"..", "../..", ".", "../../../.."})
      places.push_back(folder / up / "share/bin_scenes" / path);
  }
  return places;
}

fs::path first_place(const std::vector<fs::path>& places, const std::string& what, const std::string& remedy) {
  std::string tried;
  for (const fs::path& place : places) {
    std::error_code failed;
    if (fs::exists(place, failed)) return place;
    tried += "\n  " + place.string();
  }
  throw environment_error("found in none of these places:" + tried, what, remedy);
}

}  // namespace bin_scenes
