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
  v.field({"bias", "",
           "Constant that is added to the weighted columns of the score. A larger value raises all scores. The default "
           "is -0.4 for fingers and -1.4 for suction cups."},
          w.bias);
  v.field({"holding", "",
           "Weight of the logarithm of the column `safety`, which is the factor by which the forces of the lift could "
           "grow before the part slips or turns in the gripper. The factor is limited to the range from 1/6 to 6. The "
           "default is 1 for fingers and 5.8 for suction cups."},
          w.holding);
  v.field({"sliding", "",
           "Weight of the logarithm of the column `sliding`, which is the factor by which the forces of the lift could "
           "grow before the part slides out of the gripper, even if it turns before. The factor is limited to the "
           "range from 1/6 to 6. The default is 2.3 for fingers and 1.7 for suction cups."},
          w.sliding);
  v.field(
      {"antipodal", "",
       "Weight of the column `antipodal`. For fingers, it is 1 - coefficient of friction that is needed / coefficient "
       "that is present; for suction cups, 1 - gap under the lip / largest gap that the lip can close."},
      w.antipodal);
  v.field({"moment", "",
           "Weight of the column `moment`, which is 1 - sqrt(moment of the part's weight about the contact / largest "
           "moment that the grasp can hold)."},
          w.moment);
  v.field({"overlap", "",
           "Weight of the column `overlap`. It grows with the share of the pads that touches the part or, for suction "
           "cups, with the distance of the ring from edges and holes."},
          w.overlap);
  v.field({"upright", "", "Weight of the column `upright`, which is 1 for a vertical and 0 for a horizontal approach."},
          w.upright);
  v.field({"clearance", "",
           "Weight of the column `clearance`, which is the free room around the gripper. It is 1 if four times the "
           "distance in the gripper's key `clearance` is free."},
          w.clearance);
  v.field({"closing", "",
           "Weight of the column `closing`, which is 1 - distance of the closed fingers / `stroke`, and 1 for suction "
           "cups."},
          w.closing);
  v.field({"seen", "",
           "Weight of the column `seen`, which is the largest share of the contact points that one camera sees."},
          w.seen);
  v.field({"measured", "",
           "Weight of the column `measured`, which is the largest share of the contact points for which one camera "
           "measured a depth."},
          w.measured);
}

/// Lengths of fingers, cup and palm.
template <class Visitor>
void visit_lengths(Visitor& v, Gripper& g) {
  v.field({"finger_width", "m",
           "Only for `parallel`: width of a finger and of its pad, perpendicular to the directions of closing and "
           "approach.",
           above(0.0)},
          g.finger_width);
  v.field({"finger_depth", "m", "Distance from the palm to the finger tips, or to the ring of the suction cup.",
           above(0.0)},
          g.finger_depth);
  v.field(
      {"finger_thickness", "m", "Only for `parallel`: thickness of a finger in the direction of closing.", above(0.0)},
      g.finger_thickness);
  v.field({"finger_mesh", "",
           "Only for `parallel`: path of a mesh file with the shape of the finger at +x, in the gripper frame when the "
           "pads are closed. The pad must be in the plane x = 0 and the tip at z = `pad_length` / 2. The other finger "
           "has the same shape, turned by 180 degrees about z. Collisions are computed with boxes around slices of the "
           "mesh, and proofs use the mesh itself. `finger_width` and `pad_length` then describe only the pad, and "
           "`finger_thickness` is the distance from the pad to the outer pad.",
           anything, !g.finger_mesh.empty()},
          g.finger_mesh);
  v.field({"finger_mesh_scale", "m",
           "Length of one unit of the file `finger_mesh`. For example, 0.001 means that the file is in millimetres.",
           above(0.0, 1e3), !g.finger_mesh.empty()},
          g.finger_mesh_scale);
  v.field(
      {"pad_length", "m", "Only for `parallel`: length of the pad, from the finger tip towards the palm.", above(0.0)},
      g.pad_length);
  v.field({"pad_give", "m",
           "Only for `parallel`: depth by which the surface of a pad yields. All parts of a surface within this depth "
           "are in contact with the pad.",
           above(0.0)},
          g.pad_give);
  v.field({"radius", "m", "Only for `suction`: radius of the ring with which the cup touches a surface.", above(0.0)},
          g.radius);
  v.field({"lip", "m", "Only for `suction`: largest gap that the lip of the cup can close.", above(0.0)}, g.lip);
  v.field({"stiffness", "N/m",
           "Only for `suction`: stiffness of the lip. If the lip is bent to close a gap, the force of the vacuum "
           "decreases by stiffness * gap.",
           at_least(0.0)},
          g.stiffness);
  v.field({"palm", "m",
           "Size of the box behind the fingers: in the direction of closing, perpendicular to closing and approach, "
           "and in the direction of approach.",
           above(0.0, 1e4)},
          g.palm);
}

