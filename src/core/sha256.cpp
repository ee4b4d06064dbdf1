#include "bin_scenes/core/sha256.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <openssl/evp.h>

#include <array>

namespace bin_scenes {

struct Sha256::Context {
  EVP_MD_CTX* evp = EVP_MD_CTX_new();
  ~Context() { EVP_MD_CTX_free(evp); }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  EVP_DigestInit_ex(context_->evp, EVP_sha256(), nullptr);
}
Sha256::~Sha256() = default;

Sha256& Sha256::add(const void* data, std::size_t size) {
  EVP_DigestUpdate(context_->evp, data, size);
  return *this;
}

std::string Sha256::hex() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  EVP_DigestFinal_ex(context_->evp, digest.data(), &length);
  BIN_SCENES_ASSERT(length == 32);
  const char* digits = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < length; ++i) {
    text += digits[digest[i] >> 4];
    text += digits[digest[i] & 15];
  }
  return text;
}

std::string sha256_hex(const void* data, std::size_t size) {
  return Sha256().add(data, size).hex();
}

std::string sha256_hex(const std::string& text) {
  return sha256_hex(text.data(), text.size());
}

}  // namespace bin_scenes
