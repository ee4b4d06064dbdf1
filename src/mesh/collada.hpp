/// Reads data of COLLADA files that assimp 5.2 does not report, such as unit and up axis, and rewrites files that
/// assimp cannot read.
#pragma once

#include <optional>
#include <string>

namespace bin_scenes::collada {

struct Asset {
  std::optional<double> metres_per_unit;
  std::string up_axis = "Y_UP";  ///< axis that points up; the default is that of the standard
};

/// Returns unit and up axis of the document.
/// Throws std::runtime_error with the position if it is not well-formed XML, or if it states an invalid unit.
Asset read_asset(const std::string& document);

/// Returns the document with geometry and scene graph only. Images, materials, effects, lights, cameras and animations
/// do not affect the shape, and contain most of the faults for which assimp refuses a file.
std::string geometry_only(const std::string& document);

}  // namespace bin_scenes::collada
