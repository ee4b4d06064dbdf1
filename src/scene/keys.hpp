/// The table of request keys: every key once, with its field, unit, meaning, range and the consequence of changing it.
/// Reading, writing back, `--set`, suggestions for unknown keys, check() and docs/use/request.md all come from visiting
/// it; the default of a key is the value of its field in a default-constructed struct (scene/request.hpp). Keys of
/// solvers, grippers and sensors are in solver_keys.hpp, gripper_keys.hpp and sensor/sensor_keys.hpp.
///
/// A visitor has  field(Key, value&)          one value
///                section(Key, struct&)       a map of further keys
///                list(Key, vector<struct>&)  a list of maps
#pragma once

#include "bin_scenes/scene/key.hpp"
#include "bin_scenes/scene/request.hpp"
#include "scene/gripper_keys.hpp"
#include "scene/solver_keys.hpp"

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
           "when it is at each of poses, from its beginning, ascending. Motion is not for preset thesis and device gpu",
           above(0.0, 1e5)},
          motion.times);
  v.field(
      {"poses", "m",
       "where it is then, from where it stood, in the axes that the bin had; it goes smoothly from one to the next; a "
       "bin ends upright. Poses of parts stay those in the bin"},
      motion.poses);
  v.field({"shake", "m", "amplitude of a sine along the axes", at_least(-100.0, 100.0)}, motion.shake);
  v.field({"tilt", "rad", "amplitude of a sine of turns about the axes", at_least(-M_PI, M_PI)}, motion.tilt);
  v.field({"frequency", "Hz", "of shake and tilt, which swell up over their first period and fade over their last",
           above(0.0, 100.0)},
          motion.frequency);
  v.field({"belt", "m/s", "velocity of the surface of a part that itself stays: a conveyor", at_least(-100.0, 100.0)},
          motion.belt);
  v.field({"seconds", "s", "how long shake, tilt and belt go on", above(0.0, 1e5)}, motion.seconds);
}

template <class Visitor>
void visit(Visitor& v, Texture& texture) {
  v.field({"scratches", "", "mean share, rough; albedo x 0.8", at_least(0.0, 1.0)}, texture.scratches);
  v.field({"oil", "", "mean share, smoother; albedo x 0.85", at_least(0.0, 1.0)}, texture.oil);
  v.field({"rust", "", "mean share, matte; albedo x 0.4", at_least(0.0, 1.0)}, texture.rust);
}

template <class Visitor>
void visit(Visitor& v, Surface& surface) {
  std::string material;  // name of a material whose values have been read; the values are written instead of the name
  v.field({"material", "",
           "name of a file of config/materials whose values are the defaults here: steel_brushed, plastic_black, ...",
           anything, false},
          material);
  v.field({"albedo", "", "share of the light that is sent back, 0 to 1; dark parts are noisier and drop out",
           at_least(0.0, 1.0)},
          surface.albedo);
  v.field(
      {"gloss", "", "share of that which is mirrored, 0 to 1; shiny parts saturate or drop out", at_least(0.0, 1.0)},
      surface.gloss);
  v.field({"roughness", "", "width of the mirrored lobe, 0 to 1; smaller = narrower and brighter highlights",
           at_least(0.0, 1.0)},
          surface.roughness);
  v.field({"refraction", "",
           "metals: n of the index of refraction n + i k; mirrors as Fresnel says; 0 with extinction 0 = all",
           at_least(0.0, 100.0)},
          surface.refraction);
  v.field({"extinction", "", "metals: k of that index", at_least(0.0, 100.0)}, surface.extinction);
  v.field({"colour", "", "times albedo, of red, green, blue", at_least(0.0, 1.0)}, surface.colour);
  v.field({"anisotropy", "", "of brushing: narrower lobe along its lines", at_least(0.0, 1.0)}, surface.anisotropy);
  v.field({"along", "", "of the lines; [0, 0, 0]: the longest axis"}, surface.along);
  v.section({"texture", "", "wear", anything, surface.texture.any()}, surface.texture);
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
  v.field({"inner_size", "m", "box: inner length x, width y and height z", above(0.0, 1000.0), box}, bin.inner_size);
  v.field({"wall_thickness", "m", "box: thickness of walls and floor; seen by cameras, never by the physics",
           at_least(0.0, 10.0), box},
          bin.wall_thickness);
  v.field({"mesh", "",
           "path of a mesh that is the bin, instead of a box, with walls of some thickness; written like parts[].model",
           anything, mesh},
          bin.mesh);
  v.field({"unit", "", "mesh: unit of the file", anything, mesh}, bin.unit);
  v.field({"pose", "", "mesh: frame of the file in the bin frame", anything, mesh}, bin.pose);
  v.field({"floor", "", "true: an endless floor at z = 0 instead of a box", anything, kind.floor}, kind.floor);
  v.field({"none", "", "true: no bin, free flight", anything, kind.none}, kind.none);
  v.field({"friction", "", "of walls and floor; the coefficient of a contact is sqrt(part * bin)", at_least(0.0, 10.0)},
          bin.friction);
  v.field({"restitution", "", "of walls and floor; a contact uses the larger one of part and bin", at_least(0.0, 1.0)},
          bin.restitution);
  v.section({"surface", "", "of walls and floor: what light does there"}, bin.surface);
  v.section({"motion", "", "path of the bin, begun when all parts are in and slow; then the heap settles again",
             anything, bin.motion.any()},
            bin.motion);
  v.bin_kind(bin, kind);
}

