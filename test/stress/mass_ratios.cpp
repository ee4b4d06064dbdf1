/// Heavy against light: the ratio of two masses in contact is what an iterative solver suffers from most.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

constexpr double edge = 0.05;

Case heavy_on_light(double ratio) {
  Case c = on_floor("heavy cube on a light one");
  put(c, "cube", cube(edge), {{0, 0, 0.5 * edge}}).mass = 0.1;
  put(c, "cube", cube(edge), {{0, 0, 1.5 * edge + 1e-4}}).mass = 0.1 * ratio;
  c.expect.height = 1.4 * edge;
  return c;
}

Case light_on_heavy(double ratio) {
  Case c = on_floor("light cube on a heavy one");
  put(c, "cube", cube(edge), {{0, 0, 0.5 * edge}}).mass = 0.1 * ratio;
  put(c, "cube", cube(edge), {{0, 0, 1.5 * edge + 1e-4}}).mass = 0.1;
  c.expect.height = 1.4 * edge;
  return c;
}

Case heavy_into_heap(double ratio) {
  Case c = a_case("heavy cube dropped on light angles");
  c.request.bin.inner_size = Vec3(0.16, 0.16, 0.2);
  std::vector<Vec3> places;
  for (int i = 0; i < 8; ++i) places.emplace_back(i & 1 ? 0.02 : -0.05, i & 2 ? 0.04 : -0.04, i & 4 ? 0.09 : 0.03);
  put(c, "angle", angle(0.04, 0.01, 0.04), places).mass = 0.01;
  put(c, "cube", cube(edge), {{0.01, 0.0, 0.25}}).mass = 0.01 * ratio;
  return c;
}

Case flight(double ratio) {
  Case c = in_free_flight("they meet in free flight");
  PartLine& light = put(c, "cube", cube(edge), {{-0.1, 0.01, 0.005}});
  light.mass = 0.1;
  throw_with(light, Vec3(1.0, 0, 0), Vec3(3, 2, 1));
  PartLine& heavy = put(c, "cube", cube(edge), {{0.1, 0, 0}});
  heavy.mass = 0.1 * ratio;
  throw_with(heavy, Vec3(-0.2, 0, 0), Vec3(0, 1, 2));
  c.request.seconds = 0.5;
  c.expect.rests = false;
  c.expect.momentum = 1e-3;
  c.expect.energy = 1e-3;
  return c;
}

/// Why cases of a ratio fail today.
Known known_at(double ratio) {
  const char* sweeps = "a step's sub-steps and sweeps carry no such ratio: the light part is pressed through";
  Known known;
  if (ratio >= 1000) known["bullet: heavy cube dropped on light angles"] = sweeps;
  if (ratio >= 1000)
    known["sphere: heavy cube dropped on light angles"] =
        "light parts pinched at the wall tremble; at 1:1000 13 of 16 places of the cube come to rest";
  if (ratio >= 10000) known["bullet: heavy cube on a light one"] = sweeps;
  if (ratio >= 10000)
    known["sphere: heavy cube on a light one"] =
        "sinks into the floor by a seventh of its edge, and throws the upper one off";
  return known;
}

}  // namespace

std::vector<Row> mass_ratios(bool soak) {
  std::vector<Row> rows;
  for (const double ratio : soak ? std::vector<double>{10, 100, 1000, 10000} : std::vector<double>{100, 10000}) {
    Row row{"mass", with("1:", ratio), both, {heavy_on_light(ratio), light_on_heavy(ratio)}, known_at(ratio)};
    row.cases.push_back(heavy_into_heap(ratio));
    row.cases.push_back(flight(ratio));
    rows.push_back(row);
    Row thesis{"mass", with("1:", ratio) + ", thesis", {"thesis"}, {light_on_heavy(ratio), flight(ratio)}, {}};
    for (Case& c : thesis.cases) {
      c.request.solver.thesis.sub_steps = 4;
      c.request.pour.limit = 1.5;
      c.expect.penetration = 0.1;  // its surface is as rough as its spheres, a tenth of a part wide
    }
    rows.push_back(thesis);
  }
  return rows;
}

}  // namespace bin_scenes::stress
