/// Sorts items by small integers in linear time, and keeps the order of equal items. The passes sort pairs, manifolds
/// and blocks with it; the kept order makes results repeatable.
#pragma once

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bin_scenes::sphere {

/// Sorts `items` stably by `key(item)` < `count` into `sorted`. `start`: index of each key's first item, then the end.
template <class Items, class Item, class Key>
void counting_sort(const Items& items, std::size_t count, const Key& key, std::vector<std::uint32_t>& start,
                   std::vector<Item>& sorted) {
  BIN_SCENES_ASSERT(each_is(items, [&](const Item& item) { return static_cast<std::size_t>(key(item)) < count; }));
  start.assign(count + 1, 0);
  for (const Item& item : items) ++start[key(item) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  sorted.resize(start.back());
  for (const Item& item : items) sorted[start[key(item)]++] = item;
  std::copy_backward(start.begin(), start.end() - 1, start.end());  // each start stands where the next one began
  start.front() = 0;
}

}  // namespace bin_scenes::sphere
