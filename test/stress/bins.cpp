/// Bins too small, V-shaped, with holes, or hardly wider than a part.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

Case too_small() {
  Case c = a_case("a part larger than the bin is refused");
  c.request.bin.inner_size = Vec3(0.02, 0.02, 0.02);
  pour_in(c, "angle", angle(0.05, 0.01, 0.03), 1);
  c.expect.refused = true;
  return c;
}

/// Shorter than the diagonal, so it is let through; as wide as the part is long, it never fits lying down.
Case narrow() {
  Case c = a_case("a shaft narrower than the part is long");
  c.request.bin.inner_size = Vec3(0.045, 0.045, 0.2);
  pour_in(c, "angle", angle(0.05, 0.01, 0.03), 3);
  c.expect.all_in = false;  // who finds no room must be said not to
  return c;
}

Case snug() {
  Case c = a_case("a cube in a shaft 0.4 mm wider");
  c.request.bin.inner_size = Vec3(0.0504, 0.0504, 0.2);
  put(c, "cube", cube(0.05), {{0, 0, 0.1}});
  return c;
}

Case overfull() {
  Case c = a_case("five times as many as fit");
  c.request.bin.inner_size = Vec3(0.1, 0.1, 0.06);
  pour_in(c, "angle", angle(0.05, 0.01, 0.03), 40);
  c.expect.all_in = false;
  c.expect.spills = true;
  c.request.accept.escaped = true;
  return c;
}

Case given_outside() {
  Case c = a_case("a part given beside the bin has escaped");
  put(c, "cube", cube(0.05), {{0, 0, 0.05}, {0.5, 0, 0.05}});
  c.expect.escapes = 1;
  return c;
}

Case in_mesh(const std::string& name, const std::string& model, const Mesh& bin, std::size_t count) {
  Case c = a_case(name);
  c.request.bin.kind = Bin::Kind::mesh;
  c.request.bin.mesh = model;
  c.request.bin.unit = Unit::metre;
  c.models[model] = bin;
  pour_in(c, "angle", angle(0.05, 0.01, 0.03), count).density = 2700.0;
  return c;
}

Case through_the_holes() {
  Case c = in_mesh("a small ball falls through, a large one does not", "slotted_40",
                   slotted_bin(Vec3(0.3, 0.25, 0.1), 0.04, 0.01, 0.006), 1);
  c.request.parts.clear();
  c.models.erase("angle");
  // Holes lie between the bars that slotted_bin puts at -x + hole + bar / 2, and so on.
  const double x = -0.15 + 0.02, y = -0.125 + 0.02;
  put(c, "ball_15", ball(0.015), {{x, y, 0.03}});
  put(c, "ball_30", ball(0.03), {{x + 0.1, y + 0.1, 0.06}});
  c.expect.escapes = 1;
  return c;
}

}  // namespace

std::vector<Row> bins(bool soak) {
  const std::size_t count = soak ? 30 : 8;
  std::vector<Row> rows;
  rows.push_back(
      {"bin", "too small, too full", both, {too_small(), narrow(), snug(), overfull(), given_outside()}, {}});
  if (!soak)
    rows.back().known["sphere: five times as many as fit"] =
        "one part called resting goes on by 2.5 % of its size; not with the long form's number of parts";
  Row v{"bin", "V-shaped", both, {}, {}};
  v.cases.push_back(in_mesh("90 degrees", "v_90", v_bin(0.25, 0.24, 0.12, 0.01), count));
  v.cases.push_back(in_mesh("40 degrees", "v_40", v_bin(0.25, 0.14, 0.19, 0.01), count));
  if (soak) v.known["bullet: 90 degrees"] = restarted;
  if (soak) v.known["sphere: 40 degrees"] = "does not rest within 6 s; of 24 seeds 21 do, before 18";
  rows.push_back(v);
  Row holes{"bin", "mesh with holes", both, {}, {}};
  holes.cases.push_back(in_mesh("holes smaller than the parts", "slotted_20",
                                slotted_bin(Vec3(0.3, 0.25, 0.1), 0.02, 0.01, 0.006), count));
  holes.cases.push_back(through_the_holes());
  rows.push_back(holes);
  return rows;
}

}  // namespace bin_scenes::stress
