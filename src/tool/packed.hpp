/// Numbers in the form in which the scripts of a page read them as typed arrays: little-endian bytes in base64.
#pragma once

#include "dataset/page.hpp"

#include <cstring>
#include <string>
#include <vector>

namespace bin_scenes {

template <class Number>
std::string packed_array(const std::vector<Number>& numbers) {
  Bytes bytes(numbers.size() * sizeof(Number));
  if (!bytes.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return base64(bytes);
}

}  // namespace bin_scenes
