/// Which scene needs which mechanism: small scenes whose errors have goals, with all mechanisms and with each one taken
/// away. A mechanism without which every scene still meets its goal has to show its worth in heaps (ablation.cpp).
#include "framework/benchmark.hpp"
#include "mechanisms.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/closed_form_scenes.hpp"
#include "solver/pressed_scenes.hpp"
#include "solver/sphere/sphere_solver.hpp"
#include "solver/tight_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace bin_scenes::bench {
namespace {

using namespace testing;  // but for its Row
using MakeLab = std::function<Lab()>;

struct Scene {
  const char* name;
  double goal;  ///< what the tests hold its error to
  double (*error)(const MakeLab& lab);
};

/// Of twenty cubes on each other, pressed, after four seconds / edge.
double tower(const MakeLab& make) {
  Lab lab = make();
  constexpr int cubes = 20;
  const double edge = 0.04;
  for (int i = 0; i < cubes; ++i)
    lab.place(box(Vec3::Constant(edge)), Vec3(0, 0, (i + 0.5) * edge), Quat::Identity(), material(0.5));
  lab.begin(phases::press);
  lab.simulate(4.0);
  double most = 0.0;
  for (int i = 0; i < cubes; ++i)
    most = std::max(most, (lab.center(static_cast<std::size_t>(i)) - Vec3(0, 0, (i + 0.5) * edge)).norm() / edge);
  return most;
}

/// Of sheets of 1/5 mm that lie under a block of a hundred times their mass: how far the upper one sinks / thickness.
double loaded_sheets(const MakeLab& make) {
  Lab lab = make();
  const double thickness = 2e-4;
  const PartModelPtr sheet = box({0.05, 0.04, thickness});
  for (const double place : {0.5, 1.5})
    lab.place(sheet, Vec3(0, 0, place * thickness), Quat::Identity(), material(0.5, 0.0, 0.01));
  lab.place(box(Vec3::Constant(0.04)), Vec3(0, 0, 2.0 * thickness + 0.02), Quat::Identity(), material(0.5));
  lab.simulate(0.5);
  return std::abs(lab.center(1).z() / thickness - 1.5);
}

/// A sheet that falls onto another: how far its middle is from where it lies / thickness.
double falling_sheet(const MakeLab& make) {
  Lab lab = make();
  const double thickness = 2e-4;
  const PartModelPtr sheet = box({0.05, 0.04, thickness});
  lab.place(sheet, Vec3(0, 0, 0.5 * thickness));
  lab.place(sheet, Vec3(0, 0, 0.02), Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ())));
  lab.simulate(0.5);
  return std::abs(lab.center(1).z() / thickness - 1.5);
}

