/// Advances heaps in slices of 1/60 s and observes them between slices. While the device works on one group of heaps,
/// the other one is observed.
#include "pour/settle_heaps.hpp"

#include "bin_scenes/solver/world_watch.hpp"
#include "solver/step_limit.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr double slice_seconds = 1.0 / 60.0;  ///< simulated time between two observations of a heap

struct Running {
  std::size_t number;
  HeapCore* heap;
  bool under_way = false;  ///< the device works on its steps
  bool ended = false;      ///< its steps have ended, and it was not observed since
};

/// Heaps that are simulated and observed together. Of two groups one is observed while the device works on the
/// other.
struct Group {
  std::vector<Running> running;
  std::uint64_t left = 0;         ///< steps to the end of the slice
  std::uint64_t clock = 0;        ///< steps of the heap that is traced
  bool begun = false;             ///< a piece of the slice
  bool together = true;           ///< all heaps end it at once; otherwise some go on in the next one (WorldWatch)
  std::uint64_t begun_steps = 0;  ///< its steps
  double seconds = 0.0;           ///< simulated by them
  std::vector<WorldId> under_way() const {
    std::vector<WorldId> ids;
    for (const Running& r : running)
      if (r.under_way) ids.push_back(r.heap->id());
    return ids;
  }
};

/// Steps of all heaps of a group.
struct Piece {
  std::uint64_t steps = 0;
  double seconds = 0.0;
};

class Run {
 public:
  Run(Solver& solver, const HeapSource& source, const RunHooks& hooks)
      : solver_(solver),
        source_(source),
        hooks_(hooks),
        step_(solver.step_size()),
        slice_(static_cast<std::uint64_t>(std::max(1.0, std::round(slice_seconds / step_)))),
        tracing_(hooks.trace && hooks.trace_rate > 0.0) {
    // Trace samples count from each heap's own start, so a traced heap runs by itself. It makes no other difference.
    const std::size_t at_once = tracing_ ? 1 : std::max<std::size_t>(1, solver.worlds_at_once());
    groups_.resize(solver.works_aside() && at_once > 1 ? 2 : 1);
    group_size_ = at_once / groups_.size();
  }

  void all() {
    for (Group& group : groups_) fill(group);
    while (over_ < source_.count) {
      for (Group& group : groups_) {
        if (hooks_.cancel && hooks_.cancel->load()) cancel();
        if (group.begun) end_slice(group);
        group.begun = !group.running.empty();
        if (group.begun) begin_piece(group);
      }
    }
  }

 private:
  void fill(Group& group) {
    if (group.running.empty()) group.clock = 0;
    while (group.running.size() < group_size_ && next_ < source_.count) {
      group.running.push_back({next_, &source_.next(next_)});
      ++next_;
      if (tracing_) sample(*group.running.back().heap);
    }
    group.left = slice_;
  }

  /// A slice, or less where a trace sample or a heap's set time is due before its end.
  Piece next_piece(const Group& group) const {
    std::uint64_t steps = group.left;
    if (tracing_) steps = std::min(steps, next_sample(group.clock) - group.clock);
    double seconds = static_cast<double>(steps) * step_;
    for (const Running& r : group.running) seconds = std::min(seconds, r.heap->time_left());
    for (const Running& r : group.running)
      if (r.heap->follows()) seconds = std::min(seconds, step_);
    return {steps_in(seconds, step_).count(), seconds};
  }

  /// Heaps that are still under way go on.
  void begin_piece(Group& group) {
    const auto [steps, seconds] = next_piece(group);
    for (Running& r : group.running)
      if (r.heap->follows() && seconds > 0.0) r.heap->follow(seconds);
    for (Running& r : group.running)
      if (!r.under_way) r.heap->ask(seconds, steps == group.left);
    group.begun_steps = steps;
    group.seconds = seconds;
    group.together = !solver_.watch() || steps < slice_;
    if (steps == 0) return;
    for (Running& r : group.running) r.under_way = true;
    if (group.together)
      group.seconds = solver_.begin(group.under_way(), seconds);
    else
      solver_.watch()->begin_some(group.under_way(), seconds);
  }

  void finish(Group& group) {
    if (group.together)
      solver_.finish(group.under_way());
    else
      solver_.watch()->finish_some(group.under_way());
    for (Running& r : group.running) {
      if (!r.under_way) continue;
      r.under_way = !group.together && solver_.watch()->under_way(r.heap->id());
      r.ended = !r.under_way;
      if (r.ended) r.heap->advanced(group.seconds);
    }
  }

