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
  v.field({"median", "m", "Median: half of the values are at most this large."}, q.median);
  v.field({"p95", "m", "95 % quantile: 95 % of the values are at most this large."}, q.p95);
  v.field({"max", "m", "Largest value."}, q.max);
}

template <class Visitor>
void visit(Visitor& v, PenetrationReport& p) {
  visit(v, static_cast<Quantiles&>(p));
  v.field({"pair", "", "Ids of the two parts that overlap most. Both are -1 if no parts overlap."}, p.pair);
  v.field({"pairs", "", "Number of pairs of parts that overlap."}, p.pairs);
  v.field(
      {"p95_relative", "",
       "95 % quantile of the penetration of pairs, each divided by the diagonal of the smaller part's bounding box."},
      p.p95_relative);
  v.field({"max_relative", "",
           "Largest penetration of a pair, divided by the diagonal of the smaller part's bounding box."},
          p.max_relative);
  v.field({"bin_median", "m", "Median of the penetration into the bin, over the parts that overlap the bin."},
          p.bin_median);
  v.field({"bin_p95", "m", "95 % quantile of the penetration into the bin, over the parts that overlap the bin."},
          p.bin_p95);
  v.field({"bin_max", "m", "Largest penetration of a part into the bin."}, p.bin_max);
  v.field({"bin_part", "", "Id of the part that overlaps the bin most; -1 if no part does."}, p.bin_part);
}

template <class Visitor>
void visit(Visitor& v, DriftReport& drift) {
  visit(v, static_cast<Quantiles&>(drift));
  v.field({"turn_p95", "rad", "95 % quantile of the rotation of the parts."}, drift.turn_p95);
}

template <class Visitor>
void visit(Visitor& v, EnergyReport::Thrown& thrown) {
  v.field({"ratio", "",
           "Largest ratio of the speed of a part to the speed that the fastest of its neighbours had at the previous "
           "observation (1/60 s before). The speed that gravity adds in this time is subtracted, and a rotation counts "
           "as the speed of the part's outermost point."},
          thrown.ratio);
  v.field({"time", "s", "Simulated time at which the part was thrown."}, thrown.time);
  v.field({"part", "", "Id of the part that was thrown; -1 if no part was."}, thrown.part);
  v.field(
      {"beside", "",
       "Id of the part that was nearest to the thrown part at the previous observation; -1 if only the bin was near."},
      thrown.beside);
}

template <class Visitor>
void visit(Visitor& v, EnergyReport& energy) {
  v.field({"gain", "",
           "Largest energy that a part gained without a cause between two observations (1/60 s), divided by mass * "
           "gravity * diagonal of the part's bounding box."},
          energy.gain);
  v.field({"time", "s", "Simulated time at which the part gained this energy."}, energy.time);
  v.field({"part", "", "Id of the part that gained this energy; -1 if no part gained energy."}, energy.part);
  v.section({"thrown", "", "The part that left its neighbours fastest, compared with the speed that they had before."},
            energy.thrown);
}

template <class Visitor>
void visit(Visitor& v, WorstReport::Penetration& p) {
  // Unknown depths are null in the file.
  double value = p.known ? p.value : std::nan(""), relative = p.known ? p.relative : std::nan("");
  v.field(
      {"value", "m", "Depth of the deepest contact; null if the solver does not report the depths of its contacts."},
      value);
  v.field({"relative", "",
           "Largest depth of a contact, divided by the diagonal of the smaller part's bounding box; null if the solver "
           "does not report the depths of its contacts."},
          relative);
  v.field({"pair", "",
           "Ids of the two bodies in contact. The second id is -1 if it is the bin, and both are -1 if nothing "
           "overlapped."},
          p.pair);
  v.field({"time", "s", "Simulated time of the deepest contact."}, p.time);
  p.known = std::isfinite(value) && std::isfinite(relative);
  p.value = p.known ? value : 0.0;
  p.relative = p.known ? relative : 0.0;
}

template <class Visitor>
void visit(Visitor& v, WorstReport::EnergyGain& gain) {
  v.field({"relative", "",
           "Largest rise of the energy of all parts together above its lowest earlier value, divided by the sum of "
           "mass * gravity * diagonal over the parts that moved."},
          gain.relative);
  v.field({"time", "s", "Simulated time at which the energy had risen by this amount."}, gain.time);
}

template <class Visitor>
void visit(Visitor& v, WorstReport& worst) {
  v.section({"penetration", "", "The deepest contact of the simulation, by the depths that the solver computes."},
            worst.penetration);
  v.section({"energy_gain", "", "The largest rise of the energy of all parts together."}, worst.energy_gain);
  v.field(
      {"unresolved_impacts", "", "Number of sub-steps in which the allowed sweeps did not suffice to solve an impact."},
      worst.unresolved_impacts);
}

