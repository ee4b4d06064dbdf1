/// L1 of a multiprocessor: lines of 128 bytes, filled by sectors of 32, least recently used out first.
#pragma once

#include <cstdint>
#include <list>
#include <unordered_map>
#include <utility>

namespace bin_scenes::meter {

class Cache {
 public:
  explicit Cache(std::size_t bytes) : most_lines_(bytes / 128) {}

  /// Whether the sector was there; it is afterwards.
  bool touch(std::uint64_t sector) {
    const std::uint64_t line = sector / 4;
    const unsigned bit = 1u << sector % 4;
    const auto known = lines_.find(line);
    if (known != lines_.end()) {
      order_.splice(order_.begin(), order_, known->second);
      const bool hit = known->second->second & bit;
      known->second->second |= bit;
      return hit;
    }
    order_.push_front({line, bit});
    lines_[line] = order_.begin();
    if (order_.size() > most_lines_) {
      lines_.erase(order_.back().first);
      order_.pop_back();
    }
    return false;
  }

 private:
  using Order = std::list<std::pair<std::uint64_t, unsigned>>;
  std::size_t most_lines_;
  Order order_;
  std::unordered_map<std::uint64_t, Order::iterator> lines_;
};

}  // namespace bin_scenes::meter