/// Names and shape.
template <class Visitor>
void visit_shape(Visitor& v, Gripper& g) {
  v.field({"name", "", "Name of the gripper in the outputs. If it is not given, it is the name of the preset."},
          g.name);
  v.field({"preset", "",
           "Name of a file in `config/grippers`. The values in this file are the defaults of the other keys of this "
           "gripper.",
           anything, false},
          g.preset);
  v.field({"type", "",
           "Kind of gripper. `parallel`: two fingers that close along a line. `suction`: one round suction cup."},
          g.type);
  v.field({"stroke", "m",
           "For `parallel`: largest distance between the pads; the default is 0.05. For `suction`: distance by which "
           "the bellows can be compressed on a tilted surface; the default is `radius` / 2.",
           above(0.0)},
          g.stroke);
  v.field({"opening", "m",
           "Only for `parallel`: distance of each finger from the part before the fingers close. It is smaller if the "
           "stroke does not suffice.",
           at_least(0.0)},
          g.opening);
  visit_lengths(v, g);
}

template <class Visitor>
void visit(Visitor& v, Gripper& g) {
  visit_shape(v, g);
  v.field({"force", "N", "Force of each finger, or of the vacuum.", above(0.0, 1e5)}, g.force);
  v.field({"friction", "",
           "Coefficient of friction of the pads, or of the ring of a suction cup. The coefficient of a contact is "
           "sqrt(gripper * part).",
           above(0.0, 10.0)},
          g.friction);
  v.field(
      {"clearance", "m", "Smallest allowed distance of the gripper from other parts and from the bin.", at_least(0.0)},
      g.clearance);
  v.field({"finger_clearance", "m",
           "Only for `parallel`: smallest allowed gap between each opened finger and the part. A part can therefore be "
           "at most `stroke` - 2 * `finger_clearance` wide.",
           at_least(0.0)},
          g.finger_clearance);
  v.field({"margin", "m", "Only for `suction`: smallest allowed distance of the ring from edges and holes of the part.",
           at_least(0.0)},
          g.margin);
  v.field({"inner", "",
           "Only for `parallel`: if true, the gripper may also hold a part from within, for example a ring or a tube. "
           "The fingers then press outwards, and their outer faces are pads as well."},
          g.inner);
  v.field({"tool_rotation", "rad",
           "Rotation of the gripper frame relative to the flange of the robot, for example because of a bent tool: "
           "roll, pitch and yaw about fixed axes. The palm has the axes of the flange.",
           at_least(-7.0, 7.0)},
          g.tool_rotation);
  v.field(
      {"acceleration", "m/s2", "Acceleration of the gripper during the lift, also in proofs. It is added to gravity.",
       at_least(0.0, 100.0)},
      g.acceleration);
  v.field({"tilt", "rad", "Largest allowed angle between the direction of approach and gravity.", at_least(0.0, 3.2)},
          g.tilt);
  v.field({"most", "",
           "Number of grasps of a part that are tried in every scene. A larger number adds grasps and removes none.",
           at_least(1.0, 100000.0)},
          g.most);
  v.field({"free_wanted", "",
           "Number of free grasps of a part after which the search for further grasps in the scene ends. Only parts "
           "that can be lifted are searched, and vertical approaches are tried first. With 0, there is no search.",
           at_least(0.0, 10000.0)},
          g.free_wanted);
  v.field({"tries", "",
           "Number of poses around a part after which the search for grasps in the scene ends in any case. A larger "
           "number takes more time, and fewer parts remain without a grasp.",
           at_least(1.0, 1e6)},
          g.tries);
  v.section({"score", "", "Weights with which the score of a grasp is computed from its columns."}, g.score);
}

}  // namespace bin_scenes