template <class Visitor>
void visit(Visitor& v, JamReport& jam) {
  v.field({"ratio", "",
           "Force with which contacts on opposite sides squeeze the part, divided by the weight of the part and of "
           "everything that rests on it."},
          jam.ratio);
  v.field({"part", "",
           "Id of the part that is squeezed most; -1 if no part is squeezed, or if the solver does not report contact "
           "forces."},
          jam.part);
}

template <class Visitor>
void visit(Visitor& v, Flag& flag) {
  v.field({"code", "", "Short name of the remark, in snake_case. It does not change between versions."}, flag.code);
  v.field({"text", "", "Description of what happened, with figures."}, flag.text);
  v.field({"remedy", "", "The setting to change, or the action to take."}, flag.remedy);
}

template <class Visitor>
void visit(Visitor& v, Report& report) {
  v.field({"at_rest", "", "True if all parts came to rest."}, report.at_rest);
  v.field({"accepted", "", "True if the scene exceeds no limit of the section `accept` of the request."},
          report.accepted);
  v.field({"reasons", "", "Reasons why the scene was not accepted; empty if it was."}, report.reasons);
  v.field({"solver", "", "The solver that was used: `sphere`, `sphere/thesis` or `bullet`."}, report.solver);
  v.field({"solver_reason", "", "The reason why `solver.type: auto` chose this solver."}, report.solver_reason);
  v.field({"device", "", "Name of the OpenGL renderer (GL_RENDERER) on which the solver ran, or `cpu`."},
          report.device);
  v.field({"finish", "",
           "How far the scene was settled: `settled`, `pressed` or `probed`; `none` if the time ran out before."},
          report.finish);
  v.field({"simulated_s", "s", "Simulated time."}, report.simulated_s);
  v.field({"wall_s", "s", "Wall-clock time."}, report.wall_s);
  v.field({"steps", "", "Number of time steps."}, report.steps);
  v.field({"stages_ms", "ms", "Wall-clock time of each stage of the computation."}, report.profile.stages_ms);
  v.field({"counters", "", "Counts of work that was done or skipped, by name."}, report.profile.counters);
  v.section(
      {"penetration", "", "Penetration (depth of overlap) of the true meshes, over all pairs of parts that overlap."},
      report.penetration);
  v.section({"gap", "", "Distances by which the parts at rest could fall along gravity before they touch something."},
            report.gap);
  v.section({"drift", "",
             "Displacement of the centres of mass while the same solver continues from the scene at rest for 0.5 s. It "
             "is present only with `drift_check: true`.",
             anything, report.drift.measured},
            report.drift);
  v.section(
      {"energy", "",
       "Audit of energy: the part that gained the most energy without a cause, which means that contacts threw it."},
      report.energy);
  v.section({"worst", "", "The worst values of the whole simulation, not only of its end."}, report.worst);
  v.section({"jam", "", "The part that contacts on opposite sides squeeze most."}, report.jam);
  v.field({"escaped", "", "Ids of the parts that are outside the bin or below the floor, or whose pose is not finite."},
          report.escaped);
  v.field({"unstable", "",
           "Ids of the parts that moved in every check of whether they stay at rest, including the last one."},
          report.unstable);
  v.field({"not_poured", "", "Ids of the parts that found no room above the heap."}, report.not_poured);
  Hexadecimal hash{report.state_hash};
  v.field({"state_hash", "",
           "Hash of all final poses. If two scenes have the same hash, their poses are equal bit for bit."},
          hash);
  report.state_hash = hash.value;
  v.list({"flags", "", "Remarks with a remedy, for example about a mesh that was repaired."}, report.flags);
}

template <class Visitor>
void visit(Visitor& v, ScenePart& part) {
  v.field({"id", "",
           "Number of the part. It is the same in every output: in the TF frame, in labels (as id + 1), in masks and "
           "in grasps.",
           anything, true, true},
          part.id);
  v.field({"line", "", "Index of the entry of the request's list `parts` from which the part was made."}, part.line);
  v.field({"model", "", "Path of the model as the request states it.", anything, true, true}, part.model);
  v.field({"pose", "m",
           "Pose of the model file's own frame, scaled to metres, in the bin frame. It is null if the part was not "
           "poured or has been removed.",
           anything, true, true},
          part.pose);
  v.field({"state", "", "State of the part at the end of the simulation.", anything, true, true}, part.state);
  v.field(
      {"distractor", "", "True for a part without a label. It is left out for other parts.", anything, part.distractor},
      part.distractor);
  const bool moves = part.velocity.linear != Vec3::Zero() || part.velocity.angular != Vec3::Zero();
  v.field({"velocity", "m/s, rad/s",
           "Velocity of the centre of mass and angular velocity, in the bin frame, when the simulation ended. It is "
           "left out if it is zero.",
           anything, moves},
          part.velocity);
  v.field({"visible_fraction", "", "Share of the part's silhouette that is visible, for each sensor."},
          part.visible_fraction);
}

}  // namespace bin_scenes