const Scene scenes[] = {
    {"a thrown box follows its parabola", 1e-4, [](const MakeLab& lab) { return free_fall(lab()).way; }},
    {"a ball bounces", 0.0081, [](const MakeLab& lab) { return std::abs(bounce(lab(), 0.437, 0.9) - 0.81); }},
    {"a ball bounces for 5 s and loses nothing", 5e-4, [](const MakeLab& lab) { return elastic_change(lab()); }},
    {"a box slides to its place", 0.005,
     [](const MakeLab& lab) {
       const Slide error = slide(lab());
       return std::max(error.way, error.aside);
     }},
    {"a box sticks below its angle of friction", 1e-3,
     [](const MakeLab& lab) { return slip(lab(), std::atan(0.5) - 0.5 * M_PI / 180.0, 0.4); }},
    {"a ball rolls down a slope", 0.002, [](const MakeLab& lab) { return roll(lab()); }},
    {"a plate takes a ball along", 3e-3, [](const MakeLab& lab) { return ride(lab()); }},
    {"a ball spins down", 0.02,
     [](const MakeLab& lab) { return std::abs(spin_lost(lab(), Settings{}.patch_radius) - 1.0); }},
    {"a yoke swings down", 0.05,
     [](const MakeLab& lab) { return std::abs(swing_lost(lab(), Settings{}.patch_radius) - 1.0); }},
    {"boxes that meet gain no energy", 1e-5, [](const MakeLab& lab) { return collide(lab(), 1.0).energy - 1.0; }},
    {"boxes that meet keep their spin", 0.02, [](const MakeLab& lab) { return collide(lab(), 0.5).spin; }},
    {"rods that meet change velocities", 0.01,
     [](const MakeLab& lab) {
       const Rods speeds = meet_along_rods(lab());
       return std::max(std::abs(speeds.first), std::abs(speeds.second - 1.0));
     }},
    {"a tumbling box keeps its energy", 1e-3, [](const MakeLab& lab) { return 1.0 - tumble(lab()).lowest; }},
    {"a tumbling box turns over", 0.1, [](const MakeLab& lab) { return 1.0 + tumble(lab()).turned; }},
    {"ten boxes stand", 1e-3, [](const MakeLab& lab) { return stack_drift(lab(), 5.0); }},
    {"ten wide boxes stand", 5e-3,
     [](const MakeLab& lab) { return stack_drift(lab(), 5.0, 0.3, Vec3(0.2, 0.08, 0.08)); }},
    {"twenty cubes stand", 0.01, tower},
    {"a house of cards stands", 5e-3, [](const MakeLab& lab) { return card_house_drift(lab(), phases::pour); }},
    {"contacts carry a leaning stack", 1e-3, [](const MakeLab& lab) { return carry(lab()).force; }},
    {"sheets carry a block", 0.25, loaded_sheets},
    {"a sheet stops another", 0.25, falling_sheet},
    {"a corner drops into its pit", 6e-4,
     [](const MakeLab& lab) { return corner_into_pit(lab(), 0.005, 0.3, 0.5).off.norm(); }},
    {"a peg enters its hole", 4e-3,
     [](const MakeLab& lab) { return std::abs(peg_into_hole(lab(), 6, 0.005, 0.5).off.z()); }},
    {"a spike rattles in a hole", 5e-3,
     [](const MakeLab& lab) { return spike_into_hole(lab(), 0.4, 0.3, 0.0, 0.5, 0.0); }},
    {"a chain hangs", 2e-3, [](const MakeLab& lab) { return hang_chain(lab(), 5, 0.8).risen; }},
    {"a chain comes to its end", 0.02, [](const MakeLab& lab) { return given_back_by_a_chain(lab(), 8, 0.8); }},
    {"wedges are pressed between others", 2e-3,
     [](const MakeLab& lab) {
       return press_between(lab(), {Point::wedge, 0.2, 0.1, 0.5, 0.0, 20.0, true}).risen;
     }},
    {"spikes are pressed between others", 2e-3,
     [](const MakeLab& lab) {
       return press_between(lab(), {Point::spike, 0.2, 0.6, 0.5, 1e-3, 20.0, false}).risen;
     }},
    {"a spike slides over a rim", 0.02, [](const MakeLab& lab) { return std::abs(slide_over_rim(lab(), 0.2).lost); }},
    {"a groove presses as its angle says", 0.01,
     [](const MakeLab& lab) { return std::abs(pressed_in_groove(lab(), 0.3) / (std::hypot(1.0, 0.3) / 0.6) - 1.0); }},
    {"cubes fall on each other", 0.05, [](const MakeLab& lab) { return pile_up_cubes(lab(), 5).speed; }},
    {"a heavy cube throws no light one", 0.02,
     [](const MakeLab& lab) { return strike_light_cube(lab(), 100.0, 0.3).thrown; }},
    {"a heavy cube does not rebound", 0.03, [](const MakeLab& lab) { return strike_light_cube(lab(), 100.0).speed; }},
};

void run(Run& out) {
  for (const Mechanism& mechanism : mechanisms)
    for (const Scene& scene : scenes) {
      const bench::Row key = bench::Row().key("without", mechanism.name).key("scene", scene.name);
      if (!out.wanted(key)) continue;
      Variant variant;
      mechanism.take_away(variant);
      double error;
      try {
        error = scene.error([&] { return Lab(make_sphere_solver({}, variant)); });
      } catch (const Error&) {
        error = infinity;
      }
      out.row(bench::Row(key)
                  .measure("error", error)
                  .info("goal", std::to_string(scene.goal))
                  .measure("share", error / scene.goal));
    }
}

const Registration registration{"needs", "which small scene fails without which mechanism", {"without", "scene"}, run};

}  // namespace
}  // namespace bin_scenes::bench
