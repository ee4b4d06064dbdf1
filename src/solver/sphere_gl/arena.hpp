/// Allocates regions in a growing buffer by first fit. The place of a region never influences a result.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>

namespace bin_scenes::sphere_gl {

class Arena {
 public:
  /// First element of a region of `count`. An empty one takes an element, too: what is given back is its own.
  std::size_t take(std::size_t count) {
    count = std::max<std::size_t>(count, 1);
    std::size_t at = 0;
    for (const auto& [first, length] : taken_) {
      if (first >= at + count) break;
      at = first + length;
    }
    taken_[at] = count;
    size_ = std::max(size_, at + count);
    return at;
  }
  /// Enlarges a region in place; returns false if the next region leaves too little room.
  bool extend(std::size_t first, std::size_t count) {
    const auto region = taken_.find(first);
    if (region == taken_.end()) return false;
    const auto behind = std::next(region);
    if (behind != taken_.end() && behind->first < first + count) return false;
    region->second = count;
    size_ = std::max(size_, first + count);
    return true;
  }
  void give(std::size_t first) { taken_.erase(first); }
  std::size_t size() const { return size_; }  ///< elements ever in use

 private:
  std::map<std::size_t, std::size_t> taken_;  // first, count
  std::size_t size_ = 0;
};

}  // namespace bin_scenes::sphere_gl
