/// The table of request keys: every key once, with its field, unit, meaning, range and the consequence of changing it.
/// Reading, writing back, `--set`, suggestions for unknown keys, check() and docs/use/request.md all come from visiting
/// it; the default of a key is the value of its field in a default-constructed struct (scene/request.hpp). Keys of
/// surfaces, solvers, grippers and sensors are in surface_keys.hpp, solver_keys.hpp, gripper_keys.hpp and
/// sensor/sensor_keys.hpp.
///
/// A visitor has  field(Key, value&)          one value
///                section(Key, struct&)       a map of further keys
///                list(Key, vector<struct>&)  a list of maps
#pragma once

#include "bin_scenes/scene/key.hpp"
#include "bin_scenes/scene/request.hpp"
#include "scene/gripper_keys.hpp"
#include "scene/solver_keys.hpp"
#include "scene/surface_keys.hpp"

namespace bin_scenes {

inline Names<Unit> names(Unit) {
  return {{"m", Unit::metre}, {"cm", Unit::centimetre}, {"mm", Unit::millimetre}, {"inch", Unit::inch}};
}
inline Names<Pour::Pattern> names(Pour::Pattern) {
  return {{"rain", Pour::Pattern::rain}, {"grid", Pour::Pattern::grid}, {"given", Pour::Pattern::given}};
}
inline Names<Pour::Finish> names(Pour::Finish) {
  return {{"settled", Pour::Finish::settled}, {"pressed", Pour::Finish::pressed}, {"probed", Pour::Finish::probed}};
}
template <class Visitor>
void visit(Visitor& v, Motion& motion) {
  v.field({"times", "s",
           "Times at which the body reaches each of the `poses`, in ascending order, counted from the start of the "
           "motion. Motion is available neither with the preset `thesis` nor with the device `gpu`.",
           above(0.0, 1e5)},
          motion.times);
  v.field({"poses", "m",
           "Poses of the body at the `times`, relative to its initial pose and in the directions that the axes of the "
           "bin frame have at the start. The movement between them is smooth, and begins and ends at rest. A bin must "
           "be upright at the end. Poses of parts are always relative to the bin, even if it moves."},
          motion.poses);
  v.field(
      {"shake", "m", "Amplitude of a sinusoidal displacement along the x, y and z axes of the bin frame at the start.",
       at_least(-100.0, 100.0)},
      motion.shake);
  v.field({"tilt", "rad",
           "Amplitude of a sinusoidal rotation about the origin of the body's frame. The direction of this vector is "
           "the axis of rotation, and its length is the largest angle.",
           at_least(-M_PI, M_PI)},
          motion.tilt);
  v.field({"frequency", "Hz",
           "Frequency of `shake` and `tilt`. Their amplitude grows during the first period and decreases during the "
           "last one.",
           above(0.0, 100.0)},
          motion.frequency);
  v.field({"belt", "m/s",
           "Velocity of the surface of a part that does not move itself, such as a conveyor belt, in the bin frame. A "
           "bin cannot have a belt.",
           at_least(-100.0, 100.0)},
          motion.belt);
  v.field({"seconds", "s", "Duration of `shake`, `tilt` and `belt`.", above(0.0, 1e5)}, motion.seconds);
}

/// The kind of bin is not a key of its own: it follows from which of inner_size, mesh, floor and none is there.
struct BinKeys {
  bool floor = false, none = false;
  explicit BinKeys(const Bin& bin) : floor(bin.kind == Bin::Kind::floor), none(bin.kind == Bin::Kind::none) {}
};

template <class Visitor>
void visit(Visitor& v, Bin& bin) {
  using Kind = Bin::Kind;
  const bool box = bin.kind == Kind::box, mesh = bin.kind == Kind::mesh;
  BinKeys kind(bin);
  v.field({"inner_size", "m", "Size of a bin that is a box: inner length (x), inner width (y) and inner height (z).",
           above(0.0, 1000.0), box},
          bin.inner_size);
  v.field({"wall_thickness", "m",
           "Thickness of the walls and the floor of a bin that is a box. Only cameras see it; the simulation of the "
           "parts does not depend on it.",
           at_least(0.0, 10.0), box},
          bin.wall_thickness);
  v.field({"mesh", "",
           "Path of a mesh file that is the bin, instead of a box. The walls of the mesh must have a thickness. The "
           "path is written as in `parts[].model`.",
           anything, mesh},
          bin.mesh);
  v.field({"unit", "", "Unit of length of the mesh file of the bin.", anything, mesh}, bin.unit);
  v.field({"pose", "",
           "Pose of the frame of the bin's mesh file in the bin frame. If it is not given, both frames are the same.",
           anything, mesh},
          bin.pose);
  v.field({"floor", "", "If true, the bin is an endless floor at z = 0 without walls.", anything, kind.floor},
          kind.floor);
  v.field({"none", "", "If true, there is no bin, and the parts move freely.", anything, kind.none}, kind.none);
  v.field({"friction", "",
           "Coefficient of friction of the walls and the floor. The coefficient of a contact is sqrt(part * bin).",
           at_least(0.0, 10.0)},
          bin.friction);
  v.field({"restitution", "",
           "Coefficient of restitution of the walls and the floor: the speed after an impact divided by the speed "
           "before it. A contact uses the larger value of part and bin.",
           at_least(0.0, 1.0)},
          bin.restitution);
  v.section({"surface", "",
             "Optical properties of the walls and the floor. The simulation of the parts does not depend on them."},
            bin.surface);
  v.section({"motion", "",
             "Motion of the bin. It begins when all parts are in the bin and slow; when it has ended, the heap settles "
             "again.",
             anything, bin.motion.any()},
            bin.motion);
  v.bin_kind(bin, kind);
}

template <class Visitor>
void visit(Visitor& v, Table& table) {
  v.field({"height", "m",
           "Height of the table, as z in the bin frame. The lower side of a bin that is a box is at -`wall_thickness`. "
           "Without this key, there is no table.",
           at_least(-100.0, 100.0)},
          table.height);
  v.section({"surface", "", "Optical properties of the table."}, table.surface);
  v.field({"mottle", "",
           "Largest deviation of the albedo from its mean, divided by the mean. The table has lighter and darker "
           "patches, which differ between scenes.",
           at_least(0.0, 1.0)},
          table.mottle);
  v.field({"patch", "m", "Size of the largest patches.", above(0.0, 100.0)}, table.patch);
}

template <class Visitor>
void visit(Visitor& v, Tessellation& fine) {
  v.field({"chord", "m",
           "Largest distance between the triangles and the true surface. If it is not given, it is 0.0002 times the "
           "diagonal of the part's bounding box.",
           above(0.0, 1.0)},
          fine.chord);
  v.field({"angle", "rad",
           "Largest angle between neighbouring triangles of a curved surface. Smaller angles represent small fillets "
           "more exactly.",
           at_least(0.01, 1.0)},
          fine.angle);
}

/// The model of a part line, and how many parts of which mass are made from it.
template <class Visitor>
void visit_model(Visitor& v, PartLine& part) {
  v.field(
      {"model", "",
       "Path of a mesh or CAD file (STL, OBJ, PLY, DAE, OFF, STEP or IGES): relative to the request, absolute, or "
       "`package://name/path`. The model must be a closed solid. Holes with a perimeter of at most 2 % of the diagonal "
       "of the model are closed, and the report states this. Larger holes are an error unless `thickness` is given.",
       anything, true, true},
      part.model);
  v.field({"unit", "",
           "Unit of length of the model file. If it is not given, the unit that the file states is used, or metres if "
           "it states none. If the size of the model is then implausible for the bin, an error names the likely unit."},
          part.unit);
  v.field(
      {"scale", "", "Factor by which the size of the model is multiplied, in addition to its unit.", above(0.0, 1e6)},
      part.scale);
  v.field({"count", "", "Number of parts that are made from this model. The computing time grows with it.",
           at_least(1.0, 1e6)},
          part.count);
  v.field({"density", "kg/m3",
           "Density of a part, from which its mass is computed as density * volume of the mesh. It is 1000 if neither "
           "`density` nor `mass` is given.",
           above(0.0, 1e5)},
          part.density);
  v.field({"mass", "kg", "Mass of one part. Give either `mass` or `density`.", above(0.0, 1e6)}, part.mass);
}

template <class Visitor>
void visit(Visitor& v, PartLine& part) {
  visit_model(v, part);
  v.field({"friction", "",
           "Coefficient of friction of the parts. The coefficient of a contact between bodies with the values a and b "
           "is sqrt(a * b).",
           at_least(0.0, 10.0)},
          part.friction);
  v.field({"restitution", "",
           "Coefficient of restitution of the parts: the speed after an impact divided by the speed before it. A "
           "contact uses the larger value of its two bodies. With large values, parts take longer to come to rest.",
           at_least(0.0, 1.0)},
          part.restitution);
  v.field({"thickness", "m",
           "Thickness of the walls that an open surface is given to make it a solid. Without this key, a model that is "
           "an open surface is an error.",
           above(0.0, 1.0)},
          part.thickness);
  v.section({"tessellation", "",
             "Settings that determine how finely the surfaces of a STEP or IGES file are divided into triangles.",
             anything, part.tessellation.given()},
            part.tessellation);
  v.field({"solid", "",
           "Name of the solid that is read from a STEP or IGES file. If it is not given, all solids of the file are "
           "read as one part, and they must touch each other.",
           anything, !part.solid.empty()},
          part.solid);
  v.field({"poses", "m",
           "Start poses of the model frame in the bin frame, one for each part: position (m) and quaternion. They are "
           "required for fixed parts and, unless `pour.scene` is given, with `pour.pattern: given`.",
           anything, !part.poses.empty()},
          part.poses);
  v.field({"velocities", "m/s, rad/s",
           "Start velocities in the bin frame, one for each of the `poses`: velocity of the centre of mass (m/s) and "
           "angular velocity (rad/s). If they are not given, the parts start at rest.",
           at_least(-1e4, 1e4), !part.velocities.empty()},
          part.velocities);
  v.field({"fixed", "",
           "If true, the parts are obstacles, for example dividers or fixtures, that stay at the given `poses` or "
           "follow their `motion`."},
          part.fixed);
  v.field({"distractor", "",
           "If true, the parts have no label: label images contain 0 where they are seen, and the ground truth of BOP "
           "does not list them. They are simulated and seen like other parts, and hide them. Distractors must be the "
           "last entries of the list.",
           anything, part.distractor},
          part.distractor);
  v.field({"on_table", "m",
           "If it is above 0, the parts do not enter the bin. They lie on the table around it in stable poses, which "
           "are drawn from the seed, and do not move. Seen from above, the gap between the bin and the circle around "
           "a part is at most this wide.",
           at_least(0.0, 100.0), part.on_table != 0.0},
          part.on_table);
  v.section(
      {"surface", "", "Optical properties of the parts. The simulation of their movement does not depend on them."},
      part.surface);
  v.section(
      {"motion", "", "Motion of a fixed part that nothing can stop or deflect, for example a pusher or a conveyor.",
       anything, part.motion.any()},
      part.motion);
}

template <class Visitor>
void visit(Visitor& v, Pour& pour) {
  // Poses read from an earlier scene are in the part lines by then: the request that is written back needs no other
  // file.
  v.field({"pattern", "",
           "How the parts enter the bin. `rain`: one after the other, just above the heap as it grows. `grid`: all at "
           "the same time, on a three-dimensional grid above the bin. `given`: at start poses that the entries of "
           "`parts` or the key `scene` give."},
          pour.pattern);
  v.field({"finish", "",
           "Last stage of settling before a scene counts as finished. `settled`: the parts come to rest on soft "
           "contacts, and rest again after the contact forces were forgotten once. `pressed`: before that, stiff "
           "contacts remove the overlap of the parts. `probed`: in addition, the heap must stay at rest each time that "
           "the forces are forgotten, with 90 % of the friction, which takes up to twice the time of `pressed`. With "
           "the solver `bullet`, all three mean that the parts are at rest."},
          pour.finish);
  v.field({"drop_height", "m",
           "For the pattern `rain`: height above the heap from which each part falls. Larger heights cause harder "
           "impacts and longer simulations.",
           at_least(0.0, 100.0)},
          pour.drop_height);
  v.field({"grid_spacing", "",
           "For the pattern `grid`: edge length of a cell of the grid divided by the diameter of the largest part's "
           "bounding sphere.",
           at_least(1.0, 100.0)},
          pour.grid_spacing);
  v.field({"scene", "",
           "For the pattern `given`: path of the `scene.json` of an earlier scene that is continued. The request must "
           "list the same models in the same order as the request of that scene. Parts that had escaped are left out.",
           anything, false},
          pour.scene);
  v.field({"limit", "s",
           "Simulated time after which the simulation ends even if parts still move. The scene is then not at rest.",
           above(0.0, 1e5)},
          pour.limit);
  v.field({"rest_window", "s",
           "Simulated time during which a part must not move to count as at rest. A longer time makes rest more "
           "certain and simulations longer.",
           above(0.0)},
          pour.rest_window);
  v.field({"rest_move", "",
           "Largest displacement of a part during `rest_window` that still counts as rest, divided by the diagonal of "
           "the part's bounding box.",
           above(0.0, 1.0)},
          pour.rest_move);
  v.field({"rest_turn", "rad", "Largest rotation of a part during `rest_window` that still counts as rest.",
           above(0.0, 3.2)},
          pour.rest_turn);
}

template <class Visitor>
void visit(Visitor& v, Acceptance& accept) {
  v.field({"penetration", "",
           "Largest allowed penetration of two parts, or of a part and the bin, divided by the diagonal of the smaller "
           "part's bounding box. A scene that exceeds this limit is rejected (set apart).",
           at_least(0.0, 1.0)},
          accept.penetration);
  v.field({"gap", "",
           "Largest distance by which a part at rest may be able to fall before it touches something, divided by the "
           "diagonal of its bounding box. A scene that exceeds this limit is rejected (set apart).",
           at_least(0.0, 1.0)},
          accept.gap);
  v.field({"energy", "",
           "Largest allowed energy that a part gains without a cause between two observations (1/60 s), divided by "
           "mass * gravity * diagonal of the part's bounding box. A larger gain means that contacts threw the part, "
           "and the scene is rejected (set apart).",
           at_least(0.0)},
          accept.energy);
  v.field({"speed", "",
           "Largest allowed ratio of the speed of a part to the speed that the fastest of its neighbours had 1/60 s "
           "before; the speed that gravity adds in this time is subtracted. A larger ratio means that contacts threw "
           "the part, and the scene is rejected (set apart).",
           at_least(1.0)},
          accept.speed);
  v.field({"worst_penetration", "",
           "Largest allowed depth of a contact at any time of the simulation, as the solver computes it, divided by "
           "the diagonal of the smaller part's bounding box. If a contact is deeper, parts may have passed into each "
           "other, and the scene is rejected (set apart).",
           at_least(0.0, 1.0)},
          accept.worst_penetration);
  v.field({"worst_energy_gain", "",
           "Largest allowed rise of the energy of all parts together above an earlier value, divided by the sum of "
           "mass * gravity * diagonal over the parts that moved. A larger rise means that contacts created energy, and "
           "the scene is rejected (set apart).",
           at_least(0.0)},
          accept.worst_energy_gain);
  v.field({"jam", "",
           "Largest allowed force with which contacts on opposite sides squeeze a part, divided by the weight of the "
           "part and of everything that rests on it. A larger force means that the collision shape fills a gap of the "
           "true part, and the scene is rejected (set apart).",
           at_least(1.0)},
          accept.jam);
  v.field({"escaped", "",
           "If true, scenes are accepted even if parts have escaped, which means that they are outside the bin or "
           "below the floor."},
          accept.escaped);
  v.field(
      {"unstable", "", "If true, scenes are accepted even if parts moved in every check of whether they stay at rest."},
      accept.unstable);
}

/// What sees and grasps the parts of a scene.
template <class Visitor>
void visit_sensors_and_grippers(Visitor& v, Request& request) {
  v.list({"sensors", "", "Sensors that see each scene. Without sensors, no images are made."}, request.sensors);
  v.field({"rig", "",
           "Name of a preset that contains all sensors of a published data set: `ipd`, `xyzibd` or `itoddmv`. It "
           "replaces `sensors`. The files in `config/sensors/rigs` state their sources. Single values are changed with "
           "the option `--set`, or with `draw` in a plan.",
           anything, false},
          request.rig);
  v.list({"grippers", "",
          "Grippers for which the output format `grasps` computes grasps. Each entry is a map of keys, or the name of "
          "a preset.",
          anything, !request.grippers.empty()},
         request.grippers);
  v.field({"prove", "",
           "Number of free grasps of a scene whose lift is simulated. They are chosen from the whole range of scores. "
           "The default is 0.",
           at_least(0.0, 1e5), request.prove > 0},
          request.prove);
  v.field({"prove_all", "", "If true, `prove` also chooses grasps of blocked parts and grasps that would slip.",
           anything, request.prove > 0},
          request.prove_all);
  v.field({"lift_cone", "rad",
           "Largest allowed angle between a lift and the vertical. A grasped part that cannot be lifted straight up is "
           "lifted along the free direction within this angle that is nearest to the vertical. The default is 0: parts "
           "are lifted straight up only.",
           at_least(0.0, 1.2), !request.grippers.empty()},
          request.lift_cone);
  v.field({"slight_overlap", "",
           "Share of a part's footprint that other parts may cover while the part still counts as free to be lifted. "
           "With 0, only parts that nothing covers count as free. The default is 0.03.",
           at_least(0.0, 1.0), !request.grippers.empty()},
          request.slight_overlap);
}

template <class Visitor>
void visit(Visitor& v, Request& request) {
  v.field({"seed", "",
           "Seed of all random numbers. The same request and seed give the same scene, bit for bit, on all machines of "
           "one device class. 0 is a seed like any other.",
           at_least(0.0)},
          request.seed);
  v.field({"scenes", "", "Number of scenes that are generated.", at_least(1.0, 1e9)}, request.scenes);
  v.field({"first", "",
           "Index of the first scene. Scene i depends only on the seed and on i, so that a job can be divided into "
           "several.",
           at_least(0.0, 1e9)},
          request.first);
  v.section({"bin", "",
             "The container of the parts. The origin of the bin frame is the centre of the floor's top surface, and z "
             "points up."},
            request.bin);
  v.section({"table", "",
             "An endless plane below the bin. All sensors see it: it has depth, and its label is 0. The simulation "
             "does not contain it.",
             anything, request.table.height.has_value() || request.table.mottle > 0.0},
            request.table);
  v.field({"gravity", "m/s2", "Acceleration of gravity in the bin frame.", at_least(-1e4, 1e4)}, request.gravity);
  v.list({"parts", "", "Models of which parts are made and poured. Several entries give a mixed bin.", anything, true,
          true},
         request.parts);
  v.section({"pour", "", "How the parts enter the bin, and when they count as at rest."}, request.pour);
  v.section({"solver", "", "The solver that simulates the movement of the parts, and its settings."}, request.solver);
  visit_sensors_and_grippers(v, request);
  v.section({"accept", "",
             "Limits that a scene must meet to be accepted. Other scenes are rejected (set apart), and their report "
             "states the reasons."},
            request.accept);
  v.field({"seconds", "s",
           "Simulated time. If it is given, exactly this time is simulated, whether or not the parts are at rest.",
           above(0.0, 1e5)},
          request.seconds);
  v.field({"drift_check", "",
           "If true, the same solver continues from the scene at rest for 0.5 s, and the report states how far parts "
           "move. This does not predict how far they move in other physics engines."},
          request.drift_check);
  v.field({"memory_budget", "byte",
           "Largest amount of memory that a job may use. A request whose estimate is larger is refused with an error "
           "that states the estimate. Distance fields may use half of the budget.",
           above(0.0, 1e15)},
          request.memory_budget);
}

}  // namespace bin_scenes
