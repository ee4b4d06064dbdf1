/// The state machine of one heap: which parts are in the bin, waiting, at rest or gone, and which stage of settling it
/// is in. The caller advances the solver (settle_heaps.hpp), so that many heaps of one solver are simulated together.
#pragma once

#include "pour/device_watch.hpp"
#include "pour/energy_audit.hpp"
#include "pour/pour_plan.hpp"
#include "pour/settling.hpp"

#include "bin_scenes/pour/pour.hpp"
#include "bin_scenes/pour/rest_watch.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace bin_scenes {

class HeapCore final : private HeapView {
 public:
  HeapCore(std::shared_ptr<const PourPlan> plan, Solver& solver, std::size_t index);
  ~HeapCore() override;
  HeapCore(const HeapCore&) = delete;
  HeapCore& operator=(const HeapCore&) = delete;

  // Changes between two settles.
  /// Replaces the plan by one with further part lines at its end, whose parts enter.
  void extend(std::shared_ptr<const PourPlan> plan);
  void remove(std::size_t body);
  void set_gravity(const Vec3& gravity);
  /// Moves bodies along a unit vector at a given speed, and simulates all others meanwhile.
  void lift(const std::vector<std::size_t>& bodies, const Vec3& direction, double distance, const RunHooks& hooks);
  /// Recovers from a cancelled step: makes a new world with the states of the last observation and settles it again.
  void recover();

  // Settling.
  /// Sets the clock to 0; the present stage continues.
  void start_clock();
  std::size_t index() const { return index_; }
  WorldId id() const { return id_; }
  Solver& solver() const { return solver_; }
  double time() const { return time_; }  ///< s of simulated time since the clock was started
  const std::vector<BodyState>& states();
  /// Returns the time (s) that is left until Request::seconds; infinity if it is not set.
  double time_left() const;
  /// Announces that the next `seconds` will be simulated, and that the heap is observed at their end if a slice of time
  /// or the given time ends then. If the device of the solver observes worlds, this requests an observation.
  void ask(double seconds, bool slice_ends);
  void advanced(double seconds);
  /// Whether the heap cannot be advanced further, as far as its device has observed it; call it after advanced(). The
  /// states of the solver must then be read before update(). Always false for solvers whose device does not observe
  /// worlds.
  bool wants_states();
  /// Updates rest and escape, inserts waiting parts, and applies the transitions between stages. Call it at the end of
  /// a slice of time, and then change_world(). Different heaps of a solver may be updated by different threads at the
  /// same time.
  void advance();
  /// Changes to the world without raised walls when all parts have entered; this may be a new world.
  void change_world();
  /// Updates rest and escape only, at the end of a given time. `driven`: see EnergyAudit::observe().
  void update_rest(bool driven);
  /// Whether the bin or parts follow a motion now. If so, follow() must be called before each step.
  bool follows() const { return course_ == Course::moving; }
  void follow(double seconds);  ///< moves them to their present poses, with their velocities for the next `seconds`
  bool over() const;
  Progress progress() const;

  bool has(int id) const;  ///< whether the part was poured and not removed
  bool settled() const { return settling_.done(); }
  bool at_rest() const { return all_in() && all_rest(); }
  Scene scene();
  const PourPlan& plan() const { return *plan_; }

 private:
  enum class Place { waiting, in, escaped, no_room, removed };
  enum class Course { ahead, moving, over };  ///< state of the prescribed motions

  /// Asks the solver for the worst contact of the world since the last call, and records it.
  void note_worst();
  void make_world(bool raised_walls, const std::vector<std::size_t>& lifted = {});  ///< lifted bodies get a large mass
  void remake_world(const std::vector<std::size_t>& lifted, const std::vector<bool>& woken);
  std::vector<bool> dragged_by(const std::vector<std::size_t>& lifted, const Vec3& direction) const;
  void wake(const std::vector<bool>& bodies);
  std::vector<bool> unverified() const;  ///< bodies that moved in the last check
  void let_go();                         ///< gives lifted bodies their own masses again
  bool is_kept(std::size_t body) const { return !kept_.empty() && kept_[body]; }
  bool is_kept(const ContactForce& force)
      const;            ///< whether all bodies on which the force acts are asleep since the world was made again
  void release_kept();  ///< forgets the forces of bodies that have woken
  void wake_kept_beside(std::size_t body);   ///< wakes the neighbours of a body that is removed
  std::vector<ContactForce> forces() const;  ///< forces of the last step, or from when the bodies fell asleep
  void begin(Stage stage);
  void set_solver_phase();
  void insert(std::size_t body, const BodyState& state);
  /// Places the parts from body `first` on at their start poses. Returns whether some of them enter from above.
  bool enter(std::size_t first);
  void start_given(std::size_t first);
  void lay_on_table(std::size_t body);
  void start_grid();
  void start_rain();
  void insert_waiting();
  void cut_walls();
  double motion_seconds() const;
  void put_on_path(double t, double dt, bool ends);
  void begin_motion();
  bool end_motion();  ///< ends a motion that is over, after which the heap settles again
  PartState state_of(std::size_t body) const;
  bool outside(const Vec3& center) const;
  WatchRules rules() const;
  void take_observation();  ///< reads the observation of the device
  void begin_watch();       ///< starts the observation of a new world by the device
  void leave_world();       ///< removes the world from the solver
  void restart_rest();
  void restart_watch();
  bool resting(std::size_t body) const;
  double still(std::size_t body) const;  ///< s since the body last moved
  std::size_t unrested() const;
  bool slow(std::size_t body) const;
  double top() const;
  bool moves(std::size_t body) const;  ///< whether the body is present and not fixed
  template <class Test>
  std::size_t count_moving(Test test) const;
  const PartModel& part(std::size_t body) const { return *plan_->world.parts[plan_->line_of[body]]; }

  // HeapView
  bool all_in() const override { return waiting_.empty(); }
  bool all_slow() const override;
  bool all_rest() const override;
  bool all_asleep() const override;
  std::size_t count() const override;
  std::size_t still_for_less_than(double seconds) const override;
  double rest_window() const override { return plan_->request.pour.rest_window; }

  std::shared_ptr<const PourPlan> plan_;
  Solver& solver_;
  std::size_t index_;
  WorldId id_ = 0;
  Random random_;
  Settling settling_;
  double time_ = 0.0;
  /// Number of steps of earlier worlds since the clock was started, minus the steps of this world before that.
  std::uint64_t earlier_steps_ = 0;
  bool fresh_ = false, walls_raised_ = false;
  bool poured_ = false;  ///< whether parts entered in the last slice of time
  bool lifts_ = false;   ///< whether the world has lifted bodies
  /// Bodies that have slept since the world was made again. They keep their states, which a solver would return with
  /// rounding errors, and the forces between them, which the new world does not know.
  std::vector<bool> kept_;
  std::vector<ContactForce> kept_forces_;
  Course course_ = Course::ahead;
  double course_begun_ = 0.0;  ///< s, start of the present motions
  /// First part line whose motions belong to the present course; those of earlier lines and of the bin are over.
  std::size_t moving_from_ = 0;
  std::vector<BodyState> states_;
  std::vector<Place> place_;
  std::vector<std::size_t> waiting_;   ///< indices of bodies that have not entered, the next one first
  std::optional<DeviceWatch> device_;  ///< is used instead of the next two members if the solver has a WorldWatch
  RestWatch rest_;
  std::optional<EnergyAudit> audit_;  ///< audit of this settle()
  WorstReport::Penetration deepest_;  ///< deepest contact of this settle()
  std::uint64_t unresolved_impacts_ = 0;
};

}  // namespace bin_scenes
