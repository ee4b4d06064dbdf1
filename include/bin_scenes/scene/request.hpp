/// The user's request: plain data, one field per key of the request file (docs/use/request.md), SI units.
/// config/ reads it from YAML, ros/ from the message; both fill the same struct, and check() tests it. Meaning, unit,
/// range and consequence of a field that is a key are in the table of keys (src/scene/keys.hpp), which that page
/// prints; comments here are of fields that are none.
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
  double albedo = 0.5;
  double gloss = 0.0;
  double roughness = 0.4;
  /// Complex index of refraction of a metal, n + i k, both 0 for none: what is mirrored is then, of albedo * gloss, the
  /// share that Fresnel's formulas say.
  double refraction = 0.0, extinction = 0.0;
  /// Of red, green and blue: shares of albedo, of what is scattered; metals mirror it, too. Seen by colour images.
  Vec3 colour = Vec3::Ones();
  double anisotropy = 0.0;
  Vec3 along = Vec3::Zero();
  Texture texture = {};
  bool metal() const { return refraction > 0.0 || extinction > 0.0; }
};

/// The bin. Its origin is the centre of the floor's top, z up.
struct Bin {
  enum class Kind {
    box,    ///< floor and four walls, analytic
    mesh,   ///< a mesh, with a pose in the bin frame
    floor,  ///< endless plane z = 0
    none    ///< no bin: free flight
  };
  Kind kind = Kind::box;
  Vec3 inner_size = Vec3(0.40, 0.30, 0.20);
  double wall_thickness = 0.005;
  std::string mesh;
  std::string mesh_sha256;  ///< mesh: of the file's bytes as the reader saw them; empty: not known
  std::optional<Unit> unit;
  Pose pose;
  double friction = 0.5;
  double restitution = 0.0;
  Surface surface;
  Motion motion;
};

/// One line of `parts`: `count` copies of one model.
/// How finely the surfaces of a STEP or IGES file become triangles.
struct Tessellation {
  std::optional<double> chord;
  double angle = 0.2;
  bool given() const { return chord || angle != Tessellation().angle; }
};

struct PartLine {
  std::string model;
  std::string path;    ///< resolved absolute path; filled by the reader
  std::string sha256;  ///< of the file's bytes as the reader saw them; empty: not known
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
  Surface surface;
  Motion motion;
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

/// Settings of Bullet. Lengths are in part sizes where noted: Bullet simulates a scaled world.
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

/// The sphere solver as the thesis describes it; preset `thesis`.
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

/// The default sphere solver: surface samples of one part against the distance field of the other.
struct SphereSettings {
  double time_step = 1.0 / 400.0;
  bool cut_steps = true;
  double step_fall = 1.8e-3;
  int sub_steps = 2;
  double recycle = 1e-3;
  int coarse_samples = 200;
  int fine_samples = 1000;
  double field_cell = 0.004;
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
  std::optional<Pose> pose;
  double baseline = 0.2;
  int width = 1280, height = 800;
  double fov = 0.7;
  std::array<double, 5> distortion{};
};

/// laser_line: a sheet of light, the y-z plane of its frame, along z.
struct Laser {
  std::optional<Pose> pose;
  double baseline = 0.2;
  double width_mm = 0.3;
};

/// laser_line: how camera and laser move over the bin together; their poses are those at the centre of their path.
struct Scan {
  Vec3 direction = Vec3::UnitX();
  double step = 0.0005;
  int profiles = 1000;
};

/// Further places from which a sensor sees the same heap. config/ makes a sensor of each, and leaves this empty.
struct Views {
  std::vector<Pose> poses;
  std::size_t count = 0;
  double distance = 0.8;
  double tilt = 0.5;
  Vec3 target = Vec3::Zero();
};

/// A range sensor. Frame: optical (x right, y down, z forward).
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
  ModelSettings settings;  ///< of the models, by type: settings.of<StereoSettings>()
  std::optional<int> bounces;
  int indirect_samples = 16;
  bool noise = true;
  double depth_scale = 1e-4;  ///< m a count of its 16-bit depth images; no key, set with the poses (sensor/resolve.hpp)
};

/// Limits of an accepted scene; the report names those that were exceeded.
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

struct Request {
  std::uint64_t seed = 0;
  std::size_t scenes = 1;
  std::size_t first = 0;
  Bin bin;
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);
  std::vector<PartLine> parts;
  Pour pour;
  SolverSettings solver;
  std::vector<Sensor> sensors;
  std::vector<Gripper> grippers;
  std::size_t prove = 0;
  bool prove_all = false;
  double lift_cone = 0.0;        ///< rad: of the lifts of grasped parts against the vertical
  double slight_overlap = 0.03;  ///< share of a part's footprint: those covered by no more count as free to lift
  std::string rig;
  Acceptance accept;
  std::optional<double> seconds;
  bool drift_check = false;
  double memory_budget = 4e9;
  std::string text_sha256;  ///< hash of the request as read; filled by the reader

  std::size_t part_count() const;
};

/// Sets what a preset stands for, over the whole request; a field set afterwards stays. Preset::standard and thesis
/// change nothing but themselves.
void apply(SolverSettings::Preset preset, Request& request);

/// Throws one input Error for the first invalid field (negative count, NaN, friction < 0, ...). Of sensors it only
/// counts that there are some: check_sensors() in sensor/sensor_model.hpp knows their models.
void check(const Request& request);

}  // namespace bin_scenes
