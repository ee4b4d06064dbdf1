#include "solver/sphere/shapes/edge_grid.hpp"

#include "solver/sphere/passes/edge_contact.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bin_scenes::sphere {

namespace {

int blocks_along(int nodes) {
  return std::max(nodes - 2, 0) / EdgeGrid::block + 1;
}

/// `visit(block)` for each block that the edge may come within reach of.
template <class Visit>
void for_each_block(const Samples& samples, const Edge& edge, const Field& field, const Visit& visit) {
  const Vec3f a = (node_at(samples, edge.a) - field.origin) * field.inverse_cell;
  const Vec3f b = (node_at(samples, edge.b) - field.origin) * field.inverse_cell, along = b - a;
  const int count[3] = {blocks_along(field.nx), blocks_along(field.ny), blocks_along(field.nz)};
  int lower[3], upper[3];
  for (int i = 0; i < 3; ++i) {
    const auto block_at = [&](float x) {
      return std::clamp(static_cast<int>(std::floor(x / EdgeGrid::block)), 0, count[i] - 1);
    };
    lower[i] = block_at(std::min(a[i], b[i]) - EdgeGrid::reach);
    upper[i] = block_at(std::max(a[i], b[i]) + EdgeGrid::reach);
  }
  const float far = EdgeGrid::reach + 0.5f * std::sqrt(3.0f) * EdgeGrid::block;
  for (int z = lower[2]; z <= upper[2]; ++z)
    for (int y = lower[1]; y <= upper[1]; ++y)
      for (int x = lower[0]; x <= upper[0]; ++x) {
        const Vec3f from_a = (Vec3f(x, y, z) + Vec3f::Constant(0.5f)) * EdgeGrid::block - a;
        const float t = std::clamp(from_a.dot(along) / std::max(along.squaredNorm(), 1e-12f), 0.0f, 1.0f);
        if ((from_a - t * along).squaredNorm() <= far * far) visit(x + count[0] * (y + count[1] * z));
      }
}

}  // namespace

std::pair<std::uint32_t, std::uint32_t> EdgeGrid::near(const Field& field, const Vec3f& point) const {
  if (first.empty()) return {0, 0};
  const Vec3f g = (point - field.origin) * field.inverse_cell;
  const auto block_at = [](float x, int nodes) {
    return static_cast<int>(std::min(std::max(x, 0.0f), static_cast<float>(nodes) - 1.001f)) / block;
  };
  const int at = block_at(g.x(), field.nx) + row * block_at(g.y(), field.ny) + slice * block_at(g.z(), field.nz);
  return {first[at], first[at + 1]};
}

EdgeGrid make_edge_grid(const Samples& samples, const Field& field) {
  EdgeGrid grid;
  if (field.ball > 0) return grid;
  grid.row = blocks_along(field.nx);
  grid.slice = grid.row * blocks_along(field.ny);
  grid.first.assign(std::size_t(grid.slice) * blocks_along(field.nz) + 1, 0);
  for (const Edge& edge : samples.edges) for_each_block(samples, edge, field, [&](int at) { ++grid.first[at + 1]; });
  std::partial_sum(grid.first.begin(), grid.first.end(), grid.first.begin());
  grid.edges.resize(grid.first.back());
  std::vector<std::uint32_t> next(grid.first.begin(), grid.first.end() - 1);
  for (std::uint32_t e = 0; e < samples.edges.size(); ++e)
    for_each_block(samples, samples.edges[e], field, [&](int at) { grid.edges[next[at]++] = e; });
  return grid;
}

}  // namespace bin_scenes::sphere
