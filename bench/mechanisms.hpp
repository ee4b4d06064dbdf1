/// The mechanisms of the default solver, each with how it is taken away.
#pragma once

#include "solver/sphere/make_world.hpp"

#include <algorithm>
#include <limits>

namespace bin_scenes::bench {

using sphere::Samples, sphere::Settings, sphere::Shape, sphere::Variant;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Done to coarse and fine samples of each part.
inline void change_samples(Variant& variant, void (*change)(Samples&)) {
  variant.change = [change](Shape& shape) {
    change(shape.coarse);
    change(shape.fine);
  };
}

/// No sphere around nodes is ever far enough away (m).
inline void never_far(std::vector<sphere::Ball>& balls) {
  for (sphere::Ball& ball : balls) ball.radius = 1e3f;
}

struct Mechanism {
  const char* name;
  const char* instead;  ///< what is done without it
  void (*take_away)(Variant&);
};

inline const Mechanism mechanisms[] = {
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

}  // namespace bin_scenes::bench
