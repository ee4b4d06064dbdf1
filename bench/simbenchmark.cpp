/// SimBenchmark's scenes of spheres (Hwangbo, Kang; github.com/leggedrobotics/SimBenchmark) with the published rows of
/// other engines beside the solvers here, and Bullet as it comes run here too: balls are spheres, the box is a hull
/// without a margin, 10 iterations, sleeping with Bullet's own thresholds. Scenes, metrics and durations are its own;
/// its random numbers are not, so the first decimals of a pile's figures mean nothing.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "peers/peer.hpp"
#include "requests.hpp"
#include "simbenchmark_published.hpp"

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

/// 7 x 7 balls of 10 kg and 0.1 m from 5 m, perfectly elastic, 20 s.
Result bouncing(Lab lab, double seconds) {
  const PartModelPtr ball = testing::sphere(0.1);
  lab.def().bin.friction = 0.0;
  lab.def().bin.restitution = 1.0;
  for (int i = 0; i < 49; ++i)
    lab.place(ball, Vec3(i % 7 * 2.0 - 10.0, i / 7 * 2.0 - 10.0, 5.0), Quat::Identity(), material(0.0, 1.0, 10.0));
  return energy_error(lab, 2.0 * seconds);
}

/// 25 balls of 1 kg and 0.5 m on a box of 10 kg that 150 N push along the floor at 60 degrees to its side, 4 s; mean
/// over time of the squared errors of the velocities of box and first ball (m2/s2). mu 0.8 ball-box, 0.4 box-floor. The
/// interface has no forces: the box gets the force's velocity before each step.
Result rolling(Lab lab, double seconds) {
  const double force = 150.0, box_mass = 10.0, mass = 1.0, n = 25.0;
  lab.def().bin.friction = 0.2;
  lab.def().bin.restitution = 0.0;
  const auto box =
      lab.place(testing::box({20, 20, 1}), Vec3(0, 0, 0.5), Quat::Identity(), material(0.8, 0.0, box_mass));
  const PartModelPtr ball = testing::sphere(0.5);
  for (int i = 0; i < 25; ++i)
    lab.place(ball, Vec3(i / 5 * 2.0 - 4.0, i % 5 * 2.0 - 4.0, 1.5), Quat::Identity(), material(0.8, 0.0, mass));

  // Newton for box and balls, no slip where they touch, slip on the floor.
  const double floor_friction = 0.4 * (box_mass + n * mass) * g;
  const double ball_friction = (force - floor_friction) / box_mass / (3.5 / mass + n / box_mass);
  const double box_acceleration = (force - floor_friction - n * ball_friction) / box_mass;
  const Vec3 along(0.5, std::sqrt(0.75), 0.0);
  double sum = 0.0;
  std::size_t looks = 0;
  const Vec3 kick = force / box_mass * lab.solver().step_size() * along;
  lab.start(box).velocity.linear = kick;
  const double cpu = simulate(lab, 0.4 * seconds, [&] {
    if (looks++ == 0) return;
    const double t = lab.time();
    BodyState state = lab.state(box);
    sum += (state.velocity.linear - box_acceleration * t * along).squaredNorm() +
           (lab.state(1).velocity.linear - ball_friction / mass * t * along).squaredNorm();
    state.velocity.linear += kick;
    lab.solver().insert(lab.world(), box, state);
  });
  return {sum / static_cast<double>(looks), cpu};
}

struct Scene {
  const char *name, *unit;
  Result (*run)(Lab lab, double seconds);
  std::vector<double> time_steps;
  /// For Bullet as it comes: parts in the order in which they are placed.
  std::vector<double> balls;
  std::vector<Pieces> pieces;
};
const Scene scenes[] = {
    {"666", "m2", cube_of_balls, {0.001, 0.004, 0.01}, {0.1}, {{}}},
    {"elastic_666", "J2", elastic_cube, {0.0005, 0.001, 0.004, 0.01}, {0.1}, {{}}},
    {"rolling", "m2/s2", rolling, {0.001}, {0.0, 0.5}, {{testing::box_mesh({20, 20, 1}).vertices}, {}}},
    {"bouncing", "J2", bouncing, {0.001, 0.004, 0.01}, {0.1}, {{}}}};

std::unique_ptr<Solver> solver_of(const std::string& name, const Scene& scene, double time_step) {
  if (name == "bullet_stock") {
    PeerSettings stock;
    stock.engine = name;
    stock.time_step = time_step;
    stock.iterations = 10;
    stock.balls = scene.balls;
    stock.pieces = scene.pieces;
    stock.margin = 0.0;
    return make_peer(stock);
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
      if (p.scene == std::string(scene.name) && out.wanted(row(p.engine, p.solver, p.time_step_s)))
        out.row(row(p.engine, p.solver, p.time_step_s)
                    .measure("error", p.error)
                    .measure("cpu_s", p.cpu_s)
                    .info("measured", "published"));
    for (const std::string solver : {"sphere", "bullet", "bullet_stock"})
      for (const double time_step : scene.time_steps) {
        const Row keys = row(solver == "bullet_stock" ? "Bullet" : "bin_scenes", solver, time_step);
        if (!out.wanted(keys)) continue;
        const Isolated one = isolated([&] {
          const Result result = scene.run(Lab(solver_of(solver, scene, time_step)), seconds);
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
