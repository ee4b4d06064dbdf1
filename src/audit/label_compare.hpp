/// Compares a mask with the silhouette of the model at its stated pose: overlap and displacement. It works on two
/// images alone and knows neither data sets nor limits, which are in labels.hpp and auditor.hpp.
#pragma once

#include "bop/files.hpp"

#include <Eigen/Core>

#include <optional>

namespace bin_scenes {

/// Returns the intersection over union of two masks. Pixels of one mask that are at most one pixel away from the other
/// count as common, because renderers differ at borders. Returns 1 if both are empty.
double tolerant_iou(const BinaryImage& a, const BinaryImage& b);

/// Returns the shift (px; x right, y down) of `stated` relative to `own`: stated(p) = own(p - shift). Minimises the
/// squared difference of the smoothed images by Gauss-Newton steps (Lucas and Kanade 1981); the error is a few
/// hundredths of a pixel for shapes of some hundred pixels. Pixels of `hidden`, which may be empty, and their
/// neighbours do not count. None if too little of the border is visible to determine both directions, or if no shift
/// within 15 px makes both agree.
std::optional<Eigen::Vector2d> mask_shift(const BinaryImage& own, const BinaryImage& stated, const BinaryImage& hidden);

}  // namespace bin_scenes
