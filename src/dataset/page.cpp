#include "dataset/page.hpp"

#include "core/read_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace bin_scenes {

namespace fs = std::filesystem;

std::string base64(const Bytes& bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    unsigned value = 0;
    for (std::size_t k = 0; k < 3; ++k) value = value << 8 | (k < n ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? letters[value >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

std::string three_js() {
  const char* set = std::getenv("BIN_SCENES_THREE");
  const fs::path folder = set && *set ? set : "/usr/share/javascript/three";
  std::string text;
  for (const char* file : {"build/three.min.js", "examples/js/controls/OrbitControls.js"}) {
    std::error_code missing;
    if (!fs::is_regular_file(folder / file, missing)) return "";
    text += read_file((folder / file).string()) + "\n";
  }
  return text;
}

std::string for_script(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) text.insert(at + 1, "\\");
  return text;
}

void put(std::string& page, const std::string& mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  page.replace(at, mark.size(), text);
}

}  // namespace bin_scenes
