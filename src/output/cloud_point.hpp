/// The binary layout of a point in PCD and PLY files (little-endian): measured values, one byte of validity, the true
/// normal, and the SNR. The writers of cloud.cpp and the readers of clouds share it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace bin_scenes::cloud_point {

struct Measured {
  std::array<float, 3> position, normal;
  float intensity;
  std::uint32_t label;
};
using TrueNormal = std::array<float, 3>;
static_assert(sizeof(Measured) == 32 && sizeof(TrueNormal) == 12, "no padding");

constexpr std::size_t validity_at = sizeof(Measured), true_normal_at = validity_at + 1,
                      snr_at = true_normal_at + sizeof(TrueNormal), bytes = snr_at + sizeof(float);

}  // namespace bin_scenes::cloud_point
