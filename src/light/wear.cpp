#include "light/wear.hpp"

#include "bin_scenes/core/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bin_scenes {

namespace {

/// A disc, as thick as a scratch is wide, or a ball.
struct Grain {
  Vec3 center, normal;
  double radius;
};

struct Grains {
  std::uint64_t number;  ///< distinguishes the kinds
  double radius;         ///< m, largest
  double width;          ///< m, of a disc; 0: a ball
  double ragged;         ///< amplitude of the outline's waves / radius

  static constexpr double smallest = 0.3;  ///< radius of a ball / radius
  double volume() const {
    if (width > 0.0) return M_PI * radius * radius * width;
    const double mean_cube = (1.0 - std::pow(smallest, 4)) / (4.0 * (1.0 - smallest));
    return 4.0 / 3.0 * M_PI * radius * radius * radius * mean_cube;
  }
  bool covers(const Grain& grain, const Vec3& point) const {
    const Vec3 offset = point - grain.center;
    if (width > 0.0 && !(std::abs(offset.dot(grain.normal)) < 0.5 * width)) return false;
    return offset.squaredNorm() < grain.radius * grain.radius;
  }
};

constexpr Grains scratch{1, 0.010, 0.0003, 0.0}, oil{2, 0.012, 0.0, 0.3}, rust{3, 0.008, 0.0, 0.4};

using Cell = std::array<std::int64_t, 3>;

/// All grains that may reach into a cell as wide as their radius: those of it and its neighbours. Each cell has as many
/// as Poisson's law says, the same whoever asks.
void find_grains(const Grains& kind, double share, const Random& key, const Cell& cell, std::vector<Grain>& out) {
  out.clear();
  const double in_cell = -std::log1p(-share) * kind.radius * kind.radius * kind.radius / kind.volume();
  const double none = std::exp(-in_cell);
  for (std::int64_t x = cell[0] - 1; x <= cell[0] + 1; ++x) {
    for (std::int64_t y = cell[1] - 1; y <= cell[1] + 1; ++y) {
      for (std::int64_t z = cell[2] - 1; z <= cell[2] + 1; ++z) {
        Random draw = key.of_piece(static_cast<std::uint64_t>(x))
                          .of_piece(static_cast<std::uint64_t>(y))
                          .of_piece(static_cast<std::uint64_t>(z));
        const Vec3 corner(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        for (double left = draw.uniform(); left > none; left *= draw.uniform()) {
          Grain grain;
          const double a = draw.uniform(), b = draw.uniform(), c = draw.uniform();
          grain.center = kind.radius * (corner + Vec3(a, b, c));
          const double up = draw.uniform(-1.0, 1.0), turn = draw.uniform(0.0, 2.0 * M_PI),
                       flat = std::sqrt(1.0 - up * up);
          grain.normal = Vec3(flat * std::cos(turn), flat * std::sin(turn), up);
          grain.radius = kind.radius * (kind.width > 0.0 ? 1.0 : draw.uniform(Grains::smallest, 1.0));
          out.push_back(grain);
        }
      }
    }
  }
}

/// Neighbouring points mostly ask for the same cell.
const std::vector<Grain>& grains_near(const Grains& kind, double share, std::uint64_t key, const Cell& cell) {
  struct Known {
    std::uint64_t number = 0, key = 0;
    double share = -1.0;
    Cell cell{};
    std::vector<Grain> grains;
  };
  thread_local std::array<Known, 256> cache;
  const std::uint64_t mixed = static_cast<std::uint64_t>(cell[0]) * 73856093u ^
                              static_cast<std::uint64_t>(cell[1]) * 19349663u ^
                              static_cast<std::uint64_t>(cell[2]) * 83492791u ^ key ^ kind.number * 2654435761u;
  Known& known = cache[(mixed ^ mixed >> 8) % cache.size()];
  if (known.number != kind.number || known.key != key || known.share != share || known.cell != cell) {
    find_grains(kind, share, Random(key, kind.number, Stream::sensor), cell, known.grains);
    known.number = kind.number, known.key = key, known.share = share, known.cell = cell;
  }
  return known.grains;
}

/// Waves that bend outlines. They do not know the grains, so that the share that is covered stays.
Vec3 bent(const Vec3& point, double radius, double amplitude) {
  Vec3 out = point;
  double size = radius, turn = 0.0;
  for (int octave = 0; octave < 3; ++octave, size *= 0.43, turn += 2.1) {
    const Vec3 at = 2.0 * M_PI / size *
                    Vec3(point.y() + 0.37 * point.z(), point.z() + 0.41 * point.x(), point.x() + 0.29 * point.y());
    out += 0.5 * amplitude * size *
           Vec3(std::sin(at.x() + turn), std::sin(at.y() + 2.0 * turn), std::sin(at.z() + 3.0 * turn));
  }
  return out;
}

bool covered(const Grains& kind, double mean, const Vec3& point, std::uint64_t key) {
  if (mean <= 0.0) return false;
  const double spread = std::min(mean, 1.0 - mean);
  const double share = mean + spread * Random(key, kind.number, Stream::plan).uniform(-1.0, 1.0);
  if (share >= 0.99) return true;
  const Vec3 place = kind.ragged > 0.0 ? bent(point, kind.radius, kind.ragged) : point;
  Cell cell;
  for (int i = 0; i < 3; ++i)
    cell[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::floor(place[i] / kind.radius));
  for (const Grain& grain : grains_near(kind, share, key, cell))
    if (kind.covers(grain, place)) return true;
  return false;
}

}  // namespace

Surface worn(Surface surface, const Vec3& point, std::uint64_t key) {
  const Texture& texture = surface.texture;
  if (covered(scratch, texture.scratches, point, key)) {
    surface.albedo *= 0.8;
    surface.roughness += 0.5 * (1.0 - surface.roughness);
    surface.anisotropy = 0.0;
  }
  if (covered(oil, texture.oil, point, key)) {
    surface.albedo *= 0.85;
    surface.roughness *= 0.6;
  }
  if (covered(rust, texture.rust, point, key)) {
    surface.albedo *= 0.4;
    surface.gloss *= 0.2;
    surface.roughness = std::max(surface.roughness, 0.9);
    surface.colour = surface.colour.cwiseProduct(Vec3(1.0, 0.55, 0.3));
    surface.anisotropy = 0.0;
  }
  return surface;
}

}  // namespace bin_scenes
