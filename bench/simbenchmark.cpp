/// SimBenchmark's cube of spheres "666" (Hwangbo, Kang; github.com/leggedrobotics/SimBenchmark), and Bullet as it comes
/// beside the solvers here: balls are spheres, 10 iterations, sleeping with Bullet's own thresholds. Scene, metric and
/// duration are its own; its random numbers are not, so the first decimals of a figure mean nothing. Published rows of
/// other engines: bench/results/simbenchmark_published.csv.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "peers/stock_bullet.hpp"
#include "runs.hpp"

#include "bin_scenes/core/random.hpp"
#include "solver/lab.hpp"

#include <cmath>

namespace bin_scenes::bench {
namespace {

using testing::Lab;
using testing::material;

/// 6 x 6 x 6 balls of 10 kg and 0.1 m without friction, 0.21 m apart, shifted by up to a millimetre.
void place_cube(Lab& lab) {
  const PartModelPtr ball = testing::sphere(0.1);
  lab.def().bin.friction = 0.0;
  Random random(42, 0, Stream::probe);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        lab.place(ball, Vec3(0.21 * i, 0.21 * j, 0.21 * k + 0.101) + 0.001 * Vec3(x, y, z), Quat::Identity(),
                  material(0.0, 0.0, 10.0));
      }
}

/// Sum of squared overlaps (m2).
double overlap(const std::vector<BodyState>& balls) {
  double sum = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3& center = balls[i].pose.position;
    const double floor = std::max(0.0, 0.1 - center.z());
    sum += floor * floor;
    for (std::size_t j = i + 1; j < balls.size(); ++j) {
      const double square = (center - balls[j].pose.position).squaredNorm();
      if (square < 0.04) sum += (0.2 - std::sqrt(square)) * (0.2 - std::sqrt(square));
    }
  }
  return sum;
}

/// Overlap as its mean over time, and CPU time of the steps alone.
Row cube_of_balls(Lab lab, double seconds) {
  place_cube(lab);
  double sum = 0.0, cpu_s = 0.0;
  int steps = 0;
  for (; lab.time() < seconds - 0.5 * lab.solver().step_size(); ++steps) {
    if (steps > 0) sum += overlap(lab.states());  // a world holds nothing before its first step
    const Clock clock;
    lab.simulate(lab.solver().step_size());
    cpu_s += clock.cpu_s();
  }
  return Row().measure("error", sum / steps).measure("cpu_s", cpu_s).info("unit", "m2");
}

std::unique_ptr<Solver> made(const std::string& name, double time_step) {
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
  return solver_of(request, {});
}

void run(Run& out) {
  // Ten seconds is what SimBenchmark simulates: a quick run's errors are means over less time.
  const double seconds = out.quick() ? 2.0 : 10.0;
  for (const std::string solver : {"sphere", "bullet", "bullet_stock"})
    for (const double time_step : {0.001, 0.004, 0.01}) {
      const Row key = Row::keys("scene", "666", "solver", solver, "time_step_s", time_step);
      if (!out.wanted(key)) continue;
      out.row(Row(key).append(isolated([&] { return cube_of_balls(Lab(made(solver, time_step)), seconds); }).row));
    }
}

const Registration registration{
    "simbenchmark", "SimBenchmark's cube of balls: overlap and CPU time", {"scene", "solver", "time_step_s"}, run};

}  // namespace
}  // namespace bin_scenes::bench
