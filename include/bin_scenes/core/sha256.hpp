/// SHA-256 (FIPS 180-4): names contents in the part cache, in load reports and in scene.json.
#pragma once

#include <cstddef>
#include <string>

namespace bin_scenes {

/// Digest of `size` bytes as 64 lower-case hex digits.
std::string sha256_hex(const void* data, std::size_t size);
std::string sha256_hex(const std::string& text);

}  // namespace bin_scenes
