#include "light/even_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bin_scenes {
namespace {

constexpr int decisions = 3;

EvenPoints::Row row_of(std::size_t index, std::size_t width = 100) {
  EvenPoints::Row row;
  EvenPoints(Random(4, 0, Stream::sensor), decisions).begin(row, index, width);
  return row;
}

/// A net of 2^m points has exactly one point in each interval of 2^-k by 2^(k-m), for each k (Niederreiter 1987).
void expect_net(const std::vector<Eigen::Vector2d>& points) {
  const std::size_t count = points.size();
  for (std::size_t columns = 1; columns <= count; columns *= 2) {
    const std::size_t rows = count / columns;
    std::vector<int> in_cell(count, 0);
    for (const Eigen::Vector2d& p : points) {
      ASSERT_TRUE(p.x() >= 0.0 && p.x() < 1.0 && p.y() >= 0.0 && p.y() < 1.0);
      const auto x = static_cast<std::size_t>(p.x() * static_cast<double>(columns));
      const auto y = static_cast<std::size_t>(p.y() * static_cast<double>(rows));
      ++in_cell[y * columns + x];
    }
    for (const int inside : in_cell) ASSERT_EQ(inside, 1) << columns << " x " << rows;
  }
}

TEST(EvenPoints, PixelsAndSquaresOfPixelsHaveNets) {
  for (const std::uint32_t count : {1u, 4u, 64u}) {
    for (const std::size_t side : {1u, 2u, 8u}) {
      for (int decision = 0; decision < decisions; ++decision) {
        std::vector<Eigen::Vector2d> points;
        for (std::size_t y = 0; y < side; ++y) {
          const EvenPoints::Row row = row_of(40 + y);
          for (std::size_t x = 0; x < side; ++x)
            for (std::uint32_t i = 0; i < count; ++i) points.push_back(row.at(72 + x, decision, i, count));
        }
        expect_net(points);
      }
    }
  }
}

/// Few of the paths of a pixel reach a second surface or see one part of two: runs of points are even by themselves.
TEST(EvenPoints, HalvesAndQuartersAreNets) {
  const EvenPoints::Row row = row_of(3);
  for (const std::uint32_t size : {8u, 16u, 32u}) {
    for (std::uint32_t first = 0; first < 64; first += size) {
      std::vector<Eigen::Vector2d> points;
      for (std::uint32_t i = first; i < first + size; ++i) points.push_back(row.at(7, 1, i, 64));
      expect_net(points);
    }
  }
}

/// Where a point of one decision lies says nothing about the other decision of the same path: of two points that follow
/// each other, one is in the left half, by an order of its own in each decision. Of 64 paths, as many are left in both
/// decisions as of 32 throws of a coin: 16, with a standard deviation of the square root of 8.
TEST(EvenPoints, DecisionsAreIndependent) {
  double square = 0.0, pixels = 0.0;
  for (std::size_t index = 0; index < 64; ++index) {
    const EvenPoints::Row row = row_of(index, 64);
    for (std::size_t x = 0; x < 64; ++x, pixels += 1.0) {
      int both = 0;
      for (std::uint32_t i = 0; i < 64; ++i) both += row.at(x, 0, i, 64).x() < 0.5 && row.at(x, 1, i, 64).x() < 0.5;
      square += std::pow(both - 16.0, 2);
    }
  }
  EXPECT_NEAR(std::sqrt(square / pixels), std::sqrt(8.0), 0.2);
}

TEST(EvenPoints, AreUniformOverTiles) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), square = sum;
  double count = 0.0;
  for (std::size_t index = 0; index < 2048; index += 32) {
    const EvenPoints::Row row = row_of(index, 2048);
    for (std::size_t x = 0; x < 2048; x += 32, count += 1.0) {
      const Eigen::Vector2d p = row.at(x, 2, 0, 1);
      sum += p, square += p.cwiseProduct(p);
    }
  }
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(sum[k] / count, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / count));
    EXPECT_NEAR(square[k] / count, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / count));
  }
}

}  // namespace
}  // namespace bin_scenes
