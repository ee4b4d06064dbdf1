/// High stacks: every contact carries what lies above it, and one that gives way brings all of it down.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

Case stack(const std::string& name, const std::string& model, const Mesh& mesh, double height, int count) {
  Case c = on_floor(name);
  std::vector<Vec3> places;
  for (int i = 0; i < count; ++i) places.emplace_back(0, 0, (i + 0.5) * height);
  put(c, model, mesh, places).density = 2700.0;
  c.expect.height = 0.995 * (count - 0.5) * height;
  return c;
}

Case cubes(int count) {
  return stack("cubes", "cube", cube(0.05), 0.05, count);
}
Case plates(int count) {
  return stack("plates", "plate", box(Vec3(0.06, 0.04, 0.006)), 0.006, count);
}
Case rings(int count) {
  return stack("rings", "ring", ring(0.018, 0.0275, 0.012), 0.012, count);
}

}  // namespace

std::vector<Row> stacks(bool soak) {
  std::vector<Row> rows;
  for (const int count : soak ? std::vector<int>{2, 10, 20, 50} : std::vector<int>{10}) {
    Row row{"stack", "of " + std::to_string(count), count == 2 ? both_forms : both, {}, {}};
    row.cases = {cubes(count), plates(count), rings(count)};
    rows.push_back(row);
  }
  for (Row& row : rows) {
    if (row.name == "of 2" || row.name == "of 10") continue;
    if (row.name != "of 50") continue;
    row.known["bullet: rings"] = trembles;
    row.known["sphere: cubes"] = "sways: pressed contacts buckle under 63 such cubes";
  }
  if (!soak) {
    rows.push_back({"stack", "of 20", {"sphere"}, {cubes(20), plates(20), rings(20)}, {}});
    // Rest takes long to say of so many: a quarter of a second must pass without a fall.
    rows.push_back({"stack", "of 50", both, {cubes(50)}, {}});
    rows.back().cases[0].request.seconds = 0.25;
    rows.back().cases[0].expect.rests = false;
  }
  // The thesis says of its own method that high stacks need more iterations.
  Row thesis{"stack", "of 10, 40 iterations", {"thesis"}, {cubes(10)}, {}};
  thesis.known["thesis: cubes"] = "the method presses the lowest of ten through each other";
  thesis.cases[0].request.solver.thesis.iterations = 40;
  thesis.cases[0].request.seconds = 0.5;
  thesis.cases[0].expect.rests = false;
  thesis.cases[0].expect.penetration = 0.1;  // its surface is as rough as its spheres, a tenth of a part wide
  rows.push_back(thesis);
  return rows;
}

}  // namespace bin_scenes::stress
