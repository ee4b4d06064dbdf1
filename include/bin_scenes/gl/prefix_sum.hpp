/// Exclusive prefix sum of 32-bit counts: out[i] = in[0] + ... + in[i-1].
#pragma once

#include "bin_scenes/gl/program.hpp"

#include <vector>

namespace bin_scenes::gl {

/// "Reduce then scan" after Harris, Sengupta, Owens 2007 ("Parallel prefix sum (scan) with CUDA"): blocks are summed,
/// their sums are scanned one level up, and each block is scanned from its start value, with as many levels as the size
/// requires. The sums are integers, and therefore exact in any order.
class PrefixSum {
 public:
  PrefixSum();
  /// `out` gets count + 1 elements, the last one the total. `in` and `out` are different buffers.
  void run(const Buffer<std::uint32_t>& in, Buffer<std::uint32_t>& out, std::size_t count);

 private:
  void level(const Storage& in, Storage& out, std::size_t count, std::size_t depth);

  Program sum_, scan_;
  std::vector<Storage> block_sums_, block_starts_;
};

}  // namespace bin_scenes::gl
