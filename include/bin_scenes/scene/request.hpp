/// The user's request as plain data, with one field for each key of the request file, in SI units. `config` reads it
/// from YAML and `ros` from the message; both fill the same struct, and check() tests it. The meaning, unit, range and
/// consequence of each key are in the table of keys (src/scene/keys.hpp), from which docs/use/request.md is generated;
/// the comments here describe only the fields that are not keys. Nothing here reads files or depends on a solver.
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

/// The length unit of a model file.
enum class Unit { metre, centimetre, millimetre, inch };
/// Returns the length of one unit in metres.
double metres_per(Unit unit);
const char* name_of(Unit unit);  ///< "m", "cm", "mm", "inch"

/// Wear of a surface: the shares of its area (0..1) that are scratched, oily or rusty. The places differ from part to
/// part. The share of one part is drawn uniformly from an interval around the given share that is as wide as the limits
/// 0 and 1 allow.
struct Texture {
  double scratches = 0.0, oil = 0.0, rust = 0.0;
  bool any() const { return scratches > 0.0 || oil > 0.0 || rust > 0.0; }
};

/// The optical surface of a part or of the bin. It affects intensity, noise, missing pixels and saturation of sensors,
/// but not the physics.
struct Surface {
  double albedo = 0.5;
  double gloss = 0.0;
  double roughness = 0.4;
  /// The complex index of refraction of a metal, n + i k; both are 0 for other materials. For a metal, the share of the
  /// light that is mirrored is albedo * gloss times the reflectance by Fresnel's formulas.
  double refraction = 0.0, extinction = 0.0;
  /// Red, green and blue: factors of the albedo for scattered light and, on metals, for mirrored light. Only colour
  /// images show them.
  Vec3 colour = Vec3::Ones();
  double anisotropy = 0.0;
  Vec3 along = Vec3::Zero();
  Texture texture = {};
  bool metal() const { return refraction > 0.0 || extinction > 0.0; }
};

/// The bin. The origin of the bin frame is the centre of the upper side of the floor, and z points up.
struct Bin {
  enum class Kind {
    box,    ///< a floor and four walls
    mesh,   ///< a mesh file, with a pose in the bin frame
    floor,  ///< the endless plane z = 0
    none    ///< no bin; parts move freely
  };
  Kind kind = Kind::box;
  Vec3 inner_size = Vec3(0.40, 0.30, 0.20);
  double wall_thickness = 0.005;
  std::string mesh;
  std::string mesh_sha256;  ///< digest of the bytes of the mesh file that the reader saw; empty if not known
  std::optional<Unit> unit;
  Pose pose;
  double friction = 0.5;
  double restitution = 0.0;
  Surface surface;
  Motion motion;
};

/// The table below the bin: an endless plane that sensors and light meet, but no part that is simulated.
struct Table {
  std::optional<double> height;  ///< none: there is no table
  Surface surface;
  double mottle = 0.0;
  double patch = 0.05;
};

/// How finely the surfaces of a STEP or IGES file are divided into triangles.
struct Tessellation {
  std::optional<double> chord;
  double angle = 0.2;
  bool given() const { return chord || angle != Tessellation().angle; }
};

/// One entry of the list `parts`: `count` copies of one model.
struct PartLine {
  std::string model;
  std::string path;    ///< absolute path of the model file; filled in by the reader
  std::string sha256;  ///< digest of the bytes of the model file that the reader saw; empty if not known
  std::optional<Unit> unit;
  double scale = 1.0;
  std::size_t count = 1;
  std::optional<double> density;
  std::optional<double> mass;
  double friction = 0.5;
  double restitution = 0.1;
  std::optional<double> thickness;
  Tessellation tessellation;
  std::string solid;
  std::vector<Pose> poses;
  std::vector<Twist> velocities;
  bool fixed = false;
  bool distractor = false;
  double on_table = 0.0;
  Surface surface;
  Motion motion;
  /// Whether the parts never move: they are obstacles, or lie on the table.
  bool stays() const { return fixed || on_table > 0.0; }
};

