/// The user's request: plain data, one field per key of the request file (docs/use/request.md), SI units.
/// config/ reads it from YAML, ros/ from the message; both fill the same struct, and check() tests it.
#pragma once

#include "bin_scenes/core/types.hpp"
#include "bin_scenes/scene/gripper.hpp"
#include "bin_scenes/scene/model_settings.hpp"
#include "bin_scenes/scene/motion.hpp"
#include "bin_scenes/scene/sensor_models.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

enum class Unit { metre, centimetre, millimetre, inch };
double metres_per(Unit unit);
const char* name_of(Unit unit);  ///< "m", "cm", "mm", "inch"

/// What wears a surface, in places that differ from part to part: shares of it, 0..1. A part's own share is drawn
/// evenly around the one given, as far as 0 or 1 allow.
struct Texture {
  double scratches = 0.0, oil = 0.0, rust = 0.0;
  bool any() const { return scratches > 0.0 || oil > 0.0 || rust > 0.0; }
};

/// Optical surface of a part or the bin. Affects intensity, noise, drop-out and saturation of sensors, not physics.
struct Surface {
  double albedo = 0.5;  ///< share of the light sent back, 0..1; dark parts are noisier and drop out
  double gloss = 0.0;  ///< share of that which is mirrored instead of scattered, 0..1; shiny parts saturate or drop out
  double roughness = 0.4;  ///< width of the mirrored lobe, 0..1; smaller = narrower and brighter highlights
  /// Complex index of refraction of a metal, n + i k, both 0 for none: what is mirrored is then, of albedo * gloss, the
  /// share that Fresnel's formulas say.
  double refraction = 0.0, extinction = 0.0;
  /// Of red, green and blue: shares of albedo, of what is scattered; metals mirror it, too. Seen by colour images.
  Vec3 colour = Vec3::Ones();
  double anisotropy = 0.0;    ///< 0..1: lines of brushing or milling, along which the mirrored lobe is narrower
  Vec3 along = Vec3::Zero();  ///< of these lines, in the part's frame; zero: its longest axis
  Texture texture = {};
  bool metal() const { return refraction > 0.0 || extinction > 0.0; }
};

/// The bin. Its origin is the middle of the floor's top, z up.
struct Bin {
  enum class Kind {
    box,    ///< floor and four walls, analytic
    mesh,   ///< a mesh, with a pose in the bin frame
    floor,  ///< endless plane z = 0
    none    ///< no bin: free flight
  };
  Kind kind = Kind::box;
  Vec3 inner_size = Vec3(0.40, 0.30, 0.20);  ///< box: inner length x, width y, height z (m)
  double wall_thickness = 0.005;             ///< box: of walls and floor (m); affects cameras, not the physics
  std::string mesh;                          ///< mesh: path
  std::string mesh_sha256;                   ///< mesh: of the file's bytes as the reader saw them; empty: not known
  std::optional<Unit> unit;                  ///< mesh: unit of the file
  Pose pose;                                 ///< mesh: file frame in the bin frame
  double friction = 0.5;                     ///< pair coefficient = sqrt(part * bin)
  double restitution = 0.0;                  ///< pair coefficient = the larger of the two
  Surface surface;
  Motion motion;  ///< of the bin and its frame; poses stay those in the bin
};

/// One line of `parts`: `count` copies of one model.
/// How finely the surfaces of a STEP or IGES file become triangles.
struct Tessellation {
  std::optional<double> chord;  ///< m between triangles and surface; none: 2e-4 of the part's diagonal
  double angle = 0.2;           ///< rad between neighbouring triangles of a curved surface
  bool given() const { return chord || angle != Tessellation().angle; }
};

