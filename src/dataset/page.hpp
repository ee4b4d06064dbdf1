/// Building blocks of self-contained HTML pages: pages that open from the disk and load nothing from a network. `view`,
/// `report` and `audit` use them.
#pragma once

#include "output/png.hpp"

#include <string>

namespace bin_scenes {

std::string base64(const Bytes& bytes);

/// three.js and its orbit control, for a page to hold; empty where Debian's libjs-three is not installed.
std::string three_js();

/// Text for a script element: nothing in it may end that.
std::string for_script(std::string text);

/// Replaces the first `mark` of a page.
void put(std::string& page, const std::string& mark, const std::string& text);

}  // namespace bin_scenes
