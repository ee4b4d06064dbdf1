/// Reads a trace (output/trace_lines.hpp) and packs it for the page of `view`, which shows the scene at any of its
/// samples. Long traces are thinned to a fixed number of samples.
#pragma once

#include "bin_scenes/config/scene_file.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace bin_scenes {

constexpr std::size_t most_samples = 1000;  ///< of a page; longer traces are thinned evenly

/// Returns the trace as the page reads it. Arrays are packed (page/html.hpp) in row-major order:
///
///     times     [sample], s
///     ids       [part] of the parts in the trace
///     poses     float32 [sample][part][x y z qx qy qz qw], m; NaN while a part is not in the bin
///     counts    number of contacts of each sample
///     contacts  float32 [contact][point, normal, force], bin frame, m and N
///     actions   uint8 [contact], ContactAction; `action_names` names its values
///     pairs     int32 [contact][a, b]; b is -1 for the bin
///     weight    N, of the lightest part
///
/// Throws an input Error if the file is not such a trace, or does not contain the parts of the scene.
nlohmann::ordered_json view_trace(const std::string& path, const SceneFile& scene);

}  // namespace bin_scenes