struct PartLine {
  std::string model;         ///< path as written by the user
  std::string path;          ///< resolved absolute path; filled by the reader
  std::string sha256;        ///< of the file's bytes as the reader saw them; empty: not known
  std::optional<Unit> unit;  ///< none: metres, unless the size is implausible for the bin (an error)
  double scale = 1.0;        ///< multiplies the model after the unit
  std::size_t count = 1;
  std::optional<double> density;  ///< kg/m3; default 1000 if mass is not given either
  std::optional<double> mass;     ///< kg, of one part
  double friction = 0.5;
  double restitution = 0.1;
  std::optional<double> thickness;  ///< m: gives an open surface this wall thickness instead of refusing it
  Tessellation tessellation;        ///< of a STEP or IGES file
  std::string solid;                ///< of a STEP or IGES file: the one to take, by name
  std::vector<Pose> poses;          ///< given start poses of the model frame in the bin frame; size = count or empty
  std::vector<Twist> velocities;    ///< given start velocities; empty = at rest
  bool fixed = false;               ///< an obstacle: stays at its given pose, or follows its motion
  Surface surface;
  Motion motion;  ///< of a fixed part, from its given pose
};

struct Pour {
  enum class Pattern {
    rain,  ///< parts enter just above the heap as it grows
    grid,  ///< the thesis's: all at once on a 3-D grid above the bin
    given  ///< poses come with the parts or from an earlier scene
  };
  Pattern pattern = Pattern::rain;
  /// How much is done before a scene counts as finished. Each includes those before it and costs more time.
  enum class Finish {
    settled,  ///< on soft contacts: parts overlap by up to 0.1 % of their diagonal
    pressed,  ///< stiff contacts take the overlap out
    probed  ///< verified on contacts without remembered forces and with less friction: nothing is about to tip or slip
  };
  Finish finish = Finish::probed;
  double drop_height = 0.02;  ///< m, rain: free fall of a part's lowest point onto the heap; higher = harder impacts
  double grid_spacing = 1.1;  ///< grid: cell edge / bounding diameter of the largest part
  std::string scene;          ///< given: path of a scene.json to continue from
  double limit = 20.0;        ///< s of simulated time after which a scene that still moves ends, not at rest
  double rest_window = 0.25;  ///< s of simulated time over which no part may move
  double rest_move = 1e-3;    ///< largest displacement over the window / part diagonal that counts as rest
  double rest_turn = 1e-2;    ///< largest turn over the window (rad) that counts as rest
};

const char* name_of(Pour::Finish finish);

enum class SolverType { automatic, sphere, bullet };
const char* name_of(SolverType type);

/// Settings of Bullet. Lengths are in part sizes where noted: Bullet simulates a scaled world.
struct BulletSettings {
  double time_step = 1.0 / 240.0;  ///< s; larger = faster, but thin parts interlock
  bool cut_steps = true;     ///< shorter steps for small or fast parts; false = such parts may pass through others
  int iterations = 40;       ///< contact sweeps a step, two a sub-step, and as many relaxing sweeps; more =
                             ///< stiffer piles, linear cost
  double margin = 0.005;     ///< collision margin / part diagonal, inside the hulls; smaller = slower, exacter
  bool sleeping = true;      ///< islands at rest cost nothing
  double hull_error = 0.01;  ///< largest surface error of the convex decomposition / part diagonal
  double hull_volume_error = 0.05;  ///< largest excess volume of all hulls together / volume
  int max_hulls = 64;               ///< largest number of hulls per part; cost of a touching pair grows with its square
};

/// The sphere solver as the thesis describes it; preset `thesis`.
struct ThesisSettings {
  double time_step = 0.01;     ///< s
  int sub_steps = 1;           ///< whole steps of time_step / sub_steps each
  int iterations = 10;         ///< impulse/velocity passes per step; 5 or 10 in the thesis
  double bias = 0.2;           ///< beta, 0.1 .. 0.3: share of the penetration turned into velocity per step
  double slop = 0.01;          ///< penetration that is tolerated / sphere radius
  double rest_velocity = 0.0;  ///< m/s below which restitution is 0; 0 = 2 g dt
  int voxels = 10;             ///< voxels along the part's longest side
  double tightness = 1.0;      ///< voxel pitch / sphere diameter; < 1 = overlapping spheres, smoother surface
  std::vector<double> radii;   ///< / the part's longest side, largest first, instead of voxels; large spheres fill the
                               ///< inside, the smallest the surface
  bool modified_normals = true;  ///< face spheres carry the true surface's normal
  int grid_size = 128;           ///< cells per axis of the collision grid
  double cell_size = 1.0;        ///< cell edge / largest sphere diameter, >= 1
  int contacts_per_sphere = 4;   ///< initial capacity; enlarged and reported if necessary
};

