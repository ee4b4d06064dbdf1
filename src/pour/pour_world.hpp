/// One scene while it is poured: which parts are in, which wait, which rest, which escaped.
#pragma once

#include "pour/energy_audit.hpp"
#include "pour/pour_plan.hpp"

#include "bin_scenes/pour/pour.hpp"
#include "bin_scenes/pour/rest_watch.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

class PourWorld {
 public:
  PourWorld(const PourPlan& plan, Solver& solver, std::size_t index);
  ~PourWorld();
  PourWorld(const PourWorld&) = delete;
  PourWorld& operator=(const PourWorld&) = delete;

  std::size_t index() const { return index_; }
  WorldId id() const { return id_; }
  double time() const { return time_; }
  const std::vector<BodyState>& states();
  /// s until the request's set time; infinity without one.
  double time_left() const;

  void advanced(double seconds) { time_ += seconds, fresh_ = false; }
  /// Judges rest and escape, lets parts in, cuts the walls back. Call on whole slices.
  void look();
  void judge();  ///< only judges, at the end of a set time
  bool over() const;
  Progress progress() const;
  Scene scene();

 private:
  enum class Place { waiting, in, escaped, no_room };

  void insert(std::size_t body, const BodyState& state);
  void start_given();
  void start_grid();
  void start_rain();
  void let_in();
  void cut_walls();
  void settle();
  void ask(Phase phase);
  void judge_answer();
  bool outside(const Vec3& center) const;
  bool slow(std::size_t body) const;
  double top() const;
  bool moves(std::size_t body) const;  ///< it is in and not fixed
  bool all_rest() const;
  bool all_slow() const;
  std::size_t less_still_than(double seconds) const;  ///< parts that stayed for less
  bool all_still(double seconds) const { return less_still_than(seconds) == 0; }
  bool too_many(std::size_t moved) const;  ///< for a heap that stands
  bool all_asleep() const;
  void enter(Phase phase);

  const PourPlan& plan_;
  Solver& solver_;
  std::size_t index_;
  WorldId id_ = 0;
  Random random_;
  double time_ = 0.0;
  std::uint64_t earlier_steps_ = 0;  ///< of a world left behind when the walls were cut
  Phase phase_ = Phase::pour;
  bool fresh_ = false, walls_cut_ = true;
  bool heeds_phases_ = true;  ///< the solver
  int questions_ = 0;
  bool asked_ = false;        ///< whether the heap stands; the answer is awaited
  double asked_since_ = 0.0;  ///< start of the last question
  bool stood_ = false;        ///< the last question, or need not be asked
  bool goes_on_ = false;      ///< from given poses that may be at rest; not decided yet
  std::vector<BodyState> states_;
  std::vector<Place> place_;
  std::vector<std::size_t> waiting_;  ///< bodies still to come, next one first
  RestWatch rest_;
  EnergyAudit audit_;
};

}  // namespace bin_scenes
