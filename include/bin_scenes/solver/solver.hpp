/// The interface of all solvers. A solver simulates a batch of worlds: one scene is a batch of one world, and the
/// result of a world does not depend on the other worlds of the batch.
///
///     add_world ─► insert bodies ─► advance ─► states ─► ... ─► remove_world
///
/// A world contains bodies, walls and gravity. Pouring parts and deciding that they are at rest is the task of pour/.
/// Between two calls of advance(), calls about different worlds may come from different threads at the same time,
/// except add_world() and remove_world().
#pragma once

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/scene/request.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Constant properties of a body.
struct BodyDef {
  std::size_t part = 0;      ///< index into WorldDef::parts
  double mass = 1.0;         ///< mass (kg), > 0; the inertia follows from the part's mass properties
  double friction = 0.5;     ///< friction coefficient of the body; that of a pair is sqrt(a * b)
  double restitution = 0.0;  ///< restitution of the body; that of a pair is max(a, b)
  bool fixed = false;  ///< infinite mass: the body keeps the velocity with which it was inserted, whatever it touches
};

/// Pose and velocity of a body.
struct BodyState {
  Pose pose;       ///< from the model frame to the bin frame
  Twist velocity;  ///< velocity of the centre of mass, and angular velocity, in the bin frame
};

/// Constant properties of a world.
struct WorldDef {
  std::vector<PartModelPtr> parts;
  std::vector<BodyDef> bodies;
  Bin bin;
  PartModelPtr bin_model;  ///< Bin::Kind::mesh only: closed or open mesh (m), in the frame that Bin::pose places
  /// m, height of the walls of a box above the floor; while parts enter, pour makes them higher than bin.inner_size.z
  double wall_height = 0.0;
  Vec3 gravity = Vec3(0, 0, -9.81);
  /// Whether a symmetric impact among at most 48 bodies is shared out symmetrically, to 0.01 % of its speed. Heaps of
  /// 10 parts then cost 1.1 to 1.5 of the time, those of 25 parts 1.6. Only the default solver reads it.
  bool exact_impacts = true;
  std::int64_t scene = -1;  ///< index of the scene, which only messages of failed assertions use; -1: none
};

/// Motion of the frame in which poses are given, which is the frame of the bin. Bodies in a moving frame experience
/// additional accelerations (bin axes, SI).
struct Frame {
  Vec3 gravity = Vec3(0, 0, -9.81);  ///< m/s2, gravity minus the acceleration of the frame's origin
  Vec3 spin = Vec3::Zero(),
       spin_rate = Vec3::Zero();  ///< angular velocity (rad/s) and angular acceleration (rad/s2) of the frame

  bool turns() const { return !spin.isZero() || !spin_rate.isZero(); }
  /// Returns the acceleration (m/s2), in addition to gravity, of a point at `x` (m) that moves with velocity `v` (m/s)
  /// in the frame: the Euler, Coriolis and centrifugal terms.
  Vec3 acceleration(const Vec3& x, const Vec3& v) const {
    return -spin_rate.cross(x) - 2.0 * spin.cross(v) - spin.cross(spin.cross(x));
  }
  /// Returns the angular acceleration (rad/s2) of a body that rotates with `w` (rad/s) in the frame, in addition to its
  /// own gyroscopic term.
  Vec3 angular_acceleration(const Vec3& w, const Mat3& inertia, const Mat3& inverse_inertia) const {
    const Vec3 whole = w + spin;
    return -spin_rate - spin.cross(w) - inverse_inertia * (whole.cross(inertia * whole) - w.cross(inertia * w));
  }
};

/// The two jaws of a gripper: fixed bodies that close on what is between them, carried by a hand (bin frame, SI). They
/// move along `axis` towards each other with equal speeds relative to the hand, do not rotate, and collide neither with
/// each other nor with fixed bodies. Each jaw presses with `force` on what stops it; its mass determines how quickly
/// the force is reached.
struct Jaws {
  std::size_t first = 0, second = 0;  ///< indices of the two bodies, which have BodyDef::fixed
  Vec3 axis = Vec3::UnitX();          ///< unit vector from the first to the second
  double force = 0.0;                 ///< N, force of each jaw
  double speed = 0.0;                 ///< m/s, largest speed of each jaw while they close
  double mass = 0.1;                  ///< kg, of each jaw; equal to the mass of the held part or several times as large
  Vec3 velocity = Vec3::Zero();       ///< m/s, velocity of the hand
};

