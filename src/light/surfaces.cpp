#include "bin_scenes/light/surfaces.hpp"

#include "bin_scenes/core/random.hpp"

#include "light/tabletop.hpp"
#include "light/wear.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

Vec3 longest_edge(const Vec3& size) {
  Vec3::Index axis = 0;
  size.maxCoeff(&axis);
  return Vec3::Unit(axis);
}

Surfaces::Place place_of(const Bin& bin) {
  const Pose pose = bin.kind == Bin::Kind::mesh ? bin.pose : Pose();
  return {pose.inverse(), bin.kind == Bin::Kind::box ? longest_edge(bin.inner_size) : Vec3(Vec3::UnitX()), 0};
}

}  // namespace

Surfaces surfaces_of(const Request& request) {
  Surfaces surfaces;
  for (const PartLine& line : request.parts) surfaces.lines.push_back(line.surface);
  surfaces.bin = request.bin.surface;
  surfaces.table = request.table;
  return surfaces;
}

Surfaces surfaces_of(const Scene& scene, const LoadedRequest& loaded) {
  Surfaces surfaces = surfaces_of(loaded.request);
  surfaces.places = {place_of(loaded.request.bin)};
  for (const ScenePart& part : scene.parts) {
    const auto label = static_cast<std::size_t>(part.id) + 1;
    if (surfaces.places.size() <= label) surfaces.places.resize(label + 1, surfaces.places.front());
    // The smallest moment of inertia is that about the longest axis.
    const Vec3 longest = loaded.parts[part.line]->mass().principal_axes * Vec3::UnitX();
    surfaces.places[label] = {part.pose.inverse(), longest, 0};
  }
  const Random key(scene.seed, scene.index, Stream::sensor);
  for (std::size_t label = 0; label < surfaces.places.size(); ++label)
    surfaces.places[label].key = key.of_piece(label).next();
  surfaces.table_key = key.of_piece(std::uint64_t{1} << 60).next();  // behind those of the labels
  return surfaces;
}

bool Surfaces::vary() const {
  const auto worn = [](const Surface& surface) { return surface.texture.any(); };
  return worn(bin) || std::any_of(lines.begin(), lines.end(), worn) ||
         (table.height && (table.mottle > 0.0 || worn(table.surface)));
}

Surface Surfaces::table_at(const Vec3& point) const {
  return table_surface(table, point, table_key);
}

Surface Surfaces::own_surface(const Surface& even, const Place& place, const Vec3& point) {
  Surface own = even;
  if (even.anisotropy > 0.0) {
    const Vec3 along = even.along.norm() > 0.0 ? even.along : place.longest;
    own.along = place.to_part.orientation.conjugate() * along;
  }
  return even.texture.any() ? worn(own, place.to_part * point, place.key) : own;
}

}  // namespace bin_scenes
