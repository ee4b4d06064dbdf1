#include "without_skips.hpp"

#include "bin_scenes/core/random.hpp"
#include "pour/settling.hpp"
#include "runs.hpp"
#include "solver/sphere/make_world.hpp"

#include <tbb/task_arena.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace bin_scenes::bench {

namespace {

/// No ball of nodes is ever far enough away.
void never_cull(sphere::Samples& samples) {
  constexpr float everywhere = 1e3f;  // m
  for (sphere::Ball& ball : samples.groups) ball.radius = everywhere;
  for (sphere::Ball& ball : samples.clusters) ball.radius = everywhere;
}

/// Where `count` parts begin: in layers of a grid, each turned at random.
std::vector<BodyState> above(const Request& request, double diagonal, std::size_t count) {
  Random random(1, 0, Stream::probe);
  const Vec3& size = request.bin.inner_size;
  const auto columns = [&](double width) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(width / diagonal));
  };
  const std::size_t nx = columns(size.x()), ny = columns(size.y());
  std::vector<BodyState> states(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](std::size_t k, std::size_t n, double width) {
      return width * ((static_cast<double>(k) + 0.5) / static_cast<double>(n) - 0.5);
    };
    const std::size_t layer = i / (nx * ny);
    states[i].pose.position =
        Vec3(at(i % nx, nx, size.x()), at(i / nx % ny, ny, size.y()), (static_cast<double>(layer) + 1.0) * diagonal);
    states[i].pose.orientation =
        Quat(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5)
            .normalized();
  }
  return states;
}

struct Fall {
  double cpu_s = 0.0;
  sphere::Counters counters;
  std::vector<Vec3> positions;
};

/// Half of the time on coarse samples, then on exact ones, as a pour does it. On one thread: what
/// threads spend on waiting for each other is not work.
Fall fall(const std::string& part, std::size_t count, double seconds, const Skip* without) {
  const Request request = bin_of(part, count);
  const std::vector<PartModelPtr> parts = load_parts(request);
  const SphereSettings& settings = request.solver.sphere;
  sphere::Shape shape =
      sphere::make_shape(*parts.front(), settings.coarse_samples, settings.fine_samples, settings.field_cell);
  sphere::World world = sphere::make_world(world_of(request, parts), settings,
                                           [&](const PartModelPtr&) -> const sphere::Shape& { return shape; });
  world.settings.rest_window = std::numeric_limits<float>::infinity();  // nobody sleeps
  SkipTarget target{world, shape};
  if (without) without->take_away(target);
  const std::vector<BodyState> states = above(request, parts.front()->diagonal(), count);
  for (std::size_t b = 0; b < count; ++b) sphere::place(world, b, states[b]);
  Fall out;
  const double begin = cpu_seconds();
  const auto steps = static_cast<int>(std::lround(0.5 * seconds / world.settings.time_step));
  tbb::task_arena(1).execute([&] {
    for (int k = 0; k < 2 * steps; ++k) {
      if (k == steps) sphere::set_phase(world, phases::settle);
      sphere::step(world);
    }
  });
  out.cpu_s = cpu_seconds() - begin;
  out.counters = world.counters;
  for (std::size_t b = 0; b < count; ++b) out.positions.push_back(sphere::state_of(world, b).pose.position);
  return out;
}

bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0;
}

}  // namespace

const std::vector<Skip>& pass_skips() {
  static const std::vector<Skip> skips = {
      {"recycling", "contacts found anew in every step",
       [](SkipTarget& t) { t.world.settings.recycle = t.world.settings.coarse_recycle = 0.0f; }},
      {"culling", "every sample looked at",
       [](SkipTarget& t) {
         never_cull(t.shape.coarse);
         never_cull(t.shape.fine);
       }},
      {"coarse samples", "exact samples from the start", [](SkipTarget& t) { t.shape.coarse = t.shape.fine; }},
      {"far contacts", "every contact solved",
       [](SkipTarget& t) { t.world.settings.press_margin = std::numeric_limits<float>::infinity(); }},
  };
  return skips;
}

Row fall_row(const std::string& part, std::size_t count, double seconds, const Skip* without) {
  constexpr int repeats = 3;
  std::vector<double> cpu;
  Fall one;
  for (int k = 0; k < repeats; ++k) {
    one = fall(part, count, seconds, without);
    cpu.push_back(one.cpu_s);
  }
  const auto& c = one.counters;
  return Row()
      .measure("fall_cpu_s", cpu)
      .exact("pairs_tested", c.pairs - c.pairs_recycled)
      .exact("samples_tested", c.nodes_tested)
      .info("same_poses", without ? same_bits(one.positions, fall(part, count, seconds, nullptr).positions) : true);
}

}  // namespace bin_scenes::bench
