/// Requests nobody thought of: drawn from a seed, each key over its whole sensible range, held to what must hold of
/// any scene. The name of a case is its seed.
#include "stress/stress.hpp"

#include "bin_scenes/core/random.hpp"

#include <algorithm>

namespace bin_scenes::stress {

namespace {

double log_uniform(Random& random, double lower, double upper) {
  return lower * std::pow(upper / lower, random.uniform());
}

Mesh shape(Random& random, double size) {
  switch (random.below(5)) {
    case 0:
      return cube(size / std::sqrt(3.0));
    case 1:
      return box(size * Vec3(0.9, random.uniform(0.2, 0.9), random.uniform(0.06, 0.4)));
    case 2:
      return angle(0.7 * size, random.uniform(0.08, 0.2) * size, random.uniform(0.2, 0.6) * size);
    case 3:
      return ring(random.uniform(0.15, 0.4) * size, 0.5 * size, random.uniform(0.1, 0.4) * size, 12);
    default:
      return ball(0.45 * size, 1);
  }
}

/// A bin full of something, under some gravity, with some step.
Case heap(std::uint64_t seed) {
  Random random(seed, 0, Stream::probe);
  Case c = a_case("heap " + std::to_string(seed));
  Request& r = c.request;
  r.seed = seed;
  const double size = log_uniform(random, 0.005, 0.5);
  r.bin.inner_size = size * Vec3(random.uniform(1.8, 5.0), random.uniform(1.8, 5.0), random.uniform(2.5, 5.0));
  r.bin.wall_thickness = 0.1 * size;
  r.bin.friction = random.below(4) == 0 ? 0.0 : random.uniform(0.0, 2.0);
  r.bin.restitution = random.below(4) == 0 ? random.uniform() : 0.0;
  if (random.below(3) == 0) r.bin.kind = Bin::Kind::floor;
  const double tilt = random.below(3) == 0 ? random.uniform(0.0, 0.5) : 0.0, heading = random.uniform(0.0, 2.0 * M_PI);
  r.gravity = log_uniform(random, 1.0, 30.0) *
              Vec3(std::sin(tilt) * std::cos(heading), std::sin(tilt) * std::sin(heading), -std::cos(tilt));
  const std::size_t lines = 1 + random.below(3);
  for (std::size_t i = 0; i < lines; ++i) {
    PartLine& line = pour_in(c, "random_" + std::to_string(seed) + "_" + std::to_string(i),
                             shape(random, size * random.uniform(0.5, 1.0)), 1 + random.below(5));
    line.density = log_uniform(random, 100.0, 10000.0);
    line.friction = random.uniform(0.0, 1.5);
    line.restitution = random.below(3) == 0 ? random.uniform() : 0.1;
  }
  r.pour.pattern = random.below(3) == 0 ? Pour::Pattern::grid : Pour::Pattern::rain;
  r.pour.drop_height = size * random.uniform(0.05, 1.0);
  r.pour.limit = 3.0 * std::max(1.0, std::sqrt(size / 0.05 * 9.81 / r.gravity.norm()));
  r.solver.sphere.time_step = log_uniform(random, 1.0 / 1600.0, 1.0 / 200.0);
  r.solver.bullet.time_step = log_uniform(random, 1.0 / 480.0, 1.0 / 120.0);
  c.expect.rests = false;   // a ball on a tilted, slippery, endless floor never rests: then it must be said
  c.expect.all_in = false;  // a small bin may be full
  c.expect.penetration = 0.03;
  return c;
}

/// A handful of bodies that meet in free flight: momentum and energy have nowhere to go.
Case flight(std::uint64_t seed) {
  Random random(seed, 1, Stream::probe);
  Case c = in_free_flight("flight " + std::to_string(seed));
  const double size = log_uniform(random, 0.005, 0.5), restitution = random.uniform();
  for (int i = 0; i < 4; ++i) {
    const Vec3 place = 1.6 * size * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, random.uniform(-0.3, 0.3));
    PartLine& line = put(c, "flying_" + std::to_string(seed) + "_" + std::to_string(i), shape(random, size), {place});
    line.poses[0].orientation = random.orientation();
    line.density = log_uniform(random, 300.0, 10000.0);
    line.friction = random.uniform(0.0, 1.5);
    line.restitution = restitution;
    Vec3 aside(random.normal(), random.normal(), random.normal()),
        spin(random.normal(), random.normal(), random.normal());
    throw_with(line, -5.0 * place + size * aside, 5.0 * spin);
  }
  c.request.seconds = 1.0;
  c.request.solver.sphere.time_step = log_uniform(random, 1.0 / 1600.0, 1.0 / 400.0);
  c.expect.rests = false;
  c.expect.energy = 5e-3;
  c.expect.momentum = 2e-3;
  return c;
}

}  // namespace

std::vector<Row> random_requests(bool soak) {
  Row heaps{"random", "heaps", both, {}, {}}, flights{"random", "free flights", both, {}, {}};
  for (std::uint64_t seed = 0; seed < (soak ? 60 : 8); ++seed) heaps.cases.push_back(heap(seed));
  for (std::uint64_t seed = 0; seed < (soak ? 60 : 6); ++seed) flights.cases.push_back(flight(seed));
  for (const char* solver : {"sphere", "bullet"})
    heaps.known[std::string(solver) + ": heap 58"] =
        "a grid is poured under gravity tilted by 25 degrees: two parts leave over the rim";
  return {heaps, flights};
}

}  // namespace bin_scenes::stress
