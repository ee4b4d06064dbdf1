#include "generate/fitted_bin.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/hull_geometry.hpp"
#include "bin_scenes/part/mass_properties.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

// Diagonals (m) of parts that lie in bins: what is believed when it is stated, and what is guessed.
constexpr double least_stated = 0.001, most_stated = 2.0, least_guessed = 0.005, most_guessed = 0.6;

// Of 80 parts of each sample model, poured: a heap is 0.9 to 2.1 times as large as the convex hulls of its parts,
// thirteen models, 1.5 in the centre. A wrong guess of a third changes the bin's sides by a tenth.
constexpr double heap_per_hull = 1.5;
// Of rods: they fill 5.4 / slenderness of a random packing (Philipse 1996, Langmuir 12, 1127).
constexpr double filled_by_rods = 5.4;
// Of sheets, by their width / thickness: plates and discs of 15:1 to 80:1, poured, need 2.5 to 5.2 times their hulls.
constexpr double filled_by_sheets = 8.0;
// Of the diagonal: how high a part stands upon the heap; a rod or a sheet leans against a wall.
constexpr double upright_part = 0.7, upright_slender = 1.0;
constexpr double level_of_length = 0.2, width_of_length = 0.75;
constexpr int hull_vertices = 500;

bool is_guess(double diagonal) {
  return diagonal >= least_guessed && diagonal <= most_guessed;
}
bool is_part(double diagonal) {
  return diagonal >= least_stated && diagonal <= most_stated;
}

std::string short_number(double value) {
  return formatted("%.4g", value);
}
std::string in_metres(double value) {
  return short_number(value) + " m";
}

/// "mm makes it 0.08 m, inch 2 m": the units that make a part of `size` units one that passes.
std::string likely_units(double size, bool passes(double diagonal), std::optional<Unit> but = std::nullopt) {
  std::string text;
  for (const Unit unit : {Unit::millimetre, Unit::metre, Unit::inch, Unit::centimetre}) {
    if (but == unit || !passes(size * metres_per(unit))) continue;
    text += (text.empty() ? "" : ", ") + std::string(name_of(unit)) + (text.empty() ? " makes it " : " ") +
            in_metres(size * metres_per(unit));
  }
  return text;
}

Error unclear(const std::string& what, double size, const std::string& path) {
  std::string likely = likely_units(size, is_guess);
  if (likely.empty()) likely = likely_units(size, is_part);
  return input_error(what, path,
                     likely.empty() ? "no unit makes it one of 1 mm to 2 m: scale the model" : "--unit " + likely);
}

double rounded_up(double length) {
  const double step = length < 0.2 ? 0.005 : length < 1.0 ? 0.01 : 0.05;
  return step * std::ceil(length / step - 1e-9);
}

}  // namespace

ChosenUnit choose_unit(const LoadedMesh& file, std::optional<Unit> given, const std::string& path) {
  const double size = file.mesh.bounds().diagonal() / file.report.metres_per_unit;
  const bool stated = is_cad(file.report.format) || file.report.format == "DAE";
  ChosenUnit chosen;
  if (given || stated) {
    chosen.unit = given;
    chosen.metres = given ? metres_per(*given) : file.report.file_metres_per_unit;
    chosen.reason = given ? "as --unit says" : "as the file states";
    const double diagonal = size * chosen.metres;
    if (!is_part(diagonal))
      throw unclear("the part is " + in_metres(diagonal) + " across, " + chosen.reason + ": no part of a bin", size,
                    path);
    return chosen;
  }
  const bool mm = is_guess(size * metres_per(Unit::millimetre)), m = is_guess(size);
  if (mm == m)
    throw unclear("the file does not state its unit, and " + short_number(size) + " across may be any", size, path);
  chosen.unit = mm ? Unit::millimetre : Unit::metre;
  chosen.metres = metres_per(*chosen.unit);
  chosen.reason =
      "guessed: " + std::string(name_of(*chosen.unit)) + " makes it " + in_metres(size * chosen.metres) + " across";
  const std::string others = likely_units(size, is_guess, chosen.unit);
  if (!others.empty()) chosen.reason += "; or else " + others;
  return chosen;
}

FittedBin fit_bin(const Mesh& part, std::size_t count) {
  FittedBin fitted;
  fitted.hull = mass_properties(convex_hull(extreme_points(part.vertices), hull_vertices)).volume;
  const double diagonal = part.bounds().diagonal(), length_of_rod = part.bounds().size().maxCoeff();
  const double slenderness = length_of_rod / std::sqrt(4.0 / M_PI * fitted.hull / length_of_rod);
  const Vec3 size = part.bounds().size();
  const double side = std::sqrt(size.x() * size.y() * size.z() / size.minCoeff());
  const double flatness = side * side * side / fitted.hull;
  fitted.loose = std::max({heap_per_hull, slenderness / filled_by_rods, flatness / filled_by_sheets});
  const double heap = fitted.loose * static_cast<double>(count) * fitted.hull;
  const double length = std::max(std::cbrt(heap / (level_of_length * width_of_length)), 1.7 * diagonal);
  const double width = std::max(width_of_length * length, 1.3 * diagonal);
  fitted.level = heap / (length * width);
  // Poured in the centre, a heap has a top: half as high again as it is in the mean, and a part that stands upon it.
  const double upright = (fitted.loose > heap_per_hull ? upright_slender : upright_part) * diagonal;
  fitted.inner_size = {rounded_up(length), rounded_up(width), rounded_up(1.6 * fitted.level + upright)};
  return fitted;
}

SensorPlace place_sensor(const Sensor& sensor, const Bin& bin) {
  SensorPlace place;
  const Sensor by_default = resolved(sensor, bin);
  place.distance = by_default.pose->position.z();
  if (place.distance <= by_default.far) return place;
  place.height = place.distance = by_default.far / 1.05;
  place.warning = "the bin is larger than what the sensor sees within its range of " + in_metres(by_default.far);
  return place;
}

}  // namespace bin_scenes
