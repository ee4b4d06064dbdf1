/// Building blocks of self-contained HTML pages: pages that open from the disk and load nothing from a network. `view`,
/// `report` and `audit` use them.
#pragma once

#include "bin_scenes/core/types.hpp"
#include "output/png.hpp"

#include <nlohmann/json.hpp>

#include <cstring>
#include <string>

namespace bin_scenes {

/// Returns a text with the characters escaped that have a meaning in HTML and SVG.
std::string escaped(const std::string& text);
/// Returns a number with that many significant digits, as printf("%.*g") formats it.
std::string short_number(double value, int digits);

/// Returns a colour (red, green, blue; 0 to 1) as CSS writes it: "#rrggbb".
std::string css_colour(const Vec3& colour);

/// Returns bytes as base64 text.
std::string base64(const Bytes& bytes);
/// Returns numbers in the form from which the scripts of a page make typed arrays: little-endian bytes as base64 text.
template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  Bytes bytes(numbers.size() * sizeof(Number));
  if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return base64(bytes);
}

/// Returns the scripts of three.js and its orbit control, to be embedded in a page; empty if Debian's package
/// libjs-three is not installed.
std::string three_js();

/// Returns a page in which the script library and the data (JSON) have replaced the marks /*THREE*/ and /*DATA*/null of
/// the template.
std::string filled_page(std::string page, const std::string& library, const std::string& json);
/// Replaces the first occurrence of `mark` in a page.
void put(std::string& page, const std::string& mark, const std::string& text);

}  // namespace bin_scenes
