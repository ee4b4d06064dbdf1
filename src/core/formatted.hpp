/// Text with numbers in it, as printf writes them: for messages that need a number of digits.
#pragma once

#include <string>

namespace bin_scenes {

/// Returns the formatted text, of any length.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

}  // namespace bin_scenes
