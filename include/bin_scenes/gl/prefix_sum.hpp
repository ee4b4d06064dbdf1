/// Exclusive prefix sum of 32-bit counts on the GPU: out[i] = in[0] + ... + in[i-1]. Passes use it to turn the number
/// of results of each item into the position at which the item writes its results.
#pragma once

#include "bin_scenes/gl/program.hpp"

#include <vector>

namespace bin_scenes::gl {

/// The algorithm is "reduce, then scan" (Harris, Sengupta, Owens 2007, "Parallel prefix sum (scan) with CUDA"): blocks
/// are summed, their sums are scanned one level higher, and each block is scanned from its start value, with as many
/// levels as the size requires. The sums are integers and are therefore exact in any order.
class PrefixSum {
 public:
  PrefixSum();
  /// Writes count + 1 elements to `out`, of which the last one is the total. `in` and `out` must be different buffers.
  void run(const Buffer<std::uint32_t>& in, Buffer<std::uint32_t>& out, std::size_t count);

 private:
  void level(const Storage& in, Storage& out, std::size_t count, std::size_t depth);

  Program sum_, scan_;
  std::vector<Storage> block_sums_, block_starts_;
};

}  // namespace bin_scenes::gl