/// The default sphere solver: surface samples of one part against the distance field of the other.
struct SphereSettings {
  double time_step = 1.0 / 400.0;  ///< s, one collision detection each; larger = faster, thin parts interlock
  bool cut_steps = true;      ///< shorter steps for small or fast parts; false = such parts may pass through others
  double step_fall = 1.8e-3;  ///< with cut_steps: distance that the smallest part falls from rest in one step at most /
                              ///< its diagonal; more = longer steps for small parts, which sink in further
  int sub_steps = 2;          ///< contact solves per time step; more = stiffer piles, linear cost
  double recycle = 1e-3;      ///< contacts of a pair are reused until it moved so far / diagonal of the smallest part,
                              ///< three times as far while pouring; more = faster, contacts are less exact
  int coarse_samples = 200;   ///< per part while pouring; thin parts get more
  int fine_samples = 1000;    ///< per part while settling; more = less penetration, linear cost; 0 = the coarse ones
  double field_cell = 0.004;  ///< cell of the distance field / part diagonal; finer = sharper edges, cubic memory
  std::size_t field_nodes = 8u << 20;  ///< no key: most nodes of a field, whose cell is enlarged for them;
                                       ///< make_solver() lowers it for many models
  /// Where it runs. automatic: where a standard heap takes less time, measured once; gpu: the same passes as GL
  /// compute, many times slower on a software GL.
  enum class Device { automatic, cpu, gpu } device = Device::automatic;
};

struct SolverSettings {
  SolverType type = SolverType::automatic;
  enum class Preset {
    standard,  ///< every scene meets the goals of accuracy
    quick,     ///< the default sphere solver with settings that err by up to 1 % of a part, for a fraction of the time
    thesis     ///< the thesis's sphere solver
  } preset = Preset::standard;
  BulletSettings bullet;
  ThesisSettings thesis;
  SphereSettings sphere;
};

/// structured_light and stereo: how deep the simulation goes.
enum class Fidelity {
  analytic,  ///< depth with the noise and the gaps that the device's formulas predict; fast
  decoded    ///< the images themselves are made and evaluated as a device does; errors come out by themselves
};

/// Source of patterns: of fringes for structured_light, of dots for stereo.
struct Projector {
  std::optional<Pose> pose;  ///< optical frame in the bin frame; none: from baseline
  double baseline = 0.2;     ///< m along the camera's x, turned towards the middle of the bin; longer = less noise and
                             ///< wider shadows
  int width = 1280, height = 800;      ///< pixels
  double fov = 0.7;                    ///< horizontal field of view (rad)
  std::array<double, 5> distortion{};  ///< plumb_bob k1 k2 p1 p2 k3
};

/// laser_line: a sheet of light, the y-z plane of its frame, along z.
struct Laser {
  std::optional<Pose> pose;  ///< in the bin frame; none: from baseline
  double baseline = 0.2;     ///< m along the camera's x, turned towards the middle of the bin
  double width_mm = 0.3;  ///< of the line on the surface (mm, between the points of 1/e^2); wider = more speckle noise
};

/// laser_line: how camera and laser move over the bin together; their poses are those at the middle of their path.
struct Scan {
  Vec3 direction = Vec3::UnitX();  ///< bin frame, any length
  double step = 0.0005;            ///< m between profiles
  int profiles = 1000;             ///< rows of the image
};

/// Further places from which a sensor sees the same heap. config/ makes a sensor of each, and leaves this empty.
struct Views {
  std::vector<Pose> poses;  ///< optical frame in the bin frame
  std::size_t count = 0;    ///< or so many, spread evenly over a dome around `target`
  double distance = 0.8;    ///< m from target
  double tilt = 0.5;        ///< largest angle (rad) between view and vertical
  Vec3 target = Vec3::Zero();
};

