/// Reads data of COLLADA files that assimp 5.2 does not report, such as unit and up axis, and rewrites files that
/// assimp cannot read.
#pragma once

#include <optional>
#include <string>

namespace bin_scenes::collada {

struct Asset {
  std::optional<double> metres_per_unit;
  std::string up_axis = "Y_UP";  ///< the standard's default
};

/// Unit and up axis of the document.
/// Throws std::runtime_error with the place if it is not well-formed XML, or states a unit that is none.
Asset read_asset(const std::string& document);

/// The document with geometry and scene graph only: no images, materials, effects, lights, cameras or animations,
/// where most of the faults sit that make assimp refuse a file. Nothing of it matters to the shape.
std::string geometry_only(const std::string& document);

}  // namespace bin_scenes::collada
