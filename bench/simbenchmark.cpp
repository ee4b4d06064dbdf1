/// SimBenchmark's cubes of spheres (Hwangbo, Kang; github.com/leggedrobotics/SimBenchmark) with the published rows of
/// other engines beside the solvers here, and Bullet as it comes run here too: balls are spheres, 10 iterations,
/// sleeping with Bullet's own thresholds. Scenes, metrics and durations are its own; its random numbers are not, so the
/// first decimals of a pile's figures mean nothing.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "peers/stock_bullet.hpp"
#include "runs.hpp"

#include "bin_scenes/core/random.hpp"
#include "solver/lab.hpp"

#include <cmath>
#include <ctime>

namespace bin_scenes::bench {
namespace {

using testing::Lab;
using testing::material;

constexpr double g = 9.81;

/// Advances step by step; `look` is called before each, and not timed. Returns seconds of CPU.
template <class Look>
double simulate(Lab& lab, double seconds, Look&& look) {
  double spent = 0.0;
  while (lab.time() < seconds - 0.5 * lab.solver().step_size()) {
    look();
    const std::clock_t start = std::clock();
    lab.simulate(lab.solver().step_size());
    spent += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }
  return spent;
}

struct Result {
  double error, cpu_s;
};

double energy(const Lab& lab, const std::vector<BodyState>& states) {
  double sum = 0.0;
  for (std::size_t b = 0; b < states.size(); ++b) {
    const double mass = lab.body(b).mass;
    sum += lab.kinetic_energy(b, states[b]) + mass * g * (states[b].pose * lab.part(b).mass().center).z();
  }
  return sum;
}

/// 6 x 6 x 6 balls of 10 kg and 0.1 m without friction, 0.21 m apart, shifted by up to a millimetre.
void place_cube(Lab& lab, double height, double restitution) {
  const PartModelPtr ball = testing::sphere(0.1);
  lab.def().bin.friction = 0.0;
  lab.def().bin.restitution = restitution;  // both: Bullet as it comes multiplies, solvers here take the larger
  Random random(42, 0, Stream::probe);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        lab.place(ball, Vec3(0.21 * i, 0.21 * j, 0.21 * k + height) + 0.001 * Vec3(x, y, z), Quat::Identity(),
                  material(0.0, restitution, 10.0));
      }
}

/// Mean over time of the sum of squared overlaps (m2), 10 s.
Result cube_of_balls(Lab lab, double seconds) {
  place_cube(lab, 0.101, 0.0);
  double sum = 0.0;
  std::size_t looks = 0;
  const double cpu = simulate(lab, seconds, [&] {
    std::vector<Vec3> centers;
    if (looks++ > 0)
      for (const BodyState& state : lab.states()) centers.push_back(state.pose.position);
    for (std::size_t i = 0; i < centers.size(); ++i) {
      const double floor = std::max(0.0, 0.1 - centers[i].z());
      sum += floor * floor;
      for (std::size_t j = i + 1; j < centers.size(); ++j) {
        const double square = (centers[i] - centers[j]).squaredNorm();
        if (square < 0.04) sum += (0.2 - std::sqrt(square)) * (0.2 - std::sqrt(square));
      }
    }
  });
  return {sum / static_cast<double>(looks), cpu};
}

/// Mean over time of the squared change of energy (J2).
Result energy_error(Lab& lab, double seconds) {
  double sum = 0.0, first = 0.0;
  std::size_t looks = 0;
  const double cpu = simulate(lab, seconds, [&] {
    if (looks > 0) {  // a world holds nothing before its first step
      const double now = energy(lab, lab.states());
      if (looks == 1) first = now;
      sum += (now - first) * (now - first);
    }
    ++looks;
  });
  return {sum / static_cast<double>(looks), cpu};
}

/// The same balls let go a metre higher, perfectly elastic.
Result elastic_cube(Lab lab, double seconds) {
  place_cube(lab, 1.101, 1.0);
  return energy_error(lab, seconds);
}

struct Scene {
  const char *name, *unit;
  Result (*run)(Lab lab, double seconds);
  std::vector<double> time_steps;
};
const Scene scenes[] = {{"666", "m2", cube_of_balls, {0.001, 0.004, 0.01}},
                        {"elastic_666", "J2", elastic_cube, {0.0005, 0.001, 0.004, 0.01}}};

/// Published rows (data/*/sample.csv): error reduction parameter off, one solver of each engine. CPU times are of the
/// authors' machine.
struct Published {
  const char *scene, *engine, *solver;
  struct {
    double time_step_s, error, cpu_s;
  } at[4];
};

// clang-format off
constexpr Published simbenchmark_rows[] = {
    {"666", "ODE", "quick",
     {{0.0004, 2.42059e-05, 35.0435}, {0.001, 0.000157122, 10.0378}, {0.004, 0.00208149, 2.52893}, {0.01, 0.0161901, 1.00332}}},
    {"666", "MuJoCo", "Newton",
     {{0.0004, 0.0391936, 88.4944}, {0.001, 0.0950124, 43.1372}, {0.004, 0.374245, 15.3103}, {0.01, 0.933766, 5.1182}}},
    {"666", "Bullet", "multibody",
     {{0.0004, 0.0629953, 27.8013}, {0.001, 0.38247, 11.9778}, {0.004, 5.78282, 4.14151}, {0.01, 37.4217, 2.01153}}},
    {"666", "RaiSim", "bisection",
     {{0.0004, 2.36103e-05, 3.38443}, {0.001, 0.00013534, 1.51045}, {0.004, 0.00211391, 0.38779}, {0.01, 0.0152745, 0.167983}}},
    {"666", "DART", "Dantzig",
     {{0.0004, 0.00717582, 37.6985}, {0.001, 0.000282356, 22.9162}, {0.004, 9292.72, 6.56869}, {0.01, 214.842, 3.06581}}},
    {"elastic_666", "Bullet", "multibody",
     {{0.0004, 3563.92, 5.93753}, {0.001, 41498.1, 2.31772}, {0.004, 840066, 0.65147}, {0.01, 9.86396e+06, 0.31976}}},
    {"elastic_666", "ODE", "quick",
     {{0.0004, 17.5054, 13.8713}, {0.001, 112.318, 5.64728}, {0.004, 1648.4, 1.43055}, {0.01, 8.55999e+06, 0.601697}}},
    {"elastic_666", "RaiSim", "bisection",
     {{0.0004, 0.248699, 1.64278}, {0.001, 8.36835, 0.655143}, {0.004, 264.072, 0.180666}, {0.01, 5.18417e+06, 0.0702891}}},
    {"elastic_666", "DART", "Dantzig",
     {{0.0004, 52414.7, 20.386}, {0.001, 346909, 8.05873}, {0.004, 6.62224e+06, 1.9544}, {0.01, 1.28706e+10, 0.842985}}},
};
// clang-format on

std::unique_ptr<Solver> solver_of(const std::string& name, double time_step) {
  if (name == "bullet_stock") {
    StockBullet stock;
    stock.time_step = time_step;
    stock.balls = {0.1};
    stock.pieces.resize(1);  // a ball has none
    return make_stock_bullet(stock);
  }
  Request request;
  choose_solver(request, name);
  request.solver.sphere.time_step = request.solver.bullet.time_step = time_step;
  request.solver.bullet.sleeping = false;
  std::string reason;
  return make_solver(request, {}, reason);
}

void run(Run& out) {
  // Ten seconds is what SimBenchmark simulates: a quick run's errors are means over less time.
  const double seconds = out.quick() ? 2.0 : 10.0;
  for (const Scene& scene : scenes) {
    const auto row = [&](const std::string& engine, const std::string& solver, double time_step) {
      return Row()
          .key("scene", scene.name)
          .key("engine", engine)
          .key("solver", solver)
          .key("time_step_s", time_step)
          .info("unit", scene.unit);
    };
    for (const Published& p : simbenchmark_rows)
      for (const auto& at : p.at)
        if (p.scene == std::string(scene.name) && out.wanted(row(p.engine, p.solver, at.time_step_s)))
          out.row(row(p.engine, p.solver, at.time_step_s)
                      .measure("error", at.error)
                      .measure("cpu_s", at.cpu_s)
                      .info("measured", "published"));
    for (const std::string solver : {"sphere", "bullet", "bullet_stock"})
      for (const double time_step : scene.time_steps) {
        const Row keys = row(solver == "bullet_stock" ? "Bullet" : "bin_scenes", solver, time_step);
        if (!out.wanted(keys)) continue;
        const Isolated one = isolated([&] {
          const Result result = scene.run(Lab(solver_of(solver, time_step)), seconds);
          return Row().measure("error", result.error).measure("cpu_s", result.cpu_s);
        });
        out.row(Row(keys).append(one.row).info("measured", "here"));
      }
  }
}

const Registration registration{"simbenchmark",
                                "SimBenchmark's scenes of spheres: error and CPU time beside the published rows",
                                {"scene", "engine", "solver", "time_step_s"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
