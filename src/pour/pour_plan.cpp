#include "pour/pour_plan.hpp"

#include "pour/squeezed_parts.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/mesh/bin_mesh.hpp"
#include "bin_scenes/pour/pour.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

double largest_diagonal(const WorldDef& world) {
  double largest = 0.0;
  for (const PartModelPtr& part : world.parts) largest = std::max(largest, part->diagonal());
  return largest;
}

Aabb bin_bounds_of(const WorldDef& world) {
  if (world.bin_model) return transformed(world.bin_model->mesh(), world.bin.pose).bounds();
  return world.bin.kind == Bin::Kind::box ? box_bin_mesh(world.bin).bounds() : Aabb();
}

Opening opening_of(const WorldDef& world, const Aabb& box, double part) {
  const Vec3 half = 0.5 * world.bin.inner_size;
  switch (world.bin.kind) {
    case Bin::Kind::box:
      return {Vec3(-half.x(), -half.y(), 0.0), Vec3(half.x(), half.y(), 2.0 * half.z())};
    case Bin::Kind::mesh: {
      // The walls' thickness is not known: stay clear of them by a tenth of the width on each side.
      const Vec3 rim(0.1 * box.size().x(), 0.1 * box.size().y(), 0.0);
      return {box.lower + rim, box.upper - rim, outline(transformed(world.bin_model->mesh(), world.bin.pose))};
    }
    case Bin::Kind::floor:
    case Bin::Kind::none:
      break;
  }
  // Without walls a heap as wide as two layers of its parts are, and as high as it gets.
  const double side = part * std::max(2.0, std::sqrt(0.5 * world.bodies.size()));
  return {Vec3(-0.5 * side, -0.5 * side, 0.0), Vec3(0.5 * side, 0.5 * side, 1e3 * side)};
}

}  // namespace

PourPlan::PourPlan(const LoadedRequest& loaded)
    : request(loaded.request),
      world(world_of(loaded)),
      largest_part(largest_diagonal(world)),
      bin_bounds(bin_bounds_of(world)),
      opening(opening_of(world, bin_bounds, largest_part)) {
  const Request& r = request;
  for (std::size_t l = 0; l < r.parts.size(); ++l) {
    const PartLine& line = r.parts[l];
    const std::string where = "parts[" + std::to_string(l) + "] (" + line.model + ")";
    if (line.count == 0) {  // nobody of this line is left: a scene may go on without
      covers.push_back(cover(loaded.parts[l]->mesh()));
      continue;
    }
    if (line.poses.empty() && line.fixed)
      throw input_error("a fixed part needs a pose", where + ".poses", "give one pose [x,y,z,qx,qy,qz,qw] per copy");
    if (line.poses.empty() && !line.stays() && r.pour.pattern == Pour::Pattern::given)
      throw input_error("pour.pattern given needs start poses", where + ".poses",
                        "give one pose per copy, or pour.scene, or pattern: rain");
    if (!line.poses.empty() && line.poses.size() != line.count)
      throw input_error(std::to_string(line.poses.size()) + " poses for " + std::to_string(line.count) + " parts",
                        where + ".poses", "give as many poses as count");
    if (!line.velocities.empty() && line.velocities.size() != line.poses.size())
      throw input_error(
          std::to_string(line.velocities.size()) + " velocities for " + std::to_string(line.poses.size()) + " poses",
          where + ".velocities", "give one velocity per pose, or none");
    covers.push_back(cover(loaded.parts[l]->mesh()));
    if (line.on_table > 0.0) lying.emplace(l, *loaded.parts[l]);
    for (std::size_t copy = 0; copy < line.count; ++copy) {
      line_of.push_back(l);
      copy_of.push_back(copy);
    }
  }
  BIN_SCENES_ASSERT(line_of.size() == world.bodies.size() && covers.size() == r.parts.size());
  if (world.bin_model) bin_cover = cover(transformed(world.bin_model->mesh(), world.bin.pose), 40);
  entry_height = opening.upper.z() + 2.0 * r.pour.drop_height + 2.0 * largest_part;
  refuse_squeezed_parts(*this);
}

}  // namespace bin_scenes
