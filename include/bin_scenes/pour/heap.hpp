/// A heap that outlives its scene: parts are poured, taken out and added, and it settles again. A scene is a snapshot
/// of it.
///
///     Heap heap({request, parts}, solver);
///     heap.settle();                       // pours
///     heap.remove({3});                    // a pick
///     heap.settle();                       // only what part 3 held up moves
///     Scene scene = heap.scene();
#pragma once

#include "bin_scenes/pour/pour.hpp"

#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

/// A part line to be added, with its model.
struct NewParts {
  PartLine line;
  PartModelPtr part;
};

/// The indices of the scenes to make: a function instead of a list, since a request may ask for a thousand million.
struct SceneList {
  std::size_t count = 0;
  std::function<std::size_t(std::size_t place)> index;
};

/// A heap may be used by one thread at a time, like its solver.
class Heap {
 public:
  /// Scene `index` of the request, not poured yet. The model of a mesh bin is loaded through the cache when not given;
  /// `solver_reason`: of make_solver(), for the report.
  Heap(const LoadedRequest& loaded, std::shared_ptr<Solver> solver, std::size_t index = 0,
       std::string solver_reason = "");
  Heap(Heap&&) noexcept;
  Heap& operator=(Heap&&) noexcept;
  ~Heap();

  /// Pours more onto the heap: lines are added to the request, and their parts enter during the next settle(), in which
  /// all parts may move; those with poses are put there. Returns the ids of the new parts, which follow those that are
  /// there. An id is a part's for the life of the heap.
  std::vector<int> add(const std::vector<NewParts>& lines);

  /// Takes parts out (PartState::removed from now on). If the heap was at rest, all others sleep but those that touched
  /// them: during the next settle() these parts move, and the parts that they wake in turn. The poses of all others
  /// stay the same bit for bit, if the solver can let parts sleep (preset thesis cannot). Throws an input Error, before
  /// anything has changed, for an id that is not there.
  void remove(const std::vector<int>& ids);

  /// Moves parts, without turning them, by `distance` (m, up to 10) along `direction` (bin frame) at 0.1 m/s, as by a
  /// gripper that nothing can stop. What lies on them or hangs in them is dragged along; what none of it touches keeps
  /// its pose bit for bit. Afterwards the parts are dynamic again: remove() them, or settle() to let them fall. Throws
  /// an input Error as remove(), also for a fixed part or no direction; Error(cancelled) as settle().
  void lift(const std::vector<int>& ids, const Vec3& direction, double distance, const RunHooks& hooks = {});

  /// Tilts or turns the heap: gravity in the bin frame (m/s2). All parts wake.
  void set_gravity(const Vec3& gravity);

  /// Simulates until the heap rests, or for Pour::limit, from now on; with Request::seconds for exactly that time.
  /// Returns whether all parts rest. Throws Error(cancelled) if a hook asks for it; the heap can then be changed,
  /// observed, or settled further.
  bool settle(const RunHooks& hooks = {});

  /// The present state: ids, poses and states, and from the last settle() simulated_s, wall_s, steps, finish and
  /// profile. Quality and visibility are filled in by quality/ and sensor/, not here.
  Scene scene() const;

  const Request& request() const;                  ///< with the lines that were added, and the gravity of now
  const std::vector<PartModelPtr>& parts() const;  ///< by part line
  LoadedRequest loaded() const;                    ///< both, with the model of the bin
  const std::shared_ptr<Solver>& solver() const;
  const std::string& solver_reason() const;

 private:
  friend void settle_scenes(const LoadedRequest&, const std::shared_ptr<Solver>&, const std::string&, const SceneList&,
                            const RunHooks&, const std::function<void(std::size_t, Heap&&)>&);
  struct State;
  explicit Heap(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Heap::settle() of many scenes of a request, Solver::worlds_at_once() of them at a time: a heap that is done is
/// handed to `settled`, from the calling thread, with its place in the list, and the next takes its place. A scene
/// depends on (request, seed, index) alone, not on what runs beside it.
void settle_scenes(const LoadedRequest& loaded, const std::shared_ptr<Solver>& solver, const std::string& solver_reason,
                   const SceneList& scenes, const RunHooks& hooks,
                   const std::function<void(std::size_t place, Heap&& heap)>& settled);

}  // namespace bin_scenes
