#include "bin_scenes/gl/prefix_sum.hpp"

namespace bin_scenes::gl {

namespace {
constexpr std::size_t block = 1024;  // THREADS * PER_THREAD of prefix_sum.comp
constexpr std::size_t word = sizeof(std::uint32_t);
std::size_t blocks_of(std::size_t count) {
  return (count + block - 1) / block;
}
}  // namespace

PrefixSum::PrefixSum()
    : sum_(Program::compute("gl/prefix_sum.comp", {{"PASS_SUM", ""}})), scan_(Program::compute("gl/prefix_sum.comp")) {}

void PrefixSum::run(const Buffer<std::uint32_t>& in, Buffer<std::uint32_t>& out, std::size_t count) {
  if (out.size() < count + 1) out.resize(count + 1);
  level(in.storage(), out.storage(), count, 0);
}

void PrefixSum::level(const Storage& in, Storage& out, std::size_t count, std::size_t depth) {
  if (block_sums_.size() <= depth) {
    block_sums_.emplace_back("prefix_sum.block_sums");
    block_starts_.emplace_back("prefix_sum.block_starts");
  }
  // Held by index: the vectors may move when a deeper level appends to them.
  const std::size_t blocks = blocks_of(count);
  block_sums_[depth].grow(blocks * word);
  block_starts_[depth].grow((blocks + 1) * word);

  if (count >= block) {  // a full last block also needs the total after it
    in.bind(0);
    block_sums_[depth].bind(1);
    sum_.use();
    sum_.set("count", static_cast<unsigned>(count));
    dispatch_groups(sum_, blocks);
    Storage sums = std::move(block_sums_[depth]), starts = std::move(block_starts_[depth]);
    level(sums, starts, blocks, depth + 1);
    block_sums_[depth] = std::move(sums), block_starts_[depth] = std::move(starts);
  } else {
    block_starts_[depth].clear();  // a single block starts at 0
  }

  in.bind(0);
  block_starts_[depth].bind(1);
  out.bind(2);
  scan_.use();
  scan_.set("count", static_cast<unsigned>(count));
  dispatch_groups(scan_, blocks_of(count + 1));
}

}  // namespace bin_scenes::gl
