/// Text with numbers, in the formats of printf, for messages in which numbers have a given number of digits.
#pragma once

#include <string>

namespace bin_scenes {

/// Returns the formatted text, of any length.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

}  // namespace bin_scenes
