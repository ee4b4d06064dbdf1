/// Grasps as images, for networks that learn where to grasp: how good each pixel is for the cup of a gripper, and how
/// far its part is covered.
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/raster/lens.hpp"
#include "output/png.hpp"

#include <cmath>
#include <filesystem>
#include <map>

namespace bin_scenes {

namespace {

constexpr double facing = 0.85;         ///< cosine between a pixel's normal and the axis of a cup that stands for it
constexpr double half_covered = 0.5;    ///< share of the footprint from which a part counts as covered
constexpr double full_score = 65535.0;  ///< of 16 bits

enum Layer : std::uint8_t { background, top, partly_covered, covered };

/// A cup in the camera's frame.
struct Place {
  Vec3 center, axis;  ///< of the ring; unit, towards the part
  double score;       ///< 0: not free
};

std::vector<std::uint8_t> layers_of(const RangeImage& image, const SceneGrasps& grasps) {
  std::map<std::uint16_t, Layer> of_label;
  for (const PartPick& pick : grasps.parts)
    of_label[static_cast<std::uint16_t>(pick.id + 1)] = pick.lifts()                        ? top
                                                        : pick.overlap.share < half_covered ? partly_covered
                                                                                            : covered;
  std::vector<std::uint8_t> layers;
  for (const std::uint16_t label : image.seen_label()) {
    const auto found = of_label.find(label);
    layers.push_back(found == of_label.end() ? background : found->second);
  }
  return layers;
}

std::map<std::uint16_t, std::vector<Place>> places_of(const SceneGrasps& grasps, std::size_t gripper,
                                                      const Pose& into_camera) {
  std::map<std::uint16_t, std::vector<Place>> places;
  for (const SceneGrasp& grasp : grasps.grasps) {
    if (grasp.gripper != gripper) continue;
    const Pose pose = into_camera * grasp.pose;
    places[static_cast<std::uint16_t>(grasp.part + 1)].push_back(
        {pose.position, pose.orientation * Vec3::UnitZ(), grasp.free() ? grasp.score : 0.0});
  }
  return places;
}

/// Score of the nearest cup that was tried, if its centre is no farther than a radius and the surface faces it.
double score_at(const Vec3& point, const Vec3& normal, const std::vector<Place>& places, double radius) {
  double nearest = radius, score = 0.0;
  for (const Place& place : places) {
    const double distance = (point - place.center).norm();
    if (distance >= nearest || -normal.dot(place.axis) < facing) continue;
    nearest = distance;
    score = place.score;
  }
  return score;
}

std::vector<std::uint16_t> suction_map(const RangeImage& image, const SceneGrasps& grasps, std::size_t index,
                                       const Gripper& gripper) {
  const Sensor& camera = image.true_sensor();
  const Lens lens = lens_of(camera);
  const auto places = places_of(grasps, index, camera.pose.value_or(Pose()).inverse());
  std::vector<std::uint16_t> map(image.seen_label().size(), 0);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto found = places.find(image.seen_label()[i]);
    const std::array<float, 3>& n = image.seen_normal()[i];
    const double depth = image.seen_depth()[i];
    if (found == places.end() || !std::isfinite(depth) || !std::isfinite(n[0])) continue;
    const Vec3 ray = lens.ray(static_cast<double>(i % static_cast<std::size_t>(camera.width)),
                              static_cast<double>(i / static_cast<std::size_t>(camera.width)));
    const Vec3 point = depth / ray.z() * ray;
    map[i] = static_cast<std::uint16_t>(
        std::lround(full_score * score_at(point, Vec3(n[0], n[1], n[2]), found->second, gripper.radius)));
  }
  return map;
}

}  // namespace

void write_grasp_maps(const std::string& directory, const RangeImage& image, const SceneGrasps& grasps,
                      const Request& request) {
  const Sensor& camera = image.true_sensor();
  const std::string base = (std::filesystem::path(directory) / image.sensor.name).string();
  write_bytes(base + "_layers.png", png8(camera.width, camera.height, 1, layers_of(image, grasps)));
  for (std::size_t i = 0; i < request.grippers.size(); ++i) {
    const Gripper& gripper = request.grippers[i];
    if (gripper.type != Gripper::Type::suction) continue;
    write_bytes(base + "_suction_" + file_name_of(gripper) + ".png",
                png16(camera.width, camera.height, suction_map(image, grasps, i, gripper)));
  }
}

}  // namespace bin_scenes