/// The force between two bodies at one point (bin frame, SI).
struct ContactForce {
  int a = 0, b = -1;   ///< indices of the bodies; b is -1 for the bin
  Vec3 point, normal;  ///< contact point (m); unit normal from a to b
  Vec3 force;          ///< force (N) on b including friction; the opposite force acts on a
  double gap = 0.0;    ///< distance (m) of the surfaces along the normal; negative: overlap
};

/// The deepest contact over an interval of time, by the contact depths of the solver.
struct WorstContact {
  int a = -1, b = -1;                    ///< indices of the bodies of the deepest contact; b is -1 for the bin
  double depth = 0.0, relative = 0.0;    ///< m, and depth / diagonal of the smaller part; the contact with the largest
                                         ///< relative depth is the deepest
  double ago = 0.0;                      ///< s of simulated time that have passed since then
  std::uint64_t unresolved_impacts = 0;  ///< WorstReport::unresolved_impacts
};

/// Identifies a world of a solver.
using WorldId = std::size_t;

/// How compliant contacts are. Soft contacts dissipate the energy of rocking parts and leave overlap under load; stiff
/// contacts remove this overlap; rigid contacts do not yield, and remove overlap only at a low fixed rate.
enum class Stiffness : std::uint32_t { soft, stiff, rigid };

/// The settings of the solver in one stage of settling. pour/settling.hpp lists the stages.
struct Phase {
  /// How bodies that have not moved for a while fall asleep, and how they wake.
  enum class Sleep : std::uint32_t {
    by_island,  ///< all bodies that press on each other fall asleep together, so that the removal of one wakes those
                ///< that it supported
    by_part,  ///< each body falls asleep alone, unless a body that presses on it moved recently: a creeping body keeps
              ///< only its neighbours awake
    by_touch  ///< each body falls asleep alone; a moving body wakes whatever it touches
  };
  /// True: all samples of the shapes are used; false: a coarse subset, which suffices while all bodies move.
  bool fine_samples = false;
  Stiffness stiffness = Stiffness::soft;
  double friction = 1.0;  ///< factor of all coefficients of friction
  /// Contacts start without the forces of the last step. Rigid contacts are in addition frictionless for a moment.
  bool forgets = false;
  Sleep sleep = Sleep::by_island;
  /// true: all bodies are put to sleep at zero velocity when the phase begins; false: all wake if the phase is a change
  bool begins_asleep = false;
};

class WorldWatch;