struct Pour {
  enum class Pattern {
    rain,  ///< parts enter just above the heap while it grows
    grid,  ///< all parts enter at once on a three-dimensional grid above the bin, as in the thesis
    given  ///< poses come with the parts or from an earlier scene
  };
  Pattern pattern = Pattern::rain;
  /// How much is done before a scene counts as finished. Each value includes the ones before it and takes more time.
  enum class Finish {
    settled,  ///< parts came to rest on soft contacts, and rested again after the contact forces were forgotten once
    pressed,  ///< before that, stiff contacts have removed the overlap
    probed    ///< the heap stayed at rest on contacts without remembered forces and with less friction, so that no part
              ///< is about to tip or slip
  };
  Finish finish = Finish::probed;
  double drop_height = 0.02;
  double grid_spacing = 1.1;
  std::string scene;
  double limit = 20.0;
  double rest_window = 0.25;
  double rest_move = 1e-3;
  double rest_turn = 1e-2;
};

const char* name_of(Pour::Finish finish);

enum class SolverType { automatic, sphere, bullet };
const char* name_of(SolverType type);

/// Settings of the solver `bullet`. Bullet simulates a scaled world; lengths are relative to the size of the parts
/// where the table of keys states it.
struct BulletSettings {
  double time_step = 1.0 / 240.0;
  bool cut_steps = true;
  int iterations = 40;
  double margin = 0.005;
  bool sleeping = true;
  double hull_error = 0.01;
  double hull_volume_error = 0.05;
  int max_hulls = 64;
};

/// Settings of the sphere solver as the thesis describes it (preset `thesis`).
struct ThesisSettings {
  double time_step = 0.01;
  int sub_steps = 1;
  int iterations = 10;
  double bias = 0.2;
  double slop = 0.01;
  double rest_velocity = 0.0;
  int voxels = 10;
  double tightness = 1.0;
  std::vector<double> radii;
  bool modified_normals = true;
  int grid_size = 128;
  double cell_size = 1.0;
  int contacts_per_sphere = 4;
};

/// Settings of the default solver `sphere`, which tests surface samples of one part against the distance field of the
/// other.
struct SphereSettings {
  double time_step = 1.0 / 400.0;
  bool cut_steps = true;
  double step_fall = 1.8e-3;
  int sub_steps = 2;
  double recycle = 1e-3;
  int coarse_samples = 200;
  int fine_samples = 1000;
  double field_cell = 0.004;
  /// Not a key: the limit of `recycle` while the heap is pressed and checked (share of the smallest part's diagonal).
  double pressed_recycle = 1e-3;
  /// Not a key: the largest number of nodes of a distance field, whose cells are enlarged to meet it. make_solver()
  /// reduces the number if there are many models.
  std::size_t field_nodes = 8u << 20;
  /// The device on which the solver runs. `automatic` selects the device on which a standard heap takes less time; this
  /// is measured once. `gpu` runs the same passes as OpenGL compute shaders, which is many times slower if OpenGL is
  /// implemented in software.
  enum class Device { automatic, cpu, gpu } device = Device::automatic;
};

/// The choice of a solver, and the settings of all solvers.
struct SolverSettings {
  SolverType type = SolverType::automatic;
  enum class Preset {
    standard,  ///< every scene meets the limits of accuracy
    quick,     ///< the solver `sphere` with settings that cause errors of up to 1 % of the size of a part and take a
               ///< fraction of the time
    thesis     ///< the sphere solver of the thesis
  } preset = Preset::standard;
  BulletSettings bullet;
  ThesisSettings thesis;
  SphereSettings sphere;
};

/// For structured_light and stereo: how closely the simulation follows the device.
enum class Fidelity {
  analytic,  ///< depth, noise and missing pixels follow formulas that describe the device; fast
  decoded    ///< the images of the device are simulated and evaluated as the device does; errors follow from the images
};

