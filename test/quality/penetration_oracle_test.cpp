/// Depths of unions of convex pieces against Bullet's GJK and EPA, as the largest over pairs of pieces.
#include "bin_scenes/quality/quality.hpp"

#include "quality/bullet_oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace bin_scenes {
namespace {

using namespace test;

double width(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Vec3& n) {
  double high = -1e9, low = 1e9;
  for (const Vec3& x : a) high = std::max(high, n.dot(x));
  for (const Vec3& x : b) low = std::min(low, n.dot(x));
  return high - low;
}

/// The same by descent over directions from many starts: slow, obvious, and never below the truth. Settles who is
/// right where Bullet disagrees, since its EPA stops early on some flat contacts.
double descended_depth(const Body& body_a, const Pose& pose_a, const Body& body_b, const Pose& pose_b) {
  Random random(1, 0, Stream::probe);
  double worst = 0.0;
  for (std::vector<Vec3> a : body_a.pieces) {
    for (Vec3& x : a) x = pose_a * x;
    for (std::vector<Vec3> b : body_b.pieces) {
      for (Vec3& x : b) x = pose_b * x;
      double best = 1e9;
      for (int start = 0; start < 300; ++start) {
        Vec3 n = random.orientation() * Vec3::UnitX();
        double depth = width(a, b, n);
        if (start > 20 && depth > 3.0 * best) continue;
        for (double step = 0.5; step > 1e-7;) {
          bool better = false;
          for (int k = 0; k < 12; ++k) {
            const Vec3 m = (n + step * (random.orientation() * Vec3::UnitX())).normalized();
            const double w = width(a, b, m);
            if (w >= depth) continue;
            depth = w;
            n = m;
            better = true;
          }
          if (!better) step *= 0.5;
        }
        best = std::min(best, depth);
      }
      worst = std::max(worst, best);
    }
  }
  return worst;
}

struct Case {
  Body body;
  MeshQuery query;
  BulletPieces bullet;
  explicit Case(Body b) : body(std::move(b)), query(body.mesh), bullet(body) {}
  double diagonal() const { return body.mesh.bounds().diagonal(); }
};

/// Calls judge(case a, pose a, case b, pose b, Bullet's depth) for random poses that overlap by up to 2 % of the
/// smaller diagonal; every fourth pair nearly flat on each other.
template <class Judge>
int for_random_overlaps(const std::vector<Case>& cases, int poses, Judge&& judge) {
  Random random(1, 0, Stream::probe);
  int count = 0;
  for (const Case& a : cases) {
    for (const Case& b : cases) {
      const double unit = std::min(a.diagonal(), b.diagonal());
      for (int k = 0; k < poses; ++k) {
        const Pose pa{Vec3(random.uniform(), 0, 0), random.orientation()};
        const Quat tilt(Eigen::AngleAxisd(1e-2 * random.uniform(), random.orientation() * Vec3::UnitX()));
        Pose pb{Vec3::Zero(), k % 4 == 3 ? pa.orientation * tilt : random.orientation()};
        const Vec3 direction = random.orientation() * Vec3::UnitX();
        const Vec3 aside = random.orientation() * Vec3(0.5 * random.uniform(), 0, 0);
        const double goal = 0.02 * unit * random.uniform();
        double expected = 0.0;
        for (double s = 2.0; s > 0.0 && expected <= goal; s -= 0.004) {
          pb.position = pa.position + aside + s * direction;
          expected = bullet_depth(a.bullet, pa, b.bullet, pb);
        }
        if (expected <= goal || expected > 0.02 * unit) continue;
        judge(a, pa, b, pb, expected);
        ++count;
      }
    }
  }
  return count;
}

TEST(PenetrationOracle, UnionsOfConvexPiecesWithin5e4OfTheDiagonal) {
  std::vector<Case> cases;
  cases.emplace_back(bar({1, 0.1, 0.1}));
  cases.emplace_back(bar({1, 0.8, 0.02}));
  cases.emplace_back(bar({0.5, 0.5, 0.5}));
  cases.emplace_back(angle(0.15, 0.2));
  cases.emplace_back(angle(0.02, 0.3));
  cases.emplace_back(channel(0.15, 0.15));
  const int count =
      for_random_overlaps(cases, 16, [](const Case& a, const Pose& pa, const Case& b, const Pose& pb, double bullet) {
        const double found = penetration(a.query, pa, b.query, pb).depth;
        const double tolerance = 5e-4 * std::min(a.diagonal(), b.diagonal());
        if (std::abs(found - bullet) <= tolerance) return;
        EXPECT_NEAR(found, descended_depth(a.body, pa, b.body, pb), tolerance) << "Bullet: " << bullet;
      });
  EXPECT_GT(count, 300);
}

TEST(PenetrationOracle, RingsAreNeverShallowerThanTheirPieces) {
  // The wedges of a ring end at seams that are not there: a piece may leave through a seam, the ring may not. So the
  // ring is at least as deep as its pieces, and nearly always as deep.
  std::vector<Case> cases;
  cases.emplace_back(ring(0.5, 0.35, 0.2, 24));
  cases.emplace_back(ring(0.5, 0.45, 0.05, 24));
  cases.emplace_back(bar({1, 0.1, 0.1}));
  int deeper = 0;
  const int count =
      for_random_overlaps(cases, 16, [&](const Case& a, const Pose& pa, const Case& b, const Pose& pb, double bullet) {
        const double found = penetration(a.query, pa, b.query, pb).depth;
        const double unit = std::min(a.diagonal(), b.diagonal());
        EXPECT_GE(found, bullet - 1e-4 * unit);
        deeper += found > bullet + 5e-4 * unit;
      });
  EXPECT_GT(count, 80);
  EXPECT_LE(deeper, count / 10);
}

}  // namespace
}  // namespace bin_scenes
