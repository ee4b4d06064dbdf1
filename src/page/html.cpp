#include "page/html.hpp"

#include "core/formatted.hpp"
#include "core/read_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace bin_scenes {

namespace fs = std::filesystem;

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

std::string short_number(double value, int digits) {
  return formatted("%.*g", digits, value);
}

std::string css_colour(const Vec3& colour) {
  const auto level = [](double value) {
    return static_cast<unsigned>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
  };
  return formatted("#%02x%02x%02x", level(colour.x()), level(colour.y()), level(colour.z()));
}

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

std::string filled_page(std::string page, const std::string& library, const std::string& json) {
  std::string data = json;  // nothing in it may end its script element
  for (std::size_t at = 0; (at = data.find("</", at)) != std::string::npos; at += 3) data.insert(at + 1, "\\");
  put(page, "/*THREE*/", library);
  put(page, "/*DATA*/null", data);
  return page;
}

void put(std::string& page, const std::string& mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  page.replace(at, mark.size(), text);
}

}  // namespace bin_scenes
