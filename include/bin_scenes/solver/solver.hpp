/// The interface of all solvers. The unit of work is a batch of worlds: one scene is a batch of one, and the result of
/// a world does not depend on the other worlds of the batch.
///
///     add_world ─► insert bodies ─► advance ─► states ─► ... ─► remove_world
///
/// A world contains bodies, walls and gravity; pouring parts and deciding that they rest is done in pour/. Between two
/// advances, calls about different worlds may come from different threads at once, but for add_world and remove_world.
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
  double mass = 1.0;         ///< kg; > 0. Inertia follows from the part's mass properties
  double friction = 0.5;     ///< pair = sqrt(a*b)
  double restitution = 0.0;  ///< pair = max(a, b)
  bool fixed = false;        ///< infinite mass: goes on with the velocity it was inserted with, whatever touches it
};

struct BodyState {
  Pose pose;       ///< model frame in the bin frame
  Twist velocity;  ///< of the centre of mass, bin frame
};

/// Constant properties of a world.
struct WorldDef {
  std::vector<PartModelPtr> parts;
  std::vector<BodyDef> bodies;
  Bin bin;
  PartModelPtr bin_model;  ///< Bin::Kind::mesh only: closed or open mesh, metres, in the frame Bin::pose places
  double wall_height =
      0.0;  ///< m above the floor up to which box walls reach; pour extends them above bin.inner_size.z
  Vec3 gravity = Vec3(0, 0, -9.81);
};

/// Motion of the frame in which poses are given, which is the bin's: what moves with the bin feels it (bin axes, SI).
struct Frame {
  Vec3 gravity = Vec3(0, 0, -9.81);  ///< that of the earth, less the acceleration of the frame's origin
  Vec3 spin = Vec3::Zero(), spin_rate = Vec3::Zero();  ///< rad/s, rad/s2

  bool turns() const { return !spin.isZero() || !spin_rate.isZero(); }
  /// Acceleration (m/s2) of a point at `x` that moves with velocity `v` in the frame, in addition to gravity: by the
  /// change of the spin, the Coriolis and the centrifugal term.
  Vec3 acceleration(const Vec3& x, const Vec3& v) const {
    return -spin_rate.cross(x) - 2.0 * spin.cross(v) - spin.cross(spin.cross(x));
  }
  /// Angular acceleration (rad/s2) of a body that turns with `w` in the frame, in addition to its own gyroscopic term.
  Vec3 angular_acceleration(const Vec3& w, const Mat3& inertia, const Mat3& inverse_inertia) const {
    const Vec3 whole = w + spin;
    return -spin_rate - spin.cross(w) - inverse_inertia * (whole.cross(inertia * whole) - w.cross(inertia * w));
  }
};

/// Two fixed bodies that close on what lies between them, carried by a hand (bin frame, SI). They move along `axis`
/// towards each other, always equally fast for the hand, do not turn, and meet neither each other nor what is fixed.
/// Each presses with `force` on what stops them, as its mass is slow to.
struct Jaws {
  std::size_t first = 0, second = 0;  ///< bodies with BodyDef::fixed
  Vec3 axis = Vec3::UnitX();          ///< unit, from the first to the second
  double force = 0.0;                 ///< N, of each
  double speed = 0.0;                 ///< m/s, of each: at most, while they close
  double mass = 0.1;                  ///< kg, of each; about that of what they hold, or some times more
  Vec3 velocity = Vec3::Zero();       ///< of the hand
};

/// The force between two bodies at one point (bin frame, SI).
struct ContactForce {
  int a = 0, b = -1;   ///< bodies; b is -1 for the bin
  Vec3 point, normal;  ///< from a to b
  Vec3 force;          ///< N, on b with friction; on a acts its opposite
};

/// The deepest contact over some time, by the solver's own contact depths.
struct WorstContact {
  int a = -1, b = -1;                    ///< bodies of the deepest contact; b is -1 for the bin
  double depth = 0.0, relative = 0.0;    ///< m; depth / diagonal of the smaller part, by which it is the deepest
  double ago = 0.0;                      ///< s of simulated time since then
  std::uint64_t unresolved_impacts = 0;  ///< WorstReport::unresolved_impacts
};

using WorldId = std::size_t;

/// How compliant contacts are. Soft ones take the energy out of rocking and leave overlap under load; stiff ones press
/// it out; rigid ones do not yield, and push almost nothing apart.
enum class Stiffness : std::uint32_t { soft, stiff, rigid };

/// The solver's settings in a stage of settling; pour/settling.hpp lists the stages.
struct Phase {
  /// How bodies fall asleep, once they stayed where they are, and wake.
  enum class Sleep : std::uint32_t {
    by_island,  ///< all that press on each other together, so that what carried a part knows when it goes
    by_part,    ///< each alone, unless what presses on it moved lately: what creeps keeps only its neighbours awake
    by_touch    ///< each alone; what moves wakes whatever it touches
  };
  bool fine_samples = false;  ///< exact shapes; coarse ones do while everything moves
  Stiffness stiffness = Stiffness::soft;
  double friction = 1.0;  ///< share of friction that holds
  /// Contacts begin without the forces of the last step; rigid ones for a moment without friction as well.
  bool forgets = false;
  Sleep sleep = Sleep::by_island;
  bool begins_asleep =
      false;  ///< all bodies sleep as it begins, at no velocity; false: all are awake if it is a change
};

