/// Time steps far above and far below the default: coarse ones may cost accuracy, never parts.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

Case poured(const std::string& name, const std::string& model, const Mesh& mesh, std::size_t count, double step) {
  Case c = a_case(name);
  c.request.bin.inner_size = Vec3(0.16, 0.12, 0.12);
  pour_in(c, model, mesh, count).density = 2700.0;
  c.request.solver.sphere.time_step = c.request.solver.bullet.time_step = c.request.solver.thesis.time_step = step;
  // Above 1/60 s the request asks for coarse: parts may overlap more, and may be said to move.
  if (step > 1.0 / 70.0) {
    c.expect.rests = false;
    c.expect.penetration = 0.1;
  }
  return c;
}

/// The same with no step cut: what is asked for is what is made.
Case uncut(Case c) {
  c.request.solver.sphere.cut_steps = c.request.solver.bullet.cut_steps = false;
  return c;
}

}  // namespace

std::vector<Row> time_steps(bool soak) {
  const char* sinks = "in one step of this length a part falls deeper into another than it is pushed out again";
  std::vector<Row> rows;
  for (const int hertz :
       soak ? std::vector<int>{15, 30, 60, 120, 240, 480, 1000, 2000} : std::vector<int>{15, 60, 240, 2000}) {
    const double step = 1.0 / hertz;
    Row row{"step", "1/" + std::to_string(hertz) + " s", both, {}, {}};
    const std::size_t count = soak || hertz < 1000 ? 10 : 4;  // fine steps take their time
    row.cases.push_back(poured("angles", "angle", angle(0.05, 0.01, 0.03), count, step));
    row.cases.push_back(poured("rings", "ring", ring(0.018, 0.0275, 0.012), count, step));
    if (soak) {
      row.cases.push_back(poured("40 cubes", "cube_30", cube(0.03), 40, step));
      // As high as the others it takes 38 to 40 of them, as they happen to fall.
      row.cases.back().request.bin.inner_size.z() = 0.16;
    }
    rows.push_back(row);
    if (hertz > 60 || (!soak && hertz != 60)) continue;
    row.name += ", not cut";
    row.known.clear();
    for (Case& c : row.cases) {
      c = uncut(c);
      if (hertz == 15) row.known["sphere: " + c.name] = sinks;
      if (hertz < 60) row.known["bullet: " + c.name] = sinks;
    }
    if (hertz == 15) row.known.erase("sphere: angles");
    if (hertz == 30) row.known["sphere: rings"] = sinks;
    if (hertz == 30) row.known.erase("bullet: angles");
    if (hertz == 60 && !soak) row.known["sphere: rings"] = sinks;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace bin_scenes::stress