/// The projector of fringes (structured_light) or of dots (stereo).
struct Projector {
  std::optional<Pose> pose;
  double baseline = 0.2;
  int width = 1280, height = 800;
  double fov = 0.7;
  std::array<double, 5> distortion{};
};

/// For laser_line: a sheet of light in the y-z plane of the laser's frame, shining along z.
struct Laser {
  std::optional<Pose> pose;
  double baseline = 0.2;
  double width_mm = 0.3;
};

/// For laser_line: how the camera and the laser move over the bin together. Their poses in the request are those at the
/// centre of the path.
struct Scan {
  Vec3 direction = Vec3::UnitX();
  double step = 0.0005;
  int profiles = 1000;
};

/// Further poses from which a sensor sees the same heap. `config` makes one sensor of each pose and leaves this struct
/// empty.
struct Views {
  std::vector<Pose> poses;
  std::size_t count = 0;
  double distance = 0.8;
  double tilt = 0.5;
  Vec3 target = Vec3::Zero();
};

/// A range sensor. Its frame is an optical frame (x right, y down, z forward).
struct Sensor {
  std::string name = "camera";
  std::string view_of;
  std::string model = "ideal";
  std::string pose_of;
  std::string preset;
  int width = 640, height = 480;
  double fov = 0.75;
  std::vector<double> k;
  std::array<double, 5> distortion{};
  std::optional<Pose> pose;
  Views views;
  double near = 0.05, far = 10.0;
  Fidelity fidelity = Fidelity::analytic;
  Projector projector;
  Laser laser;
  Scan scan;
  ImagerSettings imager;
  ModelSettings settings;  ///< settings of the sensor models, by type; for example settings.of<StereoSettings>()
  std::optional<int> bounces;
  int indirect_samples = 16;
  bool noise = true;
  double depth_scale = 1e-4;  ///< not a key: metres per count of the 16-bit depth images, set together with the poses
                              ///< (sensor/resolve.hpp)
};

/// The limits that an accepted scene must meet. The report names those that were exceeded.
struct Acceptance {
  double penetration = 0.01;
  double gap = 0.005;
  double energy = 2.0;
  double speed = 5.0;
  double worst_penetration = 0.05;
  double worst_energy_gain = 0.01;
  double jam = 100.0;
  bool escaped = false;
  bool unstable = false;
};

/// All that determines the scenes of a job.
struct Request {
  std::uint64_t seed = 0;
  std::size_t scenes = 1;
  std::size_t first = 0;
  Bin bin;
  Table table;
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);
  std::vector<PartLine> parts;
  Pour pour;
  SolverSettings solver;
  std::vector<Sensor> sensors;
  std::vector<Gripper> grippers;
  std::size_t prove = 0;
  bool prove_all = false;
  /// rad: the largest angle between the lift of a gripped part and the vertical.
  double lift_cone = 0.0;
  /// A part counts as free to lift if other parts cover at most this share of its footprint.
  double slight_overlap = 0.03;
  std::string rig;
  Acceptance accept;
  std::optional<double> seconds;
  bool drift_check = false;
  double memory_budget = 4e9;
  std::string text_sha256;  ///< digest of the text of the request; filled in by the reader

  /// Returns the number of parts of all lines together.
  std::size_t part_count() const;
};

/// Sets the fields of the request that a preset determines. Fields that are set afterwards keep their new values. The
/// presets `standard` and `thesis` change only the field `preset` itself.
void apply(SolverSettings::Preset preset, Request& request);

/// Throws one input Error for the first invalid field (a negative count, NaN, friction < 0, ...). The settings of
/// sensors are not tested here but by check_sensors() (sensor/sensor_model.hpp), which knows the sensor models.
void check(const Request& request);

}  // namespace bin_scenes