/// A range sensor. Frame: optical (x right, y down, z forward).
struct Sensor {
  std::string name = "camera";
  std::string view_of;          ///< name of the sensor of whose `views` this is one; empty: a sensor of its own
  std::string model = "ideal";  ///< name of a SensorModel (sensor/sensor_model.hpp)
  std::string pose_of;          ///< name of the sensor that lens and place come from; read by config/, as preset is
  std::string preset;           ///< name of the preset the values come from; read by config/, has no effect of its own
  int width = 640, height = 480;
  double fov = 0.75;                   ///< horizontal field of view (rad); sets the intrinsics unless K is given
  std::vector<double> k;               ///< 3x3 row-major intrinsics; empty: from fov, principal point in the middle
  std::array<double, 5> distortion{};  ///< plumb_bob k1 k2 p1 p2 k3; 0 = a pinhole
  std::optional<Pose> pose;  ///< optical frame in the bin frame; none: above the bin, looking down, bin in view
  Views views;
  double near = 0.05, far = 10.0;  ///< m; nothing outside this range is measured
  Fidelity fidelity = Fidelity::analytic;
  Projector projector;         ///< structured_light, stereo
  Laser laser;                 ///< laser_line
  Scan scan;                   ///< laser_line
  ImagerSettings imager;       ///< structured_light, laser_line, stereo: the camera's chip
  ModelSettings settings;      ///< of the models, by type: settings.of<StereoSettings>()
  std::optional<int> bounces;  ///< all models but ideal: other surfaces that light may meet, 0 to 2; more = depth errs
                               ///< in corners and on shiny parts as real devices do, slower. None: as the model has it
                               ///< (SensorModel::bounces)
  int indirect_samples = 16;   ///< rays for them at a node, one for some pixels, or 32 rays of a laser's fan; noise
                               ///< of indirect light falls with them
  bool noise = true;           ///< false: every random effect is off; geometry (shadow, field of view) stays
  double depth_scale = 1e-4;  ///< m a count of its 16-bit depth images; no key, set with the poses (sensor/resolve.hpp)
};

/// Limits of an accepted scene; the report names those that were exceeded.
struct Acceptance {
  double penetration = 0.01;  ///< largest penetration of any pair / smaller part diagonal
  double gap = 0.005;         ///< largest free fall of a part at rest / its diagonal
  double energy = 2.0;        ///< largest gain of energy from nowhere between two observations, in m g d of the part
  double speed = 5.0;         ///< largest EnergyReport::Thrown::ratio
  bool escaped = false;       ///< true: scenes with escaped parts are accepted too
};

struct Request {
  std::uint64_t seed = 0;
  std::size_t scenes = 1;
  std::size_t first = 0;  ///< index of the first scene; scene i comes from (seed, i) alone
  Bin bin;
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);
  std::vector<PartLine> parts;
  Pour pour;
  SolverSettings solver;
  std::vector<Sensor> sensors;
  std::vector<Gripper> grippers;  ///< those whose grasps are asked for
  std::size_t prove = 0;          ///< free grasps of a scene that are simulated
  std::string rig;  ///< name of the rig that the sensors come from; read by config/, has no effect of its own
  Acceptance accept;
  std::optional<double> seconds;  ///< simulate exactly this long instead of until rest
  bool drift_check = false;       ///< continue for 0.5 s and report how far parts move
  double memory_budget = 4e9;     ///< bytes; a request whose estimate exceeds it is refused, with the figure
  std::string text_sha256;        ///< hash of the request as read; filled by the reader

  std::size_t part_count() const;
};

/// Sets what a preset stands for, over the whole request; a field set afterwards stays. Preset::standard and thesis
/// change nothing but themselves.
void apply(SolverSettings::Preset preset, Request& request);

/// Throws one input Error for the first invalid field (negative count, NaN, friction < 0, ...). Of sensors it only
/// counts that there are some: check_sensors() in sensor/sensor_model.hpp knows their models.
void check(const Request& request);

}  // namespace bin_scenes