/// A solver of rigid-body dynamics with contact.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Throws the input Error that add_world() would throw for this definition, without changing anything.
  virtual void check(const WorldDef& /*def*/) const {}
  /// Makes a world in which all bodies are absent. Throws an input Error if the solver cannot simulate the world, or if
  /// it does not fit into the memory budget.
  virtual WorldId add_world(const WorldDef& def) = 0;
  virtual void remove_world(WorldId world) = 0;

  /// Sets the motion of the frame from now on, until the next call. All bodies wake. Solvers without this function
  /// throw an input Error.
  virtual void set_frame(WorldId /*world*/, const Frame& /*frame*/) {
    throw input_error("motion is not simulated by " + name(), "solver",
                      "use type bullet, or sphere on the CPU without preset thesis");
  }
  /// Makes jaws close from now on. They start where they are, with the speed that they have; a further call sets new
  /// values, from which they continue. What they touch wakes. Solvers without this function throw an input Error.
  virtual void set_jaws(WorldId /*world*/, const Jaws& /*jaws*/) { cannot_hold(); }
  /// Applies a force to a body from now on in addition to gravity, at a point that is fixed to the body: the pull of a
  /// vacuum (bin frame, N, m). A body has one such force, and a further call replaces it. The body stays awake. Solvers
  /// without this function throw an input Error.
  virtual void set_force(WorldId /*world*/, std::size_t /*body*/, const Vec3& /*force*/, const Vec3& /*point*/) {
    cannot_hold();
  }
  /// Inserts an absent body into the world, or moves a present one. This takes effect at the next advance().
  virtual void insert(WorldId world, std::size_t body, const BodyState& state) = 0;
  /// Removes a body and wakes the bodies that it touched. Phase::sleep determines which further bodies these wake.
  virtual void remove(WorldId world, std::size_t body) = 0;
  /// Sets the phase of a world. Returns false if this solver treats contacts the same in all phases.
  virtual bool set_phase(WorldId world, const Phase& phase) = 0;

  /// Simulates the next `seconds` of each listed world: whole steps and, if they do not add up to `seconds`, a shorter
  /// last step (steps_in() in solver/step_limit.hpp). Returns the simulated time, which differs by rounding only. The
  /// result never depends on wall-clock time.
  virtual double advance(const std::vector<WorldId>& worlds, double seconds) = 0;
  /// The two halves of advance(). begin() may return while a device still works on these worlds, which must not be read
  /// or changed before finish() is called with the same list. Other worlds may be begun and finished in between.
  virtual double begin(const std::vector<WorldId>& worlds, double seconds) { return advance(worlds, seconds); }
  virtual void finish(const std::vector<WorldId>&) {}
  /// Whether begin() returns before the work is done, so that the caller can work on other worlds.
  virtual bool works_aside() const { return false; }

  /// Returns the states of all bodies in the order of WorldDef::bodies. Absent bodies keep their last state (initially
  /// a NaN position).
  virtual std::vector<BodyState> states(WorldId world) const = 0;
  /// Returns for each body, in the same order, whether it sleeps. The result is meant for progress and counters only;
  /// whether a body is at rest is decided in pour/.
  virtual std::vector<bool> asleep(WorldId world) const = 0;

  /// Returns the contacts that carried a force in the last step or, for sleeping bodies, when they fell asleep. The
  /// result is empty if the solver does not report forces.
  virtual std::vector<ContactForce> contact_forces(WorldId /*world*/) const { return {}; }

  /// Returns the worst contact of all steps since the last call, or since the world was made. Returns none if the
  /// solver does not report depths.
  virtual std::optional<WorstContact> take_worst_contact(WorldId /*world*/) { return std::nullopt; }

  /// Returns an observer that works on the device which simulates the worlds (world_watch.hpp); null if states() costs
  /// nothing.
  virtual WorldWatch* watch() { return nullptr; }

  /// Returns the number of worlds that should be simulated together for the highest speed.
  virtual std::size_t worlds_at_once() const { return 1; }
  virtual double step_size() const = 0;  ///< length of a step (s), in which contacts are found once
  virtual std::uint64_t steps(WorldId world) const = 0;
  virtual const Profile& profile() const = 0;  ///< times of stages and counters since construction
  virtual std::vector<Flag> flags(WorldId world) const = 0;
  virtual std::string name() const = 0;    ///< "sphere", "sphere/thesis", "bullet"
  virtual std::string device() const = 0;  ///< GL_RENDERER or "cpu"

 private:
  [[noreturn]] void cannot_hold() const {
    throw input_error("grippers are not simulated by " + name(), "solver",
                      "use type sphere on the CPU without preset thesis");
  }
};

/// Returns the largest number of nodes of a distance field: all models together may use half of memory_budget. The
/// number depends only on the budget and the number of models, so that a scene is the same in every job and on every
/// machine.
std::size_t field_nodes_that_fit(const LoadedRequest& loaded);

/// Makes the solver of a request. SolverType::automatic selects it by device, parts and count from measured costs; the
/// cause is appended to `reason`. Throws an environment Error if the requested device cannot be used.
std::unique_ptr<Solver> make_solver(const LoadedRequest& loaded, std::string& reason);

}  // namespace bin_scenes
