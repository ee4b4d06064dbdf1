/// The table of the keys of grippers; see scene/keys.hpp. Reading, checking, messages and the generated page use it.
#pragma once

#include "bin_scenes/scene/gripper.hpp"
#include "bin_scenes/scene/key.hpp"

namespace bin_scenes {

inline Names<Gripper::Type> names(Gripper::Type) {
  return {{"parallel", Gripper::Type::parallel}, {"suction", Gripper::Type::suction}};
}

template <class Visitor>
void visit(Visitor& v, ScoreWeights& w) {
  v.field({"bias", "", "added to the weighted columns; larger values raise all scores; default -0.4, of cups -1.4"},
          w.bias);
  v.field({"holding", "",
           "weight of ln(safety factor against slipping and turning); factors are limited to 1/6 and 6; default 1, of "
           "cups 5.8"},
          w.holding);
  v.field({"sliding", "",
           "weight of ln(safety factor against sliding alone, even if the part turns); factors are limited likewise; "
           "default 2.3, of cups 1.7"},
          w.sliding);
  v.field({"antipodal", "", "weight of the share of friction, or of the lip, that the shape of the contact leaves"},
          w.antipodal);
  v.field({"moment", "", "weight of 1 - sqrt(moment of the weight about the contact / moment that the grasp can hold)"},
          w.moment);
  v.field({"overlap", "", "weight of the share of the pads that is in contact, or of the margin around a cup's ring"},
          w.overlap);
  v.field({"upright", "", "weight of 1 - angle of approach and gravity / 90 degrees"}, w.upright);
  v.field({"clearance", "", "weight of the room around the gripper, which is 1 if four times the clearance is free"},
          w.clearance);
  v.field({"closing", "", "weight of 1 - distance of the fingers / stroke"}, w.closing);
  v.field({"seen", "", "weight of the share of the contact that the best camera sees"}, w.seen);
  v.field({"measured", "", "weight of the share of the contact that the best camera measured"}, w.measured);
}

/// Names and lengths.
template <class Visitor>
void visit_shape(Visitor& v, Gripper& g) {
  v.field({"name", "", "name in the outputs; left out: that of the preset"}, g.name);
  v.field({"preset", "", "name of a file of config/grippers whose values are the defaults here", anything, false},
          g.preset);
  v.field({"type", "", "two fingers that close along a line, or a round cup"}, g.type);
  v.field({"stroke", "m",
           "parallel: largest distance of the pads, default 0.05; suction: give of the bellows on a tilted surface, "
           "default radius / 2",
           above(0.0)},
          g.stroke);
  v.field(
      {"opening", "m", "parallel: distance of each finger from the part before it closes, as far as the stroke permits",
       at_least(0.0)},
      g.opening);
  v.field({"finger_width", "m", "parallel: width of finger and pad, perpendicular to closing and approach", above(0.0)},
          g.finger_width);
  v.field({"finger_depth", "m", "distance from the palm to the finger tips or to the ring", above(0.0)},
          g.finger_depth);
  v.field({"finger_thickness", "m", "parallel: thickness of a finger along the closing direction", above(0.0)},
          g.finger_thickness);
  v.field(
      {"finger_mesh", "",
       "parallel: mesh file of the finger at +x, in the gripper's frame with closed pads: its pad lies in the plane "
       "x = 0, its tip at z = pad_length / 2; the other finger is the same, turned by half about z. It replaces the "
       "box of the finger for collisions (by boxes around slices of it) and in proofs; finger_width and pad_length "
       "describe its pad, finger_thickness the distance of its outer pad",
       anything, !g.finger_mesh.empty()},
      g.finger_mesh);
  v.field({"finger_mesh_scale", "m", "length of one unit of finger_mesh; 0.001: the mesh is in mm", above(0.0, 1e3),
           !g.finger_mesh.empty()},
          g.finger_mesh_scale);
  v.field({"pad_length", "m", "parallel: length of the pad, from the tip towards the palm", above(0.0)}, g.pad_length);
  v.field({"pad_give", "m", "parallel: the pad yields by this depth; all of the surface within it is in contact",
           above(0.0)},
          g.pad_give);
  v.field({"radius", "m", "suction: radius of the ring", above(0.0)}, g.radius);
  v.field({"lip", "m", "suction: largest gap that the lip can close", above(0.0)}, g.lip);
  v.field({"stiffness", "N/m", "suction: stiffness of the lip; pressed into a gap, it reduces the force of the vacuum",
           at_least(0.0)},
          g.stiffness);
  v.field({"palm", "m", "box behind the fingers: length along closing, perpendicular to both, along approach",
           above(0.0, 1e4)},
          g.palm);
}

template <class Visitor>
void visit(Visitor& v, Gripper& g) {
  visit_shape(v, g);
  v.field({"force", "N", "force of each finger, or of the vacuum", above(0.0, 1e5)}, g.force);
  v.field({"friction", "", "coefficient of pad or ring; the coefficient of a pair is sqrt(gripper * part)",
           above(0.0, 10.0)},
          g.friction);
  v.field({"clearance", "m", "smallest distance of the gripper from other parts and the bin", at_least(0.0)},
          g.clearance);
  v.field({"finger_clearance", "m",
           "parallel: smallest gap between each opened finger and the part; a part can be at most stroke - 2 * "
           "finger_clearance wide",
           at_least(0.0)},
          g.finger_clearance);
  v.field({"margin", "m", "suction: smallest distance of the ring from edges and holes", at_least(0.0)}, g.margin);
  v.field(
      {"inner", "",
       "parallel: true: also grasps from within, for example of rings and tubes, by fingers that expand; their outer "
       "faces are pads as well"},
      g.inner);
  v.field(
      {"tool_rotation", "rad",
       "roll, pitch, yaw (about fixed axes) of the gripper's frame in that of the robot's flange, as of a bent tool; "
       "the palm has the flange's axes",
       at_least(-7.0, 7.0)},
      g.tool_rotation);
  v.field(
      {"acceleration", "m/s2", "acceleration of the lift, also in proofs; it adds to gravity", at_least(0.0, 100.0)},
      g.acceleration);
  v.field({"tilt", "rad", "largest angle between approach and gravity", at_least(0.0, 3.2)}, g.tilt);
  v.field({"most", "", "grasps of a part that every scene tries; a larger value adds grasps and removes none",
           at_least(1.0, 100000.0)},
          g.most);
  v.field({"free_wanted", "",
           "number of free grasps after which the search in the scene around a part that can be lifted ends; it tries "
           "vertical approaches first; 0: no search",
           at_least(0.0, 10000.0)},
          g.free_wanted);
  v.field({"tries", "",
           "number of poses after which that search ends in any case; more = slower, fewer parts without a grasp",
           at_least(1.0, 1e6)},
          g.tries);
  v.section({"score", "", "weights of the columns of a grasp in its score"}, g.score);
}

}  // namespace bin_scenes
