/// Compares a mask with the silhouette of the model at its stated pose: overlap and displacement. It works on two
/// images alone and knows neither data sets nor limits, which are in labels.hpp and auditor.hpp.
#pragma once

#include "bop/files.hpp"

#include <Eigen/Core>

#include <optional>

namespace bin_scenes {

/// Intersection over union, where pixels of one that are at most one pixel from the other count as common: renderers
/// differ on borders. 1 if both are empty.
double tolerant_iou(const BinaryImage& a, const BinaryImage& b);

/// By how much (px; x right, y down) `stated` has to be moved against `own`: stated(p) = own(p - shift). Least squares
/// of the smoothed images by Gauss-Newton steps (Lucas and Kanade 1981), exact to a few hundredths of a pixel for
/// shapes of some hundred pixels. Pixels where `hidden` is set, and their neighbours, do not count; `hidden` may be
/// empty. None if too little of the border is seen to state both directions, or if no shift within 15 px makes both
/// agree.
std::optional<Eigen::Vector2d> mask_shift(const BinaryImage& own, const BinaryImage& stated, const BinaryImage& hidden);

}  // namespace bin_scenes
