/// Parts from half a millimetre to five metres, and far from the origin, where single precision runs out of digits.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

Case heap(double size) {
  Case c = a_case("8 angles in a bin of their scale");
  c.request.bin.inner_size = size * Vec3(3, 2.5, 2.5);
  c.request.bin.wall_thickness = 0.1 * size;
  c.request.pour.drop_height = 0.4 * size;
  pour_in(c, with("angle_", size), angle(size, 0.2 * size, 0.6 * size), 8).density = 2700.0;
  c.request.pour.limit = 6.0 * std::sqrt(std::max(size, 0.05) / 0.05);  // a fall takes as the root of its height
  return c;
}

Case tower(double size, const Vec3& place) {
  Case c = on_floor("a tower of 3");
  std::vector<Vec3> places;
  for (int i = 0; i < 3; ++i) places.push_back(place + Vec3(0, 0, (i + 0.52) * size));
  put(c, with("cube_", size), cube(size), places).density = 2700.0;
  c.expect.height = 2.45 * size;
  c.request.pour.limit = 6.0 * std::sqrt(std::max(size, 0.05) / 0.05);
  return c;
}

Case mixed() {
  Case c = a_case("5 mm and 0.5 m in one bin");
  c.request.bin.inner_size = Vec3(0.8, 0.8, 0.6);
  put(c, "cube_0.5", cube(0.5), {{0, 0, 0.26}}).density = 100.0;
  std::vector<Vec3> places;
  for (int i = 0; i < 8; ++i) places.emplace_back(-0.03 + 0.01 * i, 0.02 * (i % 3), 0.52);
  put(c, "cube_0.005", cube(0.005), places).density = 100.0;
  return c;
}

Case tilted_flight(const Vec3& place, double size) {
  Case c = in_free_flight("two meet in free flight");
  PartLine& a = put(c, with("cube_", size), cube(size), {place + size * Vec3(-1.5, 0.1, 0.05)});
  throw_with(a, Vec3(10 * size, 0, 0), Vec3(3, 2, 1));
  put(c, with("cube_", size), cube(size), {place});
  c.request.seconds = 0.3;
  c.expect.rests = false;
  c.expect.energy = 2e-3;
  return c;
}

}  // namespace

std::vector<Row> sizes(bool soak) {
  std::vector<Row> rows;
  for (const double size : soak ? std::vector<double>{5e-4, 5e-3, 0.05, 0.5, 5} : std::vector<double>{5e-4, 5}) {
    Row row{"size", with("", 1e3 * size) + " mm", both, {heap(size)}, {}};
    row.cases.push_back(tower(size, Vec3::Zero()));
    rows.push_back(row);
  }
  rows.push_back({"size", "1 : 100 together", both, {mixed()}, {}});
  for (const double size : soak ? std::vector<double>{5e-4, 5e-3, 0.05, 0.5, 5} : std::vector<double>{5e-3, 0.05}) {
    Row row{"size",
            with("", 1e3 * size) + " mm, 100 m away",
            size == 0.05 ? both_forms : both,
            {tower(size, Vec3(100, -100, 0))},
            {}};
    row.cases.push_back(tilted_flight(Vec3(-60, 60, 60), size));
    if (size < 0.01) row.known["bullet: a tower of 3"] = "the endless floor ends 10,000 part sizes from the origin";
    rows.push_back(row);
  }
  return rows;
}

}  // namespace bin_scenes::stress
