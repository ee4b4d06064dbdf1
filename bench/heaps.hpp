/// Worlds that are piled from the first step on: one heap is poured once and set up as often as needed, so that the
/// cost of a step can be measured without pouring 65,536 parts.
#pragma once

#include "runs.hpp"

#include <memory>
#include <string>
#include <vector>

namespace bin_scenes::bench {

/// `count` parts at rest; kept in `path`, made if missing.
struct Heap {
  Request request;  ///< of one heap
  std::vector<BodyState> rest;
  double width = 0.0;  ///< edge of a square that holds the heap (m)
};
/// On an endless floor, with some room around it.
Heap heap_at_rest(const std::string& part, std::size_t count, const std::string& path);
/// In a box that wide: set up side by side in one box, without walls between them, they lean on each other.
Heap boxed_heap(const std::string& part, std::size_t count, double width, const std::string& path);

/// A solver with worlds of heaps in it.
class Heaps {
 public:
  /// `per_world` heaps side by side in each of `worlds` worlds.
  Heaps(const Heap& heap, const Request& settings, std::size_t per_world, std::size_t worlds);

  struct Cost {
    double wall_ms, cpu_ms;  ///< of a step of every world, mean over the steps
  };
  Cost steps(int count);
  /// Puts the first `share` of the bodies of each world where they are, at rest and awake.
  void wake(double share);
  std::size_t bodies() const { return bodies_; }
  double asleep() const;  ///< share of all bodies
  double joined() const;  ///< share of the first world's bodies that are one heap, each touching another of it
  Solver& solver() { return *solver_; }
  const Solver& solver() const { return *solver_; }

 private:
  std::vector<PartModelPtr> parts_;
  std::unique_ptr<Solver> solver_;
  std::vector<WorldId> worlds_;
  std::size_t bodies_ = 0;
};

}  // namespace bin_scenes::bench
