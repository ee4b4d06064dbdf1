/// Union-find: the connected components of numbered items. Islands of touching parts and shells of meshes are found
/// with it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bin_scenes {

/// Union-find with path halving. The root of a set is its lowest member, so that it does not depend on the order in
/// which members were joined.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) { reset(count); }

  /// Starts again with `count` items, each in a set of its own. Allocated memory is kept.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::size_t size() const { return parent_.size(); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace bin_scenes
