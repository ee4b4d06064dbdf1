/// Building blocks of self-contained HTML pages: pages that open from the disk and load nothing from a network. `view`,
/// `report` and `audit` use them.
#pragma once

#include "output/png.hpp"

#include <nlohmann/json.hpp>

#include <cstring>
#include <string>

namespace bin_scenes {

/// Text between tags.
std::string escaped(const std::string& text);
/// "%.*g".
std::string short_number(double value, int digits);

std::string base64(const Bytes& bytes);
/// Numbers as typed arrays of a page have them: little-endian, base64.
template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  Bytes bytes(numbers.size() * sizeof(Number));
  if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return base64(bytes);
}

/// three.js and its orbit control, for a page to hold; empty where Debian's libjs-three is not installed.
std::string three_js();

/// A page with its script library and data in their places, which are marked in the template.
std::string filled_page(std::string page, const std::string& library, const std::string& json);
/// Replaces the first `mark` of a page.
void put(std::string& page, const std::string& mark, const std::string& text);

}  // namespace bin_scenes
