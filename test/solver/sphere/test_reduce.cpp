#include "solver/sphere/reduce.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace bin_scenes::sphere {
namespace {

constexpr float size = 0.05f, tilt = 0.014f;

Candidate at(const Vec3f& point, const Vec3f& normal, float separation, std::uint32_t feature) {
  return {point, point + separation * normal, normal, separation, feature, false};
}

/// A disk of 40 mm that stands on two teeth, 4 mm apart, with its face against a wall: the wall has 200 candidates.
std::vector<Candidate> disk_on_two_teeth() {
  std::vector<Candidate> all;
  for (int i = 0; i < 200; ++i) {
    const float angle = 2.4f * static_cast<float>(i), radius = 0.02f * std::sqrt(static_cast<float>(i) / 200.0f);
    all.push_back(at({radius * std::cos(angle), 0, radius * std::sin(angle)}, Vec3f::UnitY(), 1e-6f, all.size()));
  }
  for (const float x : {-0.002f, 0.002f})
    for (const float y : {-0.01f, -0.005f, 0.0f})
      all.push_back(at({x, y, -0.02f}, -Vec3f::UnitZ(), x > 0 ? 3e-5f : 0.0f, all.size()));
  return all;
}

std::set<std::uint32_t> features(const std::vector<Candidate>& candidates, int most) {
  std::vector<int> chosen;
  reduce(candidates, size, tilt, most, chosen);
  std::set<std::uint32_t> out;
  for (const int i : chosen) out.insert(candidates[i].feature);
  EXPECT_EQ(out.size(), chosen.size()) << "none twice";
  EXPECT_LE(chosen.size(), static_cast<std::size_t>(most));
  return out;
}

TEST(Reduce, KeepsBothTeethWhateverElseLiesOnAWall) {
  const std::set<std::uint32_t> chosen = features(disk_on_two_teeth(), 16);
  for (const std::uint32_t corner : {200u, 202u, 203u, 205u}) EXPECT_TRUE(chosen.count(corner)) << corner;
}

TEST(Reduce, KeepsTheCornersOfAFaceAndTheDeepest) {
  std::vector<Candidate> all;
  for (int i = 0; i < 11; ++i)
    for (int k = 0; k < 11; ++k)
      all.push_back(at({0.004f * i, 0.004f * k, 0}, Vec3f::UnitZ(), i == 4 && k == 7 ? -1e-5f : 0.0f, all.size()));
  const std::set<std::uint32_t> chosen = features(all, 16);
  for (const std::uint32_t i : {0u, 10u, 110u, 120u, 4u * 11u + 7u}) EXPECT_TRUE(chosen.count(i)) << i;
  EXPECT_EQ(chosen.size(), 8u);
}

TEST(Reduce, TakesWhatIsMetFirstWhenAPartTiltsNotWhatIsFarOut) {
  // A round edge of 50 mm radius that touches at its middle: 7 mm out it is half a millimetre up.
  std::vector<Candidate> all;
  for (int i = -70; i <= 70; ++i) {
    const float x = 1e-4f * static_cast<float>(i);
    all.push_back(at({x, 0, 0}, Vec3f::UnitZ(), x * x / (2 * 0.05f), all.size()));
  }
  const std::set<std::uint32_t> chosen = features(all, 16);
  const float met = tilt * 0.05f * std::sqrt(0.5f);  // directions lie across the corners: tilted by tilt / sqrt(2)
  for (const float x : {-met, met})
    EXPECT_TRUE(std::any_of(chosen.begin(), chosen.end(), [&](std::uint32_t i) {
      return std::abs(all[i].on_a.x() - x) < 2e-4f;
    })) << x;
}

TEST(Reduce, DoesNotDependOnTheOrderOfTheCandidates) {
  std::vector<Candidate> all = disk_on_two_teeth();
  const std::set<std::uint32_t> before = features(all, 16);
  std::reverse(all.begin(), all.end());
  EXPECT_EQ(features(all, 16), before);
}

TEST(Reduce, ManyNormalsDoNotExceedThePlaces) {
  std::vector<Candidate> all;
  for (int i = 0; i < 300; ++i) {  // all over a ball
    const float z = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / 300.0f, angle = 2.4f * static_cast<float>(i);
    const Vec3f out(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
    all.push_back(at(0.02f * out, out, 1e-4f * z * z, all.size()));
  }
  EXPECT_GE(features(all, 16).size(), 8u);
  EXPECT_GE(features(all, 8).size(), 6u);
  EXPECT_TRUE(features({}, 16).empty());
}

}  // namespace
}  // namespace bin_scenes::sphere