template <class Visitor>
void visit(Visitor& v, Tessellation& fine) {
  v.field({"chord", "m", "largest distance of triangles from the surface; left out: 2e-4 of the part's diagonal",
           above(0.0, 1.0)},
          fine.chord);
  v.field({"angle", "rad", "between neighbouring triangles of a curved surface; smaller = finer small fillets",
           at_least(0.01, 1.0)},
          fine.angle);
}

template <class Visitor>
void visit(Visitor& v, PartLine& part) {
  v.field({"model", "",
           "mesh or CAD file (STL, OBJ, PLY, DAE, OFF, STEP, IGES): path relative to the request, absolute, or "
           "package://name/path; it must be a closed solid: holes "
           "of at most 2 % of its diagonal around are closed, and the report says so; larger holes are an error unless "
           "thickness is given",
           anything, true, true},
          part.model);
  v.field({"unit", "",
           "unit of the file; left out: m (or what the file itself states), unless the size is implausible for the "
           "bin, which is an error that names the likely unit"},
          part.unit);
  v.field({"scale", "", "multiplies the model after the unit", above(0.0, 1e6)}, part.scale);
  v.field({"count", "", "number of copies; cost grows with it", at_least(1.0, 1e6)}, part.count);
  v.field(
      {"density", "kg/m3", "mass = density * volume of the mesh; 1000 if mass is not given either", above(0.0, 1e5)},
      part.density);
  v.field({"mass", "kg", "of one part, instead of density", above(0.0, 1e6)}, part.mass);
  v.field({"friction", "", "the coefficient of a contact is sqrt(a * b)", at_least(0.0, 10.0)}, part.friction);
  v.field({"restitution", "",
           "a contact uses the larger one of the two; parts with high values take longer to come to rest",
           at_least(0.0, 1.0)},
          part.restitution);
  v.field({"thickness", "m", "gives an open surface walls of this thickness instead of refusing it", above(0.0, 1.0)},
          part.thickness);
  v.section(
      {"tessellation", "", "STEP, IGES: how finely surfaces become triangles", anything, part.tessellation.given()},
      part.tessellation);
  v.field({"solid", "", "STEP, IGES: name of the solid to take; left out: all of the file, which must touch", anything,
           !part.solid.empty()},
          part.solid);
  v.field({"poses", "m",
           "start poses of the model frame in the bin frame, one a part: [x, y, z, qx, qy, qz, qw]; needed by "
           "pour.pattern given and by fixed parts",
           anything, !part.poses.empty()},
          part.poses);
  v.field({"velocities", "m/s, rad/s",
           "start velocities, one a pose: [vx, vy, vz, wx, wy, wz] of the centre of mass in the bin frame; left out: "
           "at rest",
           at_least(-1e4, 1e4), !part.velocities.empty()},
          part.velocities);
  v.field({"fixed", "", "true: an obstacle (a divider, a fixture) that stays at its given pose"}, part.fixed);
  v.section({"surface", "", "what light does on these parts; physics does not depend on it"}, part.surface);
  v.section(
      {"motion", "", "path of a fixed part that nothing stops: a pusher, a conveyor", anything, part.motion.any()},
      part.motion);
}

template <class Visitor>
void visit(Visitor& v, Pour& pour) {
  // Poses read from an earlier scene are in the part lines by then: the request that is written back needs no other
  // file.
  v.field({"pattern", "",
           "rain: parts enter just above the heap as it grows; grid: all at once on a 3-D grid above the bin; given: "
           "poses come with the parts or from scene"},
          pour.pattern);
  v.field(
      {"finish", "",
       "how much is done before a scene counts as finished, each step on top of the one before: settled: parts "
       "rest on soft contacts; pressed: stiff contacts take their overlap out; probed: verified to stand without "
       "remembered forces and with a tenth less friction, which takes up to twice the time of pressed. To bullet all "
       "three are settled"},
      pour.finish);
  v.field({"drop_height", "m", "rain: free fall of a part above the heap; higher = harder impacts and longer scenes",
           at_least(0.0, 100.0)},
          pour.drop_height);
  v.field({"grid_spacing", "", "grid: cell edge / bounding diameter of the largest part", at_least(1.0, 100.0)},
          pour.grid_spacing);
  v.field(
      {"scene", "",
       "given: path of an earlier scene.json to continue from; its parts are matched with the part lines by position "
       "in the list; escaped parts are left out",
       anything, false},
      pour.scene);
  v.field({"limit", "s", "simulated time after which a scene that still moves ends, not at rest", above(0.0, 1e5)},
          pour.limit);
  v.field({"rest_window", "s", "simulated time over which no part may move; longer = more certain rest, longer scenes",
           above(0.0)},
          pour.rest_window);
  v.field(
      {"rest_move", "", "largest displacement over the window / part diagonal that counts as rest", above(0.0, 1.0)},
      pour.rest_move);
  v.field({"rest_turn", "rad", "largest turn over the window that counts as rest", above(0.0, 3.2)}, pour.rest_turn);
}