  void end_piece(Group& group) {
    if (group.begun_steps == 0) {  // the time of all is over
      for (Running& r : group.running) r.ended = true;
      return;
    }
    finish(group);
    const bool due = tracing_ && group.clock + group.begun_steps == next_sample(group.clock);
    group.clock += group.begun_steps;
    group.left -= group.begun_steps;
    if (due)
      for (Running& r : group.running) sample(*r.heap);
  }

  /// Of heaps that are about to change, by this thread: the others need no states.
  void read_states(Group& group) {
    WorldWatch* const watch = solver_.watch();
    if (!watch) return;
    std::vector<WorldId> ids;
    for (Running& r : group.running)
      if (r.ended && r.heap->wants_states()) ids.push_back(r.heap->id());
    watch->read(ids);
  }

  void end_slice(Group& group) {
    end_piece(group);
    observe(group);
    while (!group.under_way().empty() && next_piece(group).steps < slice_) {
      end_all(group);  // a shorter piece is one of all heaps
      observe(group);
    }
  }

  /// Of heaps that were left under way.
  void end_all(Group& group) {
    group.together = true;
    solver_.begin(group.under_way(), group.seconds);
    finish(group);
  }

  /// Heaps that have ended their steps.
  void observe(Group& group) {
    read_states(group);
    leave_if(group, [](HeapCore& heap) {
      if (heap.time_left() > 0.0) return false;
      heap.update_rest(heap.follows());
      return true;
    });
    if (group.left == 0) {
      advance(group);
      report(group);
      leave_if(group, [](HeapCore& heap) { return heap.over(); });
    }
    for (Running& r : group.running) r.ended = false;
    if (group.left == 0 || group.running.empty()) fill(group);
  }

  /// On all cores: on a fast device, one thread could not observe all worlds in the time that it takes for a slice.
  static void advance(Group& group) {
    std::vector<HeapCore*> heaps;
    for (const Running& r : group.running)
      if (r.ended) heaps.push_back(r.heap);
    const auto advance_heap = [&, flag = cancel_flag()](std::size_t i) {
      const CancelScope scope(flag);
      heaps[i]->advance();
    };
    if (heaps.size() == 1)
      advance_heap(0);
    else  // no scene is judged by this thread meanwhile
      tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, heaps.size(), advance_heap); });
    for (HeapCore* heap : heaps) heap->change_world();
  }

  template <class Over>
  void leave_if(Group& group, Over over) {
    const auto leaves = [&](Running& r) {
      if (!r.ended || !over(*r.heap)) return false;
      if (tracing_ && r.heap->time() > last_sample_) sample(*r.heap);
      ++over_;
      source_.over(r.number);
      return true;
    };
    group.running.erase(std::remove_if(group.running.begin(), group.running.end(), leaves), group.running.end());
  }

  void report(const Group& observed) {
    if (!hooks_.progress) return;
    double sum = static_cast<double>(over_);
    for (const Group& group : groups_)
      for (const Running& r : group.running) sum += r.heap->progress().fraction;
    fraction_ = std::max(fraction_, sum / static_cast<double>(source_.count));
    for (const Running& r : observed.running) {
      Progress progress = r.heap->progress();
      progress.fraction = fraction_;
      hooks_.progress(progress);
    }
  }

  void sample(HeapCore& heap) {
    last_sample_ = heap.time();
    if (hooks_.trace_contacts) hooks_.trace_contacts(solver_.contact_forces(heap.id()));
    hooks_.trace(heap.index(), last_sample_, heap.states());
  }
  /// Step at whose end the next sample of a trace is due: the one nearest to a multiple of 1 / rate.
  std::uint64_t next_sample(std::uint64_t now) const {
    const double rate = hooks_.trace_rate;
    const double number = std::floor((static_cast<double>(now) + 0.5) * step_ * rate) + 1.0;
    return std::max(now + 1, static_cast<std::uint64_t>(std::llround(number / (rate * step_))));
  }

  /// What the device works on is finished first: a running world takes no change.
  [[noreturn]] void cancel() {
    for (Group& group : groups_) {
      if (group.begun) end_piece(group);
      if (!group.under_way().empty()) end_all(group);
      for (Running& r : group.running) r.heap->states();  // from which it can be recovered
    }
    throw Error(ErrorKind::cancelled, "cancelled", "pour", "ask again");
  }

  Solver& solver_;
  const HeapSource& source_;
  const RunHooks& hooks_;
  double step_;          ///< s
  std::uint64_t slice_;  ///< steps
  bool tracing_;
  std::size_t group_size_ = 1;
  std::vector<Group> groups_;
  std::size_t next_ = 0, over_ = 0;
  double fraction_ = 0.0;
  double last_sample_ = 0.0;  ///< s
};

}  // namespace

void settle_heaps(Solver& solver, const HeapSource& source, const RunHooks& hooks) {
  Run(solver, source, hooks).all();
}

}  // namespace bin_scenes
