#include "bin_scenes/core/sha256.hpp"

#include <openssl/evp.h>

#include <array>

namespace bin_scenes {

std::string sha256_hex(const void* data, std::size_t size) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  EVP_Digest(data, size, digest.data(), &length, EVP_sha256(), nullptr);
  const char* digits = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < length; ++i) {
    text += digits[digest[i] >> 4];
    text += digits[digest[i] & 15];
  }
  return text;
}

std::string sha256_hex(const std::string& text) {
  return sha256_hex(text.data(), text.size());
}

}  // namespace bin_scenes
