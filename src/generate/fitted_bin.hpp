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
  double metres = 1.0;       ///< length of one unit of the file (m)
  std::string reason;        ///< explanation for the user
};

/// Returns the unit that --unit gives, that the file states, or that its size implies: mm or m, if only one of them
/// gives a size of 5 mm to 0.6 m. Throws an input Error that names the possible units.
/// @param file  model file, loaded in metres or in the unit that the file states
ChosenUnit choose_unit(const LoadedMesh& file, std::optional<Unit> given, const std::string& path);

struct FittedBin {
  Vec3 inner_size;     ///< inner size of the bin (m)
  double level = 0.0;  ///< mean height of the heap (m)
  double hull = 0.0;   ///< volume of the convex hull of one part (m3)
  double loose = 0.0;  ///< volume of the heap, divided by the volume of all hulls
};

/// Returns a box with sides of 4 : 3 that is wide enough for one part in any direction. The mean height of a heap of
/// `count` parts is at most about a fifth of its length, and its rim is above the top of the heap.
FittedBin fit_bin(const Mesh& part, std::size_t count);

struct SensorPlace {
  std::optional<double> height;  ///< height above the floor (m) of a sensor that looks down; none: the default position
  double distance = 0.0;         ///< distance from the camera to the floor (m)
  std::string warning;           ///< what the sensor cannot see, for the user; empty: nothing
};

/// Returns the default position of the sensor, from which it sees the whole bin, or as much as its range allows.
SensorPlace place_sensor(const Sensor& sensor, const Bin& bin);

}  // namespace bin_scenes