template <class Visitor>
void visit(Visitor& v, Acceptance& accept) {
  v.field(
      {"penetration", "", "largest penetration of any pair / smaller part's diagonal; deeper: the scene is set apart",
       at_least(0.0, 1.0)},
      accept.penetration);
  v.field({"gap", "",
           "largest distance that a part at rest could fall before it touches something / its diagonal; farther: the "
           "scene is set apart",
           at_least(0.0, 1.0)},
          accept.gap);
  v.field(
      {"energy", "",
       "largest energy that a part gained from nowhere between two observations (1/60 s) / (its mass * gravity * its "
       "diagonal); more: contacts threw it about, and the scene is set apart",
       at_least(0.0)},
      accept.energy);
  v.field({"speed", "",
           "largest (speed of a part - gravity * time between two observations) / fastest of the parts near it before; "
           "more: "
           "contacts threw it out, and the scene is set apart",
           at_least(1.0)},
          accept.speed);
  v.field({"worst_penetration", "",
           "largest depth of a contact at any time of the run, by the solver's own contacts / smaller part's diagonal; "
           "deeper: parts may have passed into each other, and the scene is set apart",
           at_least(0.0, 1.0)},
          accept.worst_penetration);
  v.field(
      {"worst_energy_gain", "",
       "largest rise of the energy of all parts together above an earlier value / (mass * gravity * diagonal, summed "
       "over the parts that moved); more: contacts made energy, and the scene is set apart",
       at_least(0.0)},
      accept.worst_energy_gain);
  v.field(
      {"jam", "",
       "largest squeeze of a part between contacts on opposite sides / weight of it and of what rests on it; more: its "
       "collision shape fills a gap that the part has, and the scene is set apart",
       at_least(1.0)},
      accept.jam);
  v.field({"escaped", "", "true: scenes with escaped parts are accepted too"}, accept.escaped);
  v.field({"unstable", "", "true: scenes with parts that moved in each check of how they stand are accepted too"},
          accept.unstable);
}

template <class Visitor>
void visit(Visitor& v, Request& request) {
  v.field({"seed", "", "same request, seed and device class = same scene, bit for bit; 0 is a seed like any other",
           at_least(0.0)},
          request.seed);
  v.field({"scenes", "", "number of scenes", at_least(1.0, 1e9)}, request.scenes);
  v.field({"first", "", "index of the first scene; scene i depends on (seed, i) alone, so that a job can be split",
           at_least(0.0, 1e9)},
          request.first);
  v.section({"bin", "", "its origin is the centre of the floor's top, z up"}, request.bin);
  v.field({"gravity", "m/s2", "in the bin frame", at_least(-1e4, 1e4)}, request.gravity);
  v.list({"parts", "", "parts to pour; several lines make a mixed bin", anything, true, true}, request.parts);
  v.section({"pour", "", "how parts enter the bin, and when they are at rest"}, request.pour);
  v.section({"solver", "", "solver and its settings"}, request.solver);
  v.list({"sensors", "", "range sensors; none = no images"}, request.sensors);
  v.field({"rig", "",
           "instead of sensors: those of a published data set, ipd, xyzibd or itoddmv (config/sensors/rigs names "
           "sources); single values are changed by --set or a plan's draw",
           anything, false},
          request.rig);
  v.list({"grippers", "",
          "the grippers for which the format `grasps` lists grasps; an item is a map or the name of a preset", anything,
          !request.grippers.empty()},
         request.grippers);
  v.field({"prove", "", "free grasps of a scene that are proved by lifting, spread over their scores",
           at_least(0.0, 1e5), request.prove > 0},
          request.prove);
  v.field({"prove_all", "", "true: prove also chooses grasps of blocked parts, and grasps that would slip", anything,
           request.prove > 0},
          request.prove_all);
  v.field(
      {"lift_cone", "rad",
       "grasped parts that cannot go straight up may be lifted along any direction within this angle of it; the one "
       "nearest to the vertical is chosen",
       at_least(0.0, 1.2), !request.grippers.empty()},
      request.lift_cone);
  v.field({"slight_overlap", "",
           "share of a part's footprint: a part that others cover by no more counts as free to be lifted; 0: only "
           "uncovered parts do",
           at_least(0.0, 1.0), !request.grippers.empty()},
          request.slight_overlap);
  v.section({"accept", "", "when a scene is accepted; others are set apart with the reason"}, request.accept);
  v.field({"seconds", "s", "simulates exactly this long instead of until rest", above(0.0, 1e5)}, request.seconds);
  v.field({"drift_check", "",
           "true: the same solver continues from rest for 0.5 s, and the report states how far parts move; this does "
           "not predict what other engines do"},
          request.drift_check);
  v.field({"memory_budget", "byte",
           "a request whose estimate exceeds it is refused, with the figure; distance fields share half of it",
           above(0.0, 1e15)},
          request.memory_budget);
}

}  // namespace bin_scenes
