#include "bin_scenes/core/sha256.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

// The examples of FIPS 180-4.
TEST(Sha256, KnownDigests) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, BytesAreBytes) {
  const char zeros[] = {'a', '\0', 'b'};
  EXPECT_EQ(Sha256().add("a", 1).add(nullptr, 0).add("bc", 2).hex(), sha256_hex("abc"));
  EXPECT_EQ(sha256_hex(zeros, 3), sha256_hex(std::string("a\0b", 3)));
  EXPECT_NE(sha256_hex(zeros, 3), sha256_hex("a"));
}

}  // namespace
}  // namespace bin_scenes
