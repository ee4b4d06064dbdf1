/// Vocabulary of the benchmarks: "150 rings in the usual bin, poured by Bullet".
#pragma once

#include "bin_scenes/scene/scene.hpp"

#include <string>

namespace bin_scenes::bench {

/// `count` copies of a part of models/ (steel) in a box, friction 0.5 everywhere. The floor grows with the count from
/// 0.40 x 0.30 m for 150 parts, so that heaps are equally deep.
Request bin_of(const std::string& part, std::size_t count);

/// The solvers as figures name them: "sphere", "bullet", "sphere/thesis".
void choose_solver(Request& request, const std::string& name);

}  // namespace bin_scenes::bench
