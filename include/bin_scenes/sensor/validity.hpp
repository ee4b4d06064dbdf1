/// Reason codes of the validity image.
#pragma once

#include <cstdint>

namespace bin_scenes {

/// The values are those of validity images.
enum class Validity : std::uint8_t {
  valid = 0,
  nothing = 1,      ///< nothing in range
  shadow = 2,       ///< no light from projector or laser
  outside = 3,      ///< outside the field of projector or laser
  dark = 4,         ///< too little signal
  saturated = 5,    ///< too much
  mixed = 6,        ///< foreground and background in one pixel
  decoding = 7,     ///< the code that was read is impossible
  unmatched = 8,    ///< no match in the second image
  outlier = 9,      ///< too few neighbours have nearly its depth: removed by the filter
  reflection = 10,  ///< its light was reflected by another surface: removed by the filter
  last = reflection
};

}  // namespace bin_scenes
