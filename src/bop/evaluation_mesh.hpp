/// Makes the models with which pose errors are computed: their vertices are spread evenly over the surface, and there
/// are no more of them than this requires. BOP expects them in the folder `models_eval`; they are not used for
/// simulation.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

namespace bin_scenes {

/// Largest distance from a point of the surface to a vertex of the evaluation mesh, as a share of the diagonal.
constexpr double evaluation_spacing = 0.06;

/// Returns a mesh made as by remesh_models_for_eval of bop_toolkit: edges are halved until they are short; then the
/// vertices of each grid cell are merged, if possible to a vertex of the model, so that corners are kept.
Mesh evaluation_mesh(const Mesh& mesh);

}  // namespace bin_scenes
