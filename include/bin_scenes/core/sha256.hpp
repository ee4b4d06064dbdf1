/// SHA-256 (FIPS 180-4): names contents in the part cache, in load reports and in scene.json.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace bin_scenes {

/// Digest of contents given in several pieces.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256& add(const void* data, std::size_t size);
  /// Digest of all that was added, as 64 lower-case hex digits. Nothing can be added after it.
  std::string hex();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Digest of `size` bytes as 64 lower-case hex digits.
std::string sha256_hex(const void* data, std::size_t size);
std::string sha256_hex(const std::string& text);

}  // namespace bin_scenes
