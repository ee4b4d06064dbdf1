/// The reason codes of the validity image, which state why a pixel has no depth. Users read them in files and messages,
/// so that existing values never change.
#pragma once

#include <cstdint>

namespace bin_scenes {

/// The values are those of the pixels of validity images.
enum class Validity : std::uint8_t {
  valid = 0,
  nothing = 1,      ///< nothing in range
  shadow = 2,       ///< the projector or laser does not reach it
  outside = 3,      ///< outside the field of view of projector or laser
  dark = 4,         ///< too little signal
  saturated = 5,    ///< too much signal
  mixed = 6,        ///< foreground and background are both in the pixel
  decoding = 7,     ///< the decoded value is impossible
  unmatched = 8,    ///< no match in the second image
  outlier = 9,      ///< removed by a filter: too few neighbours have nearly the same depth
  reflection = 10,  ///< removed by a filter: other surfaces had reflected its light
  last = reflection
};

}  // namespace bin_scenes