class WorldWatch;

class Solver {
 public:
  virtual ~Solver() = default;

  /// Throws the input Error that add_world() would throw for this definition, without changing anything.
  virtual void check(const WorldDef& /*def*/) const {}
  /// Makes a world in which all bodies are absent. Throws an input Error if the solver cannot simulate it, or if it
  /// does not fit the memory budget.
  virtual WorldId add_world(const WorldDef& def) = 0;
  virtual void remove_world(WorldId world) = 0;

  /// How the frame moves from now on, until the next call. All bodies wake. Solvers that cannot do it throw an input
  /// Error.
  virtual void set_frame(WorldId /*world*/, const Frame& /*frame*/) {
    throw input_error("motion is not simulated by " + name(), "solver",
                      "use type bullet, or sphere on the CPU without preset thesis");
  }
  /// Jaws close from now on, from where they are and with the speed at which they close already; after a further call
  /// they go on by its values. What they touch wakes. Solvers that cannot do it throw an input Error, as set_force().
  virtual void set_jaws(WorldId /*world*/, const Jaws& /*jaws*/) { cannot_hold(); }
  /// A force on a body from now on, beside gravity, at a point that stays where it is on the body: the pull of a vacuum
  /// (bin frame, N, m). One for each body: a further call replaces the last one. What it acts on stays awake.
  virtual void set_force(WorldId /*world*/, std::size_t /*body*/, const Vec3& /*force*/, const Vec3& /*point*/) {
    cannot_hold();
  }
  /// Puts an absent body into the world (or moves a present one). Takes effect at the next advance().
  virtual void insert(WorldId world, std::size_t body, const BodyState& state) = 0;
  /// Takes a body out and wakes the bodies that it touched; Phase::sleep decides what these wake in turn.
  virtual void remove(WorldId world, std::size_t body) = 0;
  /// Returns false if contacts are the same to this solver in all phases.
  virtual bool set_phase(WorldId world, const Phase& phase) = 0;

  /// Simulates the next `seconds` of each listed world: whole steps and, if they do not add up to it, a shorter last
  /// one (steps_in() in solver/step_limit.hpp). Returns the simulated time, which differs by rounding only.
  /// Never depends on wall time.
  virtual double advance(const std::vector<WorldId>& worlds, double seconds) = 0;
  /// advance() in two halves: begin() may return while a device still works on these worlds. They must not be read or
  /// changed before finish() with the same list. Other worlds may be begun and finished in between.
  virtual double begin(const std::vector<WorldId>& worlds, double seconds) { return advance(worlds, seconds); }
  virtual void finish(const std::vector<WorldId>&) {}
  /// Whether begin() returns before the work is done, so that the caller can work on other worlds.
  virtual bool works_aside() const { return false; }

  /// States of all bodies in order of WorldDef::bodies; absent ones keep what they had (initially: NaN position).
  virtual std::vector<BodyState> states(WorldId world) const = 0;
  /// For each body, in the same order, whether the solver lets it sleep. Meant for progress and counters only; whether
  /// a body rests is decided in pour/.
  virtual std::vector<bool> asleep(WorldId world) const = 0;

  /// The contacts that carried a force in the last step, or when the bodies fell asleep. Empty if the solver reports no
  /// forces.
  virtual std::vector<ContactForce> contact_forces(WorldId /*world*/) const { return {}; }

  /// The worst contact of all steps since this was last asked, or since the world was made. None if the solver does not
  /// report depths.
  virtual std::optional<WorstContact> take_worst_contact(WorldId /*world*/) { return std::nullopt; }

  /// Observes worlds where they are simulated; none if states() costs nothing (world_watch.hpp).
  virtual WorldWatch* watch() { return nullptr; }

  /// Number of worlds that run faster side by side than one after the other.
  virtual std::size_t worlds_at_once() const { return 1; }
  virtual double step_size() const = 0;  ///< s: step with one collision detection
  virtual std::uint64_t steps(WorldId world) const = 0;
  virtual const Profile& profile() const = 0;  ///< stage times and counters since construction
  virtual std::vector<Flag> flags(WorldId world) const = 0;
  virtual std::string name() const = 0;    ///< "sphere", "sphere/thesis", "bullet"
  virtual std::string device() const = 0;  ///< GL_RENDERER or "cpu"

 private:
  [[noreturn]] void cannot_hold() const {
    throw input_error("grippers are not simulated by " + name(), "solver",
                      "use type sphere on the CPU without preset thesis");
  }
};

/// Most nodes of a distance field: those of all models together may take half of memory_budget. It depends on nothing
/// but the budget and how many models there are, so that a scene is the same in every job and on every machine.
std::size_t field_nodes_that_fit(const LoadedRequest& loaded);

/// The solver of a request. SolverType::automatic chooses by device, part and count from measured costs; the cause is
/// appended to `reason`.
std::unique_ptr<Solver> make_solver(const LoadedRequest& loaded, std::string& reason);

}  // namespace bin_scenes
