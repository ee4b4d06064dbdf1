/// Computes what BOP states of a part in an image: visible pixels, boxes and visible fraction, by the definitions of
/// bop_toolkit's calc_gt_info. The pixels that show a part are determined either by the true image, or by the stored
/// depth image together with the depth of the part alone.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/raster/lens.hpp"
#include "bop/masks.hpp"

#include <array>
#include <optional>
#include <vector>

namespace bin_scenes {

struct BopVisibility {
  std::array<int, 4> box = {-1, -1, -1, -1};          ///< x, y, last x - first, last y - first of the silhouette
  std::array<int, 4> visible_box = {-1, -1, -1, -1};  ///< the same for the visible pixels
  std::size_t all = 0, valid = 0, visible = 0;  ///< pixels: silhouette (also outside the image), measured, visible
  MaskBox whole_mask, visible_mask;             ///< pixels of the silhouette, and visible pixels
};

/// Returns the visibility of part `id` by the true image: a pixel is visible if it truly shows the part, measured or
/// not. `counts`: stored depth image. `seen_box`: box of the visible pixels of the part.
BopVisibility true_visibility(const RangeImage& image, const std::vector<std::uint16_t>& counts, int id,
                              const PixelBox& seen_box, const Mesh& mesh, const Pose& model_in_camera);

/// Determines the visible pixels of a part: a pixel is visible if the part is no more than `tolerance` (m) behind the
/// measured distance, or if nothing was measured there. Returns none if a part of the mesh is beside or behind the
/// camera.
/// @param distance  measured distance from the camera (m) for each pixel; 0: not measured
std::optional<BopVisibility> bop_visibility(const Mesh& mesh, const Pose& model_in_camera, const Lens& lens,
                                            const std::vector<float>& distance, double tolerance);

/// Converts depth along the optical axis (m) of each pixel to distance from the camera (m).
std::vector<float> distances(const std::vector<float>& depth, const Lens& lens);

}  // namespace bin_scenes
