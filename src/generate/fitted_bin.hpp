/// Determines what `bin_scenes new` writes into a first request: the unit of the model file, a bin of suitable size for
/// the heap, and a sensor pose that sees this bin.
#pragma once

#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/scene/request.hpp"

#include <optional>
#include <string>

namespace bin_scenes {

struct ChosenUnit {
  std::optional<Unit> unit;  ///< none: the unit that the file states
  double metres = 1.0;       ///< per unit of the file
  std::string reason;        ///< for people
};

/// The unit that --unit gives, the file states, or its size implies: mm or m, if only one of them makes a part of 5 mm
/// to 0.6 m. Throws an input Error that names the units that may be meant.
/// @param file  loaded in metres, or in the unit that it states
ChosenUnit choose_unit(const LoadedMesh& file, std::optional<Unit> given, const std::string& path);

struct FittedBin {
  Vec3 inner_size;     ///< m
  double level = 0.0;  ///< m: mean height of the heap
  double hull = 0.0;   ///< m3: convex hull of one part
  double loose = 0.0;  ///< volume of the heap / that of all hulls
};

/// A box with sides of 4 : 3 in which `count` parts lie about a fifth of its length high, but wide enough for one part
/// in any direction; its rim is above the heap's top.
FittedBin fit_bin(const Mesh& part, std::size_t count);

struct SensorPlace {
  std::optional<double> height;  ///< m above the floor, looking down; none: the default position
  double distance = 0.0;         ///< m from the camera to the floor
  std::string warning;           ///< empty, or what it cannot see
};

/// Returns the default position of the sensor, from which it sees the whole bin, or as much as its range allows.
SensorPlace place_sensor(const Sensor& sensor, const Bin& bin);

}  // namespace bin_scenes
