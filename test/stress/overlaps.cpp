/// Starts that overlap, as an earlier scene or a careless user may ask for: parts must part without exploding.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

constexpr double edge = 0.05;
constexpr double burst = 2.0;  ///< m/s: what falls by one cube's edge gets 1 m/s; twice that has been shot out

Case two_cubes(double share) {
  Case c = on_floor("two cubes side by side");
  put(c, "cube", cube(edge), {{0, 0, 0.5 * edge}, {(1.0 - share) * edge, 0.003, 0.5 * edge}});
  c.expect.speed = burst;
  return c;
}

Case into_floor(double share) {
  Case c = a_case("a cube in the floor");
  put(c, "cube", cube(edge), {{0, 0, (0.5 - share) * edge}});
  c.expect.speed = burst;
  return c;
}

Case into_wall(double share) {
  Case c = a_case("a cube in a wall");
  const double x = 0.5 * c.request.bin.inner_size.x();
  put(c, "cube", cube(edge), {{x - (0.5 - share) * edge, 0, 0.5 * edge}});
  c.expect.speed = burst;
  return c;
}

Case heap(double share) {
  Case c = a_case("27 cubes in a lattice");
  c.request.bin.inner_size = Vec3(0.3, 0.3, 0.3);
  std::vector<Vec3> places;
  for (int i = 0; i < 27; ++i)
    places.push_back((1.0 - share) * edge * Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9) + Vec3(0, 0, 0.5 * edge));
  put(c, "cube", cube(edge), places);
  c.expect.speed = burst;
  return c;
}

Case linked_rings(double share) {
  Case c = on_floor("a ring through another's rim");
  PartLine& line =
      put(c, "ring", ring(0.018, 0.0275, 0.012), {{0, 0, 0.006}, {0.0455 * (1.0 - 0.5 * share), 0, 0.0275}});
  line.poses[1].orientation = Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitX()));
  c.expect.speed = burst;
  c.expect.penetration = 1.0;  // they may stay linked: what must not happen is a burst
  c.expect.rests = false;
  return c;
}

}  // namespace

std::vector<Row> overlaps(bool soak) {
  std::vector<Row> rows;
  for (const int percent : soak ? std::vector<int>{2, 10, 25, 50} : std::vector<int>{10, 50}) {
    const double share = 0.01 * percent;
    Row row{"overlap",
            "by " + std::to_string(percent) + " % of a part",
            soak && percent == 10 ? both_forms : both,
            {two_cubes(share)},
            {}};
    row.cases.push_back(into_floor(0.99 * share));  // at half a part the centre would start outside the bin
    row.cases.push_back(into_wall(0.99 * share));
    row.cases.push_back(heap(share));
    row.cases.push_back(linked_rings(share));
    // It is set apart for overlap and squeeze. Whether the rings come apart depends on the time step.
    if (percent == 50) row.known["sphere: a ring through another's rim"] = restarted;
    // Overlap stands for energy nobody accounts for: lifting a part out of the floor takes some. Speeds are judged.
    for (Case& c : row.cases) c.expect.energy = std::numeric_limits<double>::infinity();
    rows.push_back(row);
  }
  return rows;
}

}  // namespace bin_scenes::stress
