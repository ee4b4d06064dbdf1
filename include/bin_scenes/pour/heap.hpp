/// A heap that exists longer than one scene: parts are poured, removed and added, and it settles again. A scene is a
/// snapshot of the heap. Grasps, images and quality are determined from the snapshot by other layers.
///
///     Heap heap({request, parts}, solver);
///     heap.settle();                       // pours
///     heap.remove({3});                    // a pick
///     heap.settle();                       // only the parts that part 3 supported move
///     Scene scene = heap.scene();
#pragma once

#include "bin_scenes/pour/pour.hpp"

#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

/// A part line to be added to a heap, with its model.
struct NewParts {
  PartLine line;
  PartModelPtr part;
};

/// The indices of the scenes to make. It is a function instead of a list, because a request may ask for 10^9 scenes.
struct SceneList {
  std::size_t count = 0;
  std::function<std::size_t(std::size_t place)> index;
};

/// One heap with its solver. Only one thread at a time may use it.
class Heap {
 public:
  /// Makes the heap of scene `index` of the request; nothing is poured yet. If the model of a mesh bin is not given, it
  /// is loaded through the cache. @param solver_reason  of make_solver(), for the report
  Heap(const LoadedRequest& loaded, std::shared_ptr<Solver> solver, std::size_t index = 0,
       std::string solver_reason = "");
  Heap(Heap&&) noexcept;
  Heap& operator=(Heap&&) noexcept;
  ~Heap();

  /// Adds parts to the heap: the lines are added to the request, and their parts enter during the next settle(), in
  /// which all parts may move. Parts with given poses start at these poses. Returns the ids of the new parts, which
  /// follow the ids that exist. A part keeps its id for the life of the heap.
  std::vector<int> add(const std::vector<NewParts>& lines);

  /// Removes parts (PartState::removed from now on). If the heap was at rest, all other parts sleep except those that
  /// touched the removed ones: during the next settle(), these parts move, and so do the parts that they wake. The
  /// poses of all others stay the same bit for bit, if the solver lets parts sleep (preset thesis does not). Throws an
  /// input Error before anything has changed if an id is not in the heap.
  void remove(const std::vector<int>& ids);

  /// Moves parts without rotation by `distance` (m, up to 10) along `direction` (bin frame) at 0.1 m/s, like a gripper
  /// that nothing can stop. Parts that lie on them or are hooked to them are dragged along; parts that nothing in
  /// motion touches keep their poses bit for bit. Afterwards the parts are dynamic again: remove() them, or settle() to
  /// let them fall. Throws an input Error like remove(), and also for a fixed part or a zero direction; throws
  /// Error(cancelled) like settle().
  void lift(const std::vector<int>& ids, const Vec3& direction, double distance, const RunHooks& hooks = {});

  /// Sets gravity in the bin frame (m/s2), which tilts or turns the heap. All parts wake.
  void set_gravity(const Vec3& gravity);

  /// Simulates from now on until the heap is at rest or Pour::limit has passed; with Request::seconds, for exactly that
  /// time. Returns whether all parts are at rest. Throws Error(cancelled) if a hook asks for it; the heap can then be
  /// changed, observed, or settled further.
  bool settle(const RunHooks& hooks = {});

  /// Returns the present state: ids, poses and states, and from the last settle() simulated_s, wall_s, steps, finish
  /// and profile. Quality and visibility are filled in later by quality/ and sensor/.
  Scene scene() const;

  const Request& request() const;                  ///< with the lines that were added and the present gravity
  const std::vector<PartModelPtr>& parts() const;  ///< by part line
  LoadedRequest loaded() const;                    ///< request and models together, with the model of the bin
  const std::shared_ptr<Solver>& solver() const;
  const std::string& solver_reason() const;

 private:
  friend void settle_scenes(const LoadedRequest&, const std::shared_ptr<Solver>&, const std::string&, const SceneList&,
                            const RunHooks&, const std::function<void(std::size_t, Heap&&)>&);
  struct State;
  explicit Heap(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Calls Heap::settle() for many scenes of a request, Solver::worlds_at_once() of them at a time. A heap that is
/// finished is passed to `settled` in the calling thread, with its place in the list, and the next scene starts in its
/// place. A scene depends on (request, seed, index) only, not on the scenes that are simulated beside it.
void settle_scenes(const LoadedRequest& loaded, const std::shared_ptr<Solver>& solver, const std::string& solver_reason,
                   const SceneList& scenes, const RunHooks& hooks,
                   const std::function<void(std::size_t place, Heap&& heap)>& settled);

}  // namespace bin_scenes
