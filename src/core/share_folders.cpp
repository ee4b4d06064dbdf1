#include "core/share_folders.hpp"

#include <dlfcn.h>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

/// The shared library that holds this code, or the program.
fs::path library_file() {
  Dl_info info{};
  return dladdr(reinterpret_cast<const void*>(&share_folders), &info) && info.dli_fname ? info.dli_fname : "";
}

}  // namespace

std::vector<fs::path> share_folders() {
  std::vector<fs::path> folders;
  for (const fs::path& file : {fs::path("/proc/self/exe"), library_file()}) {
    std::error_code failed;
    const fs::path folder = fs::canonical(file, failed).parent_path();
    if (failed) continue;
    // The command line lies in bin, the library in lib, the node in lib/bin_scenes; the Python module beside its share
    // in a wheel, else in lib/python3/dist-packages/bin_scenes.
    for (const char* up : {"..", "../..", ".", "../../../.."}) folders.push_back(folder / up / "share/bin_scenes");
  }
  return folders;
}

}  // namespace bin_scenes
