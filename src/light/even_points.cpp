#include "light/even_points.hpp"

namespace bin_scenes {

namespace {

constexpr int tile_bits = 5;  ///< a tile is 32 pixels wide and high: farther apart no filter mixes pixels
constexpr std::uint32_t tile = 1u << tile_bits;

std::uint32_t reversed(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

/// Flips each bit by a hash of the bits below it (constants: Vegdahl 2021, "Owen scrambling based on Burley").
std::uint32_t scrambled_upwards(std::uint32_t x, std::uint32_t key) {
  x ^= x * 0x3d20adeau;
  x += key;
  x *= (key >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Second coordinate of the Sobol sequence from the first one. Its matrix is Pascal's triangle modulo 2, a product of
/// five matrices that each add bits to bits (Ahmed 2024, "An implementation algorithm of 2D Sobol sequence").
std::uint32_t second(std::uint32_t x) {
  x ^= (x & 0x0000ffffu) << 16;
  x ^= (x & 0x00ff00ffu) << 8;
  x ^= (x & 0x0f0f0f0fu) << 4;
  x ^= (x & 0x33333333u) << 2;
  return x ^ (x & 0x55555555u) << 1;
}

/// The bits of a number below the size of a tile, each followed by a zero.
std::uint32_t spread(std::uint32_t x) {
  std::uint32_t out = 0;
  for (int bit = 0; bit < tile_bits; ++bit) out |= (x >> bit & 1u) << 2 * bit;
  return out;
}

}  // namespace

void EvenPoints::begin(Row& row, std::size_t index, std::size_t width) const {
  row.decisions_ = decisions_;
  row.places_.resize(width);
  const auto down = static_cast<std::uint32_t>(index % tile);
  for (std::size_t x = 0; x < width; ++x)
    row.places_[x] = spread(down) << 1 | spread(static_cast<std::uint32_t>(x % tile));
  row.scrambles_.clear();
  const Random own = key_.of_piece(index / tile);
  for (std::size_t first = 0; first < width; first += tile) {
    Random random = own.of_piece(first / tile);
    for (int i = 0; i < decisions_; ++i) {
      const std::uint64_t a = random.next(), b = random.next();
      row.scrambles_.push_back(
          {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32), static_cast<std::uint32_t>(b)});
    }
  }
}

/// Numbers are reversed most of the time: first bits last.
Eigen::Vector2d EvenPoints::Row::at(std::size_t column, int decision, std::uint32_t number, std::uint32_t count) const {
  const Scramble& scramble =
      scrambles_[column / tile * static_cast<std::size_t>(decisions_) + static_cast<std::size_t>(decision)];
  const std::uint32_t x = scrambled_upwards(reversed(places_[column] * count + number), scramble.order);
  const auto in_unit = [](std::uint32_t value, std::uint32_t key) {
    return reversed(scrambled_upwards(reversed(value), key)) * 0x1p-32;
  };
  return {in_unit(x, scramble.x), in_unit(second(x), scramble.y)};
}

}  // namespace bin_scenes
