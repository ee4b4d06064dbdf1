/// What each mechanism of the default solver gives. `ablation`: heaps with all mechanisms, and with each one taken
/// away. Time is CPU time from request to poses. Errors are those of the scene's report; drift is that of its parts
/// under the solver with all of its mechanisms, from rest and without remembered forces. `needs`: the same for small
/// scenes whose errors have goals; a mechanism without which each still meets its goal has to show its worth in heaps.
#include "framework/benchmark.hpp"
#include "judged.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/closed_form_scenes.hpp"
#include "solver/pressed_scenes.hpp"
#include "solver/sphere/make_world.hpp"
#include "solver/sphere/sphere_solver.hpp"
#include "solver/tight_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace bin_scenes::bench {
namespace {

using sphere::Samples, sphere::Settings, sphere::Shape, sphere::Variant;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Done to coarse and fine samples of each part.
void change_samples(Variant& variant, void (*change)(Samples&)) {
  variant.change = [change](Shape& shape) {
    change(shape.coarse);
    change(shape.fine);
  };
}

/// No sphere around nodes is ever far enough away (m).
void never_far(std::vector<sphere::Ball>& balls) {
  for (sphere::Ball& ball : balls) ball.radius = 1e3f;
}

struct Mechanism {
  const char* name;
  const char* instead;  ///< what is done without it
  void (*take_away)(Variant&);
};

const Mechanism mechanisms[] = {
    {"nothing", "all mechanisms are on", [](Variant&) {}},
    // Finding contacts.
    {"oriented boxes", "pairs by upright boxes alone", [](Variant& v) { v.settings.oriented_boxes = false; }},
    {"recycling", "contacts found anew in every step",
     [](Variant& v) { v.settings.recycle = v.settings.coarse_recycle = v.settings.pressed_recycle = 0; }},
    {"clusters of samples", "every node of a pair examined",
     [](Variant& v) { change_samples(v, [](Samples& s) { never_far(s.clusters); }); }},
    {"coarse samples", "parts pour on exact samples",
     [](Variant& v) { v.change = [](Shape& shape) { shape.coarse = shape.fine; }; }},
    {"edges", "nodes alone",
     [](Variant& v) {
       change_samples(v, [](Samples& s) {
         s.edges.clear();
         std::fill(s.first_edge.begin(), s.first_edge.end(), 0u);
         s.edge_grid = {};
       });
     }},
    {"exact edges", "the grid's way out at sharp edges",
     [](Variant& v) {
       change_samples(v, [](Samples& s) {
         for (sphere::Edge& edge : s.edges) edge.sharp = 0;
         s.edge_grid = {};
       });
     }},
    {"normal cones", "nodes are pressed from any side, and do not slide",
     [](Variant& v) {
       change_samples(v, [](Samples& s) {
         std::fill(s.cones.begin(), s.cones.end(), sphere::Cone{});
         for (sphere::Edge& edge : s.edges) edge.cone.bounds = 0;
       });
     }},
    {"slide", "nodes of curved faces stay where they are",
     [](Variant& v) { change_samples(v, [](Samples& s) { s.face_spacing = 0; }); }},
    {"way back", "the nearest exit, or none", [](Variant& v) { v.settings.way_back = false; }},
    {"margin", "contacts within the reach of a step alone", [](Variant& v) { v.settings.margin = 0; }},
    {"speculation", "contacts within the margin alone", [](Variant& v) { v.settings.speculation = false; }},
    {"soonest first", "eight contacts of a pair by depth and spread",
     [](Variant& v) { v.settings.soonest_first = false; }},
    {"half-way poses", "contacts where a step begins", [](Variant& v) { v.settings.poses_at_contact_time = false; }},
    {"cut steps", "whole steps for fast and small parts", [](Variant& v) { v.settings.cut_steps = false; }},
    // Solving them.
    {"warm start", "a step begins without forces", [](Variant& v) { v.settings.warm_start = false; }},
    {"relaxation", "no sweeps after the move", [](Variant& v) { v.settings.relaxation = false; }},
    {"cold sweeps", "two sweeps from the first step on",
     [](Variant& v) { v.settings.cold_steps = v.settings.pressed_cold_steps = 0; }},
    {"soft contacts", "stiff ones while parts move", [](Variant& v) { v.settings.soft = v.settings.stiff; }},
    {"stiff contacts", "soft ones while parts are pressed", [](Variant& v) { v.settings.stiff = v.settings.soft; }},
    {"refinement", "stiff contacts with two sub-steps, not eight", [](Variant& v) { v.settings.stiff.refinement = 1; }},
    {"push speed", "overlap leaves at any speed", [](Variant& v) { v.settings.push_speed = infinity; }},
    {"friction patch", "points resist no turn", [](Variant& v) { v.settings.patch_radius = 0; }},
    {"gyroscopic torque", "none", [](Variant& v) { v.settings.gyroscopic = false; }},
    // Work that follows from the heap.
    {"work for layers", "the same for any depth", [](Variant& v) { v.settings.default_layers = infinity; }},
    {"work for thin parts", "the same for any thickness", [](Variant& v) { v.settings.thin_part_sag = infinity; }},
    {"work for weights", "the same under heavy parts", [](Variant& v) { v.settings.loaded_part_sag = infinity; }},
    {"work for towers", "the same for towers", [](Variant& v) { v.settings.tower_effort = 0; }},
    // Coming to rest.
    {"sleep", "parts at rest are simulated on", [](Variant& v) { v.settings.rest_window = infinity; }},
    {"slip", "a probe begins with friction", [](Variant& v) { v.settings.probe_slip = 0; }},
    {"grip", "all of friction holds in a probe", [](Variant& v) { v.settings.friction_reserve = false; }}};

constexpr int seeds = 3, seeds_of_all = 6;  ///< scenes of a row; more with all mechanisms, to know their noise

constexpr std::size_t parts = 60;
constexpr const char* heaps[] = {"channel_u", "bolt_hex", "ring_24"};

Row key(const Mechanism& mechanism, const std::string& part) {
  return Row().key("without", mechanism.name).key("part", part).info("instead", mechanism.instead);
}

Row scenes_row(Run& out, const Mechanism& mechanism, const std::string& part) {
  Request request = bin_of(part, out.quick() ? 8 : parts);
  request.drift_check = true;
  warm_up(request, "sphere");
  Variant variant;
  mechanism.take_away(variant);
  const MakeSolver make = [&] { return make_sphere_solver(request.solver.sphere, variant); };
  const int count = out.quick() ? 1 : &mechanism == mechanisms ? seeds_of_all : seeds;
  const std::vector<Row> scenes = judged_scenes(out.scratch(), request, Run::pieces(part), make, {120.0, 0}, count);
  if (scenes.back().at("scenes").empty()) return scenes.back();
  Row row = joined(scenes);
  for (const char* figure : {"drift_p95_rel", "drift_max_rel", "turn_p95_deg"})
    row.measure(figure, row.number(std::string("own_") + figure));
  return row;
}

/// The row of that name and part, as it was measured here or earlier.
Row measured(const Run& out, const Mechanism& mechanism, const std::string& part) {
  for (std::size_t r = 0; r < out.table().rows.size(); ++r)
    if (const Row row = out.table().row(r); row.at("without") == mechanism.name && row.at("part") == part) return row;
  return {};
}

/// All parts in one row: the mean of the times' ratios, and of each error the worst part's.
Row all_parts(const Run& out, const Mechanism& mechanism) {
  Row all;
  double log_ratio = 0.0, scenes = 0.0, at_rest = 0.0;
  for (const char* part : heaps) {
    const Row row = measured(out, mechanism, part);
    log_ratio += std::log(row.number("cpu_ratio")) / std::size(heaps);
    scenes += row.number("scenes");
    at_rest += row.number("at_rest");
    for (const char* error :
         {"penetration_p95_rel", "penetration_max_rel", "drift_p95_rel", "drift_max_rel", "turn_p95_deg"})
      if (const double value = row.number(error); !std::isnan(value) && !(value <= all.number(error)))
        all.measure(error, value);
  }
  return Row().measure("cpu_ratio", std::exp(log_ratio)).exact("scenes", scenes).exact("at_rest", at_rest).append(all);
}

void ablation(Run& out) {
  for (const Mechanism& mechanism : mechanisms) {
    bool any = false;
    for (const char* part : heaps) {
      if (!out.wanted(key(mechanism, part))) continue;
      any = true;
      Row row = key(mechanism, part).append(scenes_row(out, mechanism, part));
      const double with_all = (&mechanism == mechanisms ? row : measured(out, *mechanisms, part)).number("cpu_s");
      out.row(row.measure("cpu_ratio", row.number("cpu_s") / with_all));
    }
    if (any && out.wanted(key(mechanism, "all"))) out.row(key(mechanism, "all").append(all_parts(out, mechanism)));
  }
}

using MakeLab = std::function<testing::Lab()>;
const Vec3 cube = Vec3::Constant(0.04), wide(0.2, 0.08, 0.08);  // m

struct SmallScene {
  const char* name;
  double goal;  ///< what the tests hold its error to
  double (*error)(const MakeLab& lab);
};

const SmallScene scenes[] = {
    {"a thrown box follows its parabola", 1e-4, [](auto& lab) { return free_fall(lab()).distance; }},
    {"a ball bounces", 0.0081, [](auto& lab) { return std::abs(bounce(lab(), 0.437, 0.9) - 0.81); }},
    {"a ball bounces for 5 s and loses nothing", 5e-4, [](auto& lab) { return elastic_change(lab()); }},
    {"a box slides to its place", 0.005,
     [](auto& lab) {
       const auto error = slide(lab());
       return std::max(error.distance, error.aside);
     }},
    {"a box sticks below its angle of friction", 1e-3,
     [](auto& lab) { return slip(lab(), std::atan(0.5) - 0.5 * M_PI / 180.0, 0.4); }},
    {"a ball rolls down a slope", 0.002, [](auto& lab) { return roll(lab()); }},
    {"a plate takes a ball along", 3e-3, [](auto& lab) { return ride(lab()); }},
    {"a ball spins down", 0.02, [](auto& lab) { return std::abs(spin_lost(lab(), Settings{}.patch_radius) - 1.0); }},
    {"a yoke swings down", 0.05, [](auto& lab) { return std::abs(swing_lost(lab(), Settings{}.patch_radius) - 1.0); }},
    {"boxes that meet gain no energy", 1e-5, [](auto& lab) { return collide(lab(), 1.0).energy - 1.0; }},
    {"boxes that meet keep their spin", 0.02, [](auto& lab) { return collide(lab(), 0.5).spin; }},
    {"rods that meet change velocities", 0.01,
     [](auto& lab) {
       const auto speeds = meet_along_rods(lab());
       return std::max(std::abs(speeds.first), std::abs(speeds.second - 1.0));
     }},
    {"a tumbling box keeps its energy", 1e-3, [](auto& lab) { return 1.0 - tumble(lab()).lowest; }},
    {"a tumbling box turns over", 0.1, [](auto& lab) { return 1.0 + tumble(lab()).turned; }},
    {"ten boxes stand", 1e-3, [](auto& lab) { return stack_drift(lab(), 5.0); }},
    {"ten wide boxes stand", 5e-3, [](auto& lab) { return stack_drift(lab(), 5.0, 0.3, wide); }},
    {"twenty cubes stand", 0.01, [](auto& lab) { return stack_drift(lab(), 4.0, 0.0, cube, 20); }},
    {"a house of cards stands", 5e-3, [](auto& lab) { return card_house_drift(lab(), phases::pour); }},
    {"contacts carry a leaning stack", 1e-3, [](auto& lab) { return carry(lab()).force; }},
    {"sheets carry a block", 0.25, [](auto& lab) { return loaded_sheets(lab()); }},
    {"a sheet stops another", 0.25, [](auto& lab) { return falling_sheet(lab()).upper; }},
    {"a corner drops into its pit", 6e-4, [](auto& lab) { return corner_into_pit(lab(), 0.005, 0.3, 0.5).off.norm(); }},
    {"a peg enters its hole", 4e-3, [](auto& lab) { return std::abs(peg_into_hole(lab(), 6, 0.005, 0.5).off.z()); }},
    {"a spike rattles in a hole", 5e-3, [](auto& lab) { return spike_into_hole(lab(), 0.4, 0.3, 0.0, 0.5, 0.0); }},
    {"a chain hangs", 2e-3, [](auto& lab) { return hang_chain(lab(), 5, 0.8).risen; }},
    {"a chain comes to its end", 0.02, [](auto& lab) { return given_back_by_a_chain(lab(), 8, 0.8); }},
    {"wedges are pressed between others", 2e-3,
     [](auto& lab) {
       return press_between(lab(), {testing::Point::wedge, 0.2, 0.1, 0.5, 0.0, 20.0, true}).risen;
     }},
    {"spikes are pressed between others", 2e-3,
     [](auto& lab) {
       return press_between(lab(), {testing::Point::spike, 0.2, 0.6, 0.5, 1e-3, 20.0, false}).risen;
     }},
    {"a spike slides over a rim", 0.02, [](auto& lab) { return std::abs(slide_over_rim(lab(), 0.2).lost); }},
    {"a groove presses as its angle says", 0.01,
     [](auto& lab) { return std::abs(pressed_in_groove(lab(), 0.3) / (std::hypot(1.0, 0.3) / 0.6) - 1.0); }},
    {"cubes fall on each other", 0.05, [](auto& lab) { return pile_up_cubes(lab(), 5).speed; }},
    {"a heavy cube throws no light one", 0.02, [](auto& lab) { return strike_light_cube(lab(), 100.0, 0.3).thrown; }},
    {"a heavy cube does not rebound", 0.03, [](auto& lab) { return strike_light_cube(lab(), 100.0).speed; }},
};

void needs(Run& out) {
  for (const Mechanism& mechanism : mechanisms)
    for (const SmallScene& scene : scenes) {
      const Row key = Row().key("without", mechanism.name).key("scene", scene.name);
      if (!out.wanted(key)) continue;
      Variant variant;
      mechanism.take_away(variant);
      double error;
      try {
        error = scene.error([&] { return testing::Lab(make_sphere_solver({}, variant)); });
      } catch (const Error&) {
        error = infinity;
      }
      out.row(Row(key)
                  .measure("error", error)
                  .info("goal", std::to_string(scene.goal))
                  .measure("share", error / scene.goal));
    }
}

const Registration of_heaps{
    "ablation", "what each mechanism of the default solver gives: scenes without it", {"without", "part"}, ablation};
const Registration of_small_scenes{
    "needs", "which small scene fails without which mechanism", {"without", "scene"}, needs};

}  // namespace
}  // namespace bin_scenes::bench
