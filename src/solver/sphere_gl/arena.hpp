/// Allocates regions in a growing buffer by first fit. The position of a region never influences a result.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>

namespace bin_scenes::sphere_gl {

class Arena {
 public:
  /// Reserves a region of `count` elements, at least one, and returns the index of its first element.
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
  /// Enlarges the region that begins at `first` to `count` elements; returns false if the next region is in the way.
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
  std::size_t size() const { return size_; }  ///< largest number of elements that the buffer has needed so far

 private:
  std::map<std::size_t, std::size_t> taken_;  // regions: index of the first element, number of elements
  std::size_t size_ = 0;
};

}  // namespace bin_scenes::sphere_gl
