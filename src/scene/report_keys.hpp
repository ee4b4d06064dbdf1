/// The tables of the parts and of the report in scene.json, in the order of the file (see scene/keys.hpp).
/// docs/use/scene.md is generated from them.
#pragma once

#include "bin_scenes/scene/key.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <cmath>

namespace bin_scenes {

inline Names<PartState> names(PartState) {
  return {{"resting", PartState::resting}, {"moving", PartState::moving},         {"escaped", PartState::escaped},
          {"fixed", PartState::fixed},     {"not_poured", PartState::not_poured}, {"removed", PartState::removed}};
}

/// A number of 64 bits as 16 hexadecimal digits: many readers of JSON keep only 53 bits of a number.
struct Hexadecimal {
  std::uint64_t value = 0;
};

template <class Visitor>
void visit(Visitor& v, Quantiles& q) {
  v.field({"median", "m", "half of the values are at most this"}, q.median);
  v.field({"p95", "m", "95 % of the values are at most this"}, q.p95);
  v.field({"max", "m", "largest value"}, q.max);
}

template <class Visitor>
void visit(Visitor& v, PenetrationReport& p) {
  visit(v, static_cast<Quantiles&>(p));
  v.field({"pair", "", "ids of the pair that overlaps most; -1, -1 if none overlaps"}, p.pair);
  v.field({"pairs", "", "number of overlapping pairs"}, p.pairs);
  v.field({"p95_relative", "", "95 % quantile of depth / bounding diagonal of the smaller part"}, p.p95_relative);
  v.field({"max_relative", "", "largest depth / bounding diagonal of the smaller part"}, p.max_relative);
  v.field({"bin_median", "m", "median over the parts that overlap the bin"}, p.bin_median);
  v.field({"bin_p95", "m", "95 % quantile over the parts that overlap the bin"}, p.bin_p95);
  v.field({"bin_max", "m", "largest overlap of a part with the bin"}, p.bin_max);
  v.field({"bin_part", "", "id of the part that overlaps the bin most; -1 if none does"}, p.bin_part);
}

template <class Visitor>
void visit(Visitor& v, DriftReport& drift) {
  visit(v, static_cast<Quantiles&>(drift));
  v.field({"turn_p95", "rad", "95 % quantile of the rotation of parts"}, drift.turn_p95);
}

template <class Visitor>
void visit(Visitor& v, EnergyReport::Thrown& thrown) {
  v.field({"ratio", "",
           "largest (speed - gravity * time between two observations) / fastest of the parts near it before; a "
           "rotation counts at the part's radius"},
          thrown.ratio);
  v.field({"time", "s", "simulated time of the observation"}, thrown.time);
  v.field({"part", "", "id; -1 if no part was thrown"}, thrown.part);
  v.field({"beside", "", "id of the nearest part before; -1 if only the bin was near"}, thrown.beside);
}

template <class Visitor>
void visit(Visitor& v, EnergyReport& energy) {
  v.field({"gain", "",
           "largest gain of a part between two observations / (its mass * gravity * diagonal of its bounding box)"},
          energy.gain);
  v.field({"time", "s", "simulated time of the observation"}, energy.time);
  v.field({"part", "", "id; -1 if no part gained energy"}, energy.part);
  v.section({"thrown", "", "the part that left others faster than any of them moved"}, energy.thrown);
}

template <class Visitor>
void visit(Visitor& v, WorstReport::Penetration& p) {
  // Unknown depths are null in the file.
  double value = p.known ? p.value : std::nan(""), relative = p.known ? p.relative : std::nan("");
  v.field({"value", "m", "depth; null if the solver does not report the depths of its contacts"}, value);
  v.field({"relative", "", "largest depth / bounding diagonal of the smaller part; null as above"}, relative);
  v.field({"pair", "", "ids; the second is -1 for the bin, both are if nothing overlapped"}, p.pair);
  v.field({"time", "s", "simulated time"}, p.time);
  p.known = std::isfinite(value) && std::isfinite(relative);
  p.value = p.known ? value : 0.0;
  p.relative = p.known ? relative : 0.0;
}

template <class Visitor>
void visit(Visitor& v, WorstReport::EnergyGain& gain) {
  v.field({"relative", "",
           "rise of the energy of all parts together above the least value before / (mass * gravity * diagonal, summed "
           "over the parts that moved)"},
          gain.relative);
  v.field({"time", "s", "simulated time of the observation"}, gain.time);
}

template <class Visitor>
void visit(Visitor& v, WorstReport& worst) {
  v.section({"penetration", "", "the deepest contact, by the solver's own depths"}, worst.penetration);
  v.section({"energy_gain", "", "largest gain of energy of the whole heap"}, worst.energy_gain);
  v.field({"unresolved_impacts", "", "number of sub-steps in which an impact was not solved within the allowed sweeps"},
          worst.unresolved_impacts);
}

template <class Visitor>
void visit(Visitor& v, JamReport& jam) {
  v.field({"ratio", "", "squeezing force / weight of the part and of all that rests on it"}, jam.ratio);
  v.field({"part", "", "id; -1 if no part is squeezed, or if the solver does not report contact forces"}, jam.part);
}

template <class Visitor>
void visit(Visitor& v, Flag& flag) {
  v.field({"code", "", "stable name in snake_case"}, flag.code);
  v.field({"text", "", "description with figures"}, flag.text);
  v.field({"remedy", "", "setting to change, or action to take"}, flag.remedy);
}

template <class Visitor>
void visit(Visitor& v, Report& report) {
  v.field({"at_rest", "", "true if all parts came to rest"}, report.at_rest);
  v.field({"accepted", "", "true if no limit of `accept` is exceeded"}, report.accepted);
  v.field({"reasons", "", "why the scene was not accepted"}, report.reasons);
  v.field({"solver", "", "sphere, sphere/thesis or bullet"}, report.solver);
  v.field({"solver_reason", "", "why `auto` chose it"}, report.solver_reason);
  v.field({"device", "", "GL_RENDERER, or cpu"}, report.device);
  v.field({"finish", "", "settled, pressed or probed: what was done; none: time ran out before"}, report.finish);
  v.field({"simulated_s", "s", "simulated time"}, report.simulated_s);
  v.field({"wall_s", "s", "wall time"}, report.wall_s);
  v.field({"steps", "", "number of time steps"}, report.steps);
  v.field({"stages_ms", "ms", "wall time by stage"}, report.profile.stages_ms);
  v.field({"counters", "", "work done and skipped, by name"}, report.profile.counters);
  v.section({"penetration", "", "overlap depth of the true meshes, over overlapping pairs"}, report.penetration);
  v.section({"gap", "", "free fall of the parts at rest"}, report.gap);
  v.section({"drift", "",
             "displacement of centres of mass in 0.5 s of a second run from rest; there with `drift_check` alone",
             anything, report.drift.measured},
            report.drift);
  v.section({"energy", "", "energy that a part gained without a cause: contacts that throw parts about"},
            report.energy);
  v.section({"worst", "", "the worst of the whole run, not of its end"}, report.worst);
  v.section({"jam", "", "the part that contacts squeeze most, from opposite sides"}, report.jam);
  v.field({"escaped", "", "ids of parts outside the bin, below the floor or not finite"}, report.escaped);
  v.field({"unstable", "", "ids of parts that moved in each check of whether they stand, up to the last one"},
          report.unstable);
  v.field({"not_poured", "", "ids of parts that found no room above the heap"}, report.not_poured);
  Hexadecimal hash{report.state_hash};
  v.field({"state_hash", "", "hash of all final poses, bit for bit"}, hash);
  report.state_hash = hash.value;
  v.list({"flags", "", "remarks with a remedy, such as a mesh that was repaired"}, report.flags);
}

template <class Visitor>
void visit(Visitor& v, ScenePart& part) {
  v.field({"id", "", "the same in every output: TF frame, labels (id + 1), masks, grasps", anything, true, true},
          part.id);
  v.field({"line", "", "index of its line in the request's `parts`"}, part.line);
  v.field({"model", "", "as the request names it", anything, true, true}, part.model);
  v.field({"pose", "m",
           "of the model file's own frame, scaled to metres, in the bin frame; null if the part was not poured or has "
           "been removed",
           anything, true, true},
          part.pose);
  v.field({"state", "", "what became of the part", anything, true, true}, part.state);
  const bool moves = part.velocity.linear != Vec3::Zero() || part.velocity.angular != Vec3::Zero();
  v.field({"velocity", "m/s, rad/s",
           "of the centre of mass in the bin frame when the simulation ended; left out if zero", anything, moves},
          part.velocity);
  v.field({"visible_fraction", "", "visible share of the part's silhouette, by sensor"}, part.visible_fraction);
}

}  // namespace bin_scenes
