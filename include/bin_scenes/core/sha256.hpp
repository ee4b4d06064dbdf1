/// SHA-256 digests (FIPS 180-4). A digest identifies contents: of model files in load reports and in scene.json, of
/// prepared shapes in the part cache, and of requests. It protects against mistakes, not against attackers.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace bin_scenes {

/// The digest of contents that are given in several pieces.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256& add(const void* data, std::size_t size);
  /// Returns the digest of all bytes added so far, as 64 lower-case hexadecimal digits. Nothing can be added
  /// afterwards.
  std::string hex();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Returns the digest of `size` bytes, or of a text, as 64 lower-case hexadecimal digits.
std::string sha256_hex(const void* data, std::size_t size);
std::string sha256_hex(const std::string& text);

}  // namespace bin_scenes
