/// What each mechanism of the default solver gives: the same scenes with all of them, and with each one taken away.
/// Time is CPU time from request to poses. Errors are those of the scene's report; drift is that of its parts under the
/// solver with all of its mechanisms, from rest and without remembered forces.
#include "framework/benchmark.hpp"
#include "judged.hpp"
#include "solver/sphere/make_world.hpp"
#include "solver/sphere/sphere_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes::bench {
namespace {

using sphere::Samples, sphere::Settings, sphere::Shape, sphere::Variant;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int seeds = 3, seeds_of_all = 6;  ///< scenes of a row; more with all mechanisms, to know their noise

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
     [](Variant& v) { v.settings.recycle = v.settings.coarse_recycle = 0; }},
    {"clusters of samples", "every node of a pair looked at",
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
    {"way back", "the nearest way out, or none", [](Variant& v) { v.settings.way_back = false; }},
    {"margin", "contacts within the way of a step alone", [](Variant& v) { v.settings.margin = 0; }},
    {"speculation", "contacts within the margin alone", [](Variant& v) { v.settings.speculation = false; }},
    {"soonest first", "eight contacts of a pair by depth and spread",
     [](Variant& v) { v.settings.soonest_first = false; }},
    {"far contacts left out", "every contact solved", [](Variant& v) { v.settings.press_margin = infinity; }},
    {"half-way poses", "contacts where a step begins", [](Variant& v) { v.settings.half_way_poses = false; }},
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

constexpr std::size_t parts = 60;
constexpr const char* heaps[] = {"channel_u", "bolt_hex", "ring_24"};

Row key(const Mechanism& mechanism, const std::string& part) {
  return Row().key("without", mechanism.name).key("part", part).info("instead", mechanism.instead);
}

Row scenes_row(Run& out, const Mechanism& mechanism, const std::string& part) {
  Request request = bin_of(part, out.quick() ? 8 : parts);
  choose_solver(request, "sphere");
  request.drift_check = true;
  warm_up(request);
  Variant variant;
  mechanism.take_away(variant);
  const MakeSolver make = [&](const std::vector<PartModelPtr>&) {
    return make_sphere_solver(request.solver.sphere, variant);
  };
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

void run(Run& out) {
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

const Registration registration{
    "ablation", "what each mechanism of the default solver gives: scenes without it", {"without", "part"}, run};

}  // namespace
}  // namespace bin_scenes::bench
