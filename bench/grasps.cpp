/// What the labels of grasps cost: once for each part and gripper, and for each scene. A heap is poured once; its
/// grasps are then found again and again, with and without the search in the scene.
#include "bin_scenes/grasp/scene_grasps.hpp"
#include "framework/benchmark.hpp"
#include "runs.hpp"

#include <string>

namespace bin_scenes::bench {
namespace {

Gripper gripper_named(const std::string& name) {
  Gripper gripper;
  gripper.name = name;
  gripper.palm = Vec3(0.09, 0.04, 0.05);
  if (name == "cup") {
    gripper.type = Gripper::Type::suction;
    gripper.radius = 0.005;
    gripper.finger_depth = 0.08;
    gripper.palm = Vec3(0.04, 0.04, 0.05);
    return gripper;
  }
  gripper.stroke = 0.06;
  gripper.finger_width = 0.008;
  gripper.finger_thickness = 0.004;
  return gripper;
}

Row counts_of(const SceneGrasps& found) {
  std::size_t free = 0, lifts = 0, tried = 0;
  for (const SceneGrasp& grasp : found.grasps) free += grasp.free();
  for (const PartPick& pick : found.parts) {
    lifts += pick.lifts();
    for (const PartSearch& search : pick.searches) tried += search.tried;
  }
  return Row().info("liftable", lifts).info("grasps", found.grasps.size()).info("free", free).info("tried", tried);
}

/// The scene's labels, `repeats` times; the grasps of the part alone are known already.
Row timed(const Grasper& grasper, const Scene& scene, LoadedRequest& all, std::size_t free_wanted, int repeats) {
  all.request.grippers[0].free_wanted = free_wanted;
  std::vector<double> seconds;
  SceneGrasps found;
  for (int k = 0; k < repeats; ++k) {
    const Clock clock;
    found = grasper.find(scene, all, {});
    seconds.push_back(clock.cpu_s());
  }
  const std::string name = free_wanted > 0 ? "cpu_s" : "listed_cpu_s";
  Row row = Row().measure(name, seconds);
  return free_wanted > 0 ? row.append(counts_of(found)) : row;
}

void run(Run& out) {
  const std::size_t count = out.quick() ? 32 : 256;
  for (const char* part : {"conrod", "bolt_hex", "bracket_l"}) {
    for (const char* name : {"fingers", "cup"}) {
      const Row key = Row::keys("part", part, "gripper", name);
      if (!out.wanted(key)) continue;
      Request request = bin_of(part, count);
      request.grippers = {gripper_named(name)};
      Poured poured = pour_timed(request);
      const Scene& scene = poured.scene;
      LoadedRequest& all = poured.loaded;
      const Clock clock;
      find_grasps(*all.parts[0], request.grippers[0], request.grippers[0].friction);
      const double once = clock.cpu_s();
      const Grasper grasper;
      grasper.find(scene, all, {});
      const std::size_t wanted = request.grippers[0].free_wanted;
      const int repeats = out.quick() ? 1 : 5;
      out.row(Row(key)
                  .info("parts", scene.parts.size())
                  .append(timed(grasper, scene, all, wanted, repeats))
                  .append(timed(grasper, scene, all, 0, repeats))
                  .measure("part_cpu_s", once));
    }
  }
}

const Registration registration{"grasps",
                                "seconds to label the grasps of a scene, and of a part once",
                                {"part", "gripper"},
                                run,
                                "src/core src/mesh src/part src/grasp src/quality"};

}  // namespace
}  // namespace bin_scenes::bench
