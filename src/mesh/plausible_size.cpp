/// Whether a model's numbers were meant in metres: its size beside the bin, and a bin's beside its parts.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "mesh_words.hpp"

#include <algorithm>
#include <utility>

namespace bin_scenes {

namespace {

constexpr double largest_unasked = 10.0;  ///< m: of what is read without a unit and has nothing to be compared with
constexpr double times_smaller = 2000.0;  ///< than the bin: a part that was read without a unit is not

std::string text_of(const Vec3& size) {
  return number(size.x()) + " x " + number(size.y()) + " x " + number(size.z()) + " m";
}

/// What to do about a file whose numbers, read in metres, span `size`: the units that make it larger than `above` and
/// smaller than `below` (m), if there are any. Parts are drawn in units that they are not much smaller than: no file of
/// numbers below one half is taken for millimetres. Numbers of a few units may be meant in several of them.
std::string unit_advice(double size, double above, double below, const std::string& otherwise) {
  std::vector<std::pair<std::string, std::string>> likely;  // unit, size
  for (const Unit unit : {Unit::millimetre, Unit::centimetre, Unit::inch}) {
    const double then = size * metres_per(unit);
    if (size >= 0.5 && then > above && then < below)
      likely.emplace_back(std::string("\"unit: ") + name_of(unit) + "\"", number(then) + " m");
  }
  if (likely.empty()) return otherwise;
  if (likely.size() == 1) return "probably its unit is missing: " + likely[0].first + " makes it " + likely[0].second;
  std::string text = "give its unit: " + likely[0].first + " makes it " + likely[0].second;
  for (std::size_t i = 1; i < likely.size(); ++i) text += ", " + likely[i].first + " " + likely[i].second;
  return text;
}

}  // namespace

void check_plausible_size(const Mesh& mesh, const Bin& bin, const std::string& path, std::optional<Unit> given,
                          const Mesh* bin_mesh) {
  Vec3 room = Vec3::Constant(largest_unasked);
  std::string place = "a scene without walls (at most " + number(largest_unasked) + " m)";
  double room_diagonal = largest_unasked;
  if (bin.kind == Bin::Kind::box || (bin.kind == Bin::Kind::mesh && bin_mesh)) {
    room = bin.kind == Bin::Kind::box ? bin.inner_size : bin_mesh->bounds().size();
    room_diagonal = room.norm();
    place = "the bin of " + text_of(room);
  }
  const double diagonal = mesh.bounds().diagonal(), side = room.maxCoeff();
  const bool too_large = diagonal > room_diagonal, too_small = !given && diagonal < side / times_smaller;
  if (!too_large && !too_small) return;

  const std::string what = "the part is " + number(diagonal) + " m across" +
                           (given ? "" : " read in its own unit or metres") + ": too " +
                           (too_large ? "large" : "small") + " for " + place;
  std::string remedy = too_large ? "enlarge the bin, or check the part's unit and scale" : "give its unit, or a scale";
  if (bin.kind == Bin::Kind::mesh) remedy += "; check the bin's unit too";
  if (!given) remedy = unit_advice(diagonal, side / 200.0, 0.75 * side, remedy);
  throw input_error(what, path, remedy);
}

void check_plausible_bin(const Mesh& mesh, const Bin& bin, double largest_part) {
  const Vec3 size = mesh.bounds().size();
  const bool alone = size.norm() > largest_unasked;
  const bool beside_parts = largest_part > 0.0 && size.maxCoeff() > times_smaller * largest_part;
  if (bin.unit || !(alone || beside_parts)) return;
  std::string what = "the bin is " + text_of(size) + " read in its own unit or metres";
  if (beside_parts) what += ", and its largest part is " + number(largest_part) + " m across";
  throw input_error(what, bin.mesh, unit_advice(size.norm(), largest_part, largest_unasked, "give its unit: bin.unit"));
}

}  // namespace bin_scenes
