/// A scene that went wrong on the way is set apart, however it looks at the end.
#include "generator_fixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {
namespace {

/// What the trace of a run shows, against the floor and the energy of boxes that are known.
struct Seen {
  double deepest = 0.0;  ///< into the floor / diagonal
  double deepest_time = 0.0;
  double gain = 0.0;  ///< rise of the energy above the least before / sum of m g d
};

class WorstTest : public GeneratorTest {
 protected:
  /// A cube on the floor, and a block of the same size and `ratio` times its mass just above it, turned a little.
  Request pressed(double edge, double ratio, SolverType solver) {
    const std::string file = (dir / ("box_" + std::to_string(edge) + ".stl")).string();
    std::ofstream(file) << box_stl(edge);
    Request request;
    request.solver.type = solver;
    request.bin.kind = Bin::Kind::floor;
    request.pour.pattern = Pour::Pattern::given;
    request.seconds = 0.4;
    const double mass = 1000.0 * edge * edge * edge;
    for (int i = 0; i < 2; ++i) {
      PartLine line;
      line.model = line.path = file;
      line.unit = Unit::metre;
      line.mass = i == 0 ? mass : ratio * mass;
      line.restitution = 0.0;
      line.poses = {{Vec3(0.1 * edge * i, 0, (0.5 + 1.02 * i) * edge), Quat::Identity()}};
      request.parts.push_back(line);
    }
    return request;
  }

  static double lowest(const Pose& pose, double edge) {
    double z = 1e9;
    for (int i = 0; i < 8; ++i)
      z = std::min(z, (pose * Vec3(edge * Vec3((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, ((i >> 2) & 1) - 0.5))).z());
    return z;
  }

  /// Generates the scene and watches each of its steps.
  Scene watched(const Request& request, double edge, Seen& seen) {
    const double d = edge * std::sqrt(3.0);
    std::array<double, 2> least{};
    bool begun = false;
    Generator::Options options;
    options.hooks.trace_rate = 1000.0;
    options.hooks.trace = [&](std::size_t, double time, const std::vector<BodyState>& states) {
      std::array<double, 2> now{};
      double unit = 0.0;
      for (std::size_t b = 0; b < 2; ++b) {
        const double mass = *request.parts[b].mass;
        const Twist& v = states[b].velocity;
        now[b] = 0.5 * mass * (v.linear.squaredNorm() + edge * edge / 6.0 * v.angular.squaredNorm()) +
                 mass * 9.81 * states[b].pose.position.z();
        unit += mass * 9.81 * d;
        const double depth = -lowest(states[b].pose, edge) / d;
        if (depth > seen.deepest) seen.deepest = depth, seen.deepest_time = time;
      }
      if (!begun || now[0] + now[1] <= least[0] + least[1]) least = now;
      begun = true;
      seen.gain = std::max(seen.gain, (now[0] + now[1] - least[0] - least[1]) / unit);
    };
    return std::move(run(request, options).at(0).scene);
  }

  static bool has_reason(const Report& report, const std::string& key) {
    return std::any_of(report.reasons.begin(), report.reasons.end(),
                       [&](const std::string& reason) { return reason.find("accept." + key) != std::string::npos; });
  }
};

// A block of a thousand times its mass pressed a cube a quarter of its edge into the floor; the cube came back, energy
// rose, and the scene was accepted.
TEST_F(WorstTest, WhatTheTraceShowsIsInTheReportAndDecides) {
  for (const SolverType solver : {SolverType::sphere, SolverType::bullet})
    for (const double edge : {0.005, 0.05, 0.3})
      for (const double ratio : {1.0, 1000.0}) {
        SCOPED_TRACE(std::string(name_of(solver)) + " " + std::to_string(edge) + " " + std::to_string(ratio));
        Seen seen;
        const Request request = pressed(edge, ratio, solver);
        const Report report = watched(request, edge, seen).report;
        const auto& worst = report.worst;
        ASSERT_TRUE(worst.penetration.known);
        EXPECT_GE(worst.penetration.relative, 0.9 * seen.deepest - 1e-3);
        EXPECT_NEAR(worst.energy_gain.relative, seen.gain, 0.1 * seen.gain + 2e-3);
        EXPECT_EQ(has_reason(report, "worst_penetration"), worst.penetration.relative > 0.05);
        EXPECT_EQ(has_reason(report, "worst_energy_gain"), worst.energy_gain.relative > 0.01);
        if (ratio == 1.0) {
          EXPECT_TRUE(report.reasons.empty()) << report.reasons[0];
        }
      }
}

TEST_F(WorstTest, AnOverlapThatIsGoneAtTheEndSetsTheSceneApart) {
  for (const SolverType solver : {SolverType::sphere, SolverType::bullet})
    for (const double edge : {0.005, 0.05, 0.3}) {
      SCOPED_TRACE(std::string(name_of(solver)) + " " + std::to_string(edge));
      Request request = pressed(edge, 1.0, solver);
      request.parts[0].poses[0].position.z() = 0.3 * edge;  // a fifth of the edge in the floor
      request.parts.pop_back();
      request.seconds = 1.0;
      const Report report = run(request).at(0).scene.report;
      EXPECT_LT(report.penetration.bin_max, 0.01 * edge);
      EXPECT_GT(report.worst.penetration.value, 0.199 * edge);
      if (solver == SolverType::sphere) {  // under bullet the cube tilts as it comes out, and a corner goes deeper
        EXPECT_NEAR(report.worst.penetration.value, 0.2 * edge, 2e-3 * edge);
        EXPECT_LT(report.worst.penetration.time, 0.005);
      }
      EXPECT_EQ(report.worst.penetration.pair, (std::array<int, 2>{0, -1}));
      EXPECT_FALSE(report.accepted);
      EXPECT_TRUE(has_reason(report, "worst_penetration"));
      request.accept.worst_penetration = 0.2;
      EXPECT_FALSE(has_reason(run(request).at(0).scene.report, "worst_penetration"));
    }
}

}  // namespace
}  // namespace bin_scenes
