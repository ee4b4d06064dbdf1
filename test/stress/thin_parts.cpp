/// Needles, sheets and slivers: what has no inside to speak of is easily passed through.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

/// Relative overlap at which one part has passed half the thickness of the other.
double half_the_thickness(double thickness, const Mesh& mesh) {
  return 0.5 * thickness / mesh.bounds().diagonal();
}

Case heap(const std::string& model, const Mesh& mesh, double thickness, std::size_t count, const Vec3& bin) {
  Case c = a_case(std::to_string(count) + " poured");
  c.request.bin.inner_size = bin;
  pour_in(c, model, mesh, count).density = 2700.0;
  c.expect.penetration = half_the_thickness(thickness, mesh);
  return c;
}

Case crossed(const std::string& model, const Mesh& mesh, double thickness, double height) {
  Case c = on_floor("one dropped across another");
  PartLine& line = put(c, model, mesh, {{0, 0, 0.52 * thickness}, {0, 0, height}});
  line.density = 2700.0;
  line.poses[1].orientation = Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()));
  c.expect.penetration = half_the_thickness(thickness, mesh);
  c.expect.height = 0.5 * thickness;
  return c;
}

Case flat_surface(std::optional<double> thickness) {
  Case c = a_case(thickness ? "two triangles given a thickness" : "two triangles without thickness are refused");
  pour_in(c, "quad", quad(0.05, 0.04), 3).thickness = thickness;
  c.expect.refused = !thickness;
  if (thickness) c.expect.penetration = 0.5 * *thickness / std::hypot(0.05, 0.04);
  return c;
}

}  // namespace

std::vector<Row> thin_parts(bool soak) {
  std::vector<Row> rows;
  for (const int aspect : soak ? std::vector<int>{20, 50, 100, 200} : std::vector<int>{200}) {
    const double thickness = 0.2 / aspect;
    const Mesh needle = box(Vec3(0.2, thickness, thickness));
    Row row{"thin", "needles 1:" + std::to_string(aspect), both, {}, {}};
    row.cases.push_back(crossed(with("needle_", aspect), needle, thickness, 0.02));
    row.cases.push_back(heap(with("needle_", aspect), needle, thickness, soak ? 20 : 6, Vec3(0.3, 0.25, 0.1)));
    if (aspect == 200) {
      row.known["bullet: one dropped across another"] = "rests sunk in by 0.7 of its thickness; why was not looked at";
      row.known["bullet: 6 poured"] = "one of 12 seeds: a needle that leans slides on";
    }
    rows.push_back(row);
  }
  for (const double thickness : soak ? std::vector<double>{2e-3, 1e-3, 5e-4, 2e-4} : std::vector<double>{1e-3, 2e-4}) {
    const Mesh sheet = box(Vec3(0.05, 0.04, thickness));
    Row row{"thin", "sheets of " + with("", 1e3 * thickness) + " mm", both, {}, {}};
    row.cases.push_back(crossed(with("sheet_", 1e3 * thickness), sheet, thickness, 0.01));
    row.cases.push_back(heap(with("sheet_", 1e3 * thickness), sheet, thickness, soak ? 20 : 6, Vec3(0.12, 0.1, 0.08)));
    rows.push_back(row);
  }
  Row slivers{"thin", "slivers", both, {flat_surface({}), flat_surface(1e-3), flat_surface(2e-4)}, {}};
  const Mesh plate = sliver_plate(0.06, 0.04, 0.006, 1000);
  slivers.cases.push_back(heap("sliver_plate", plate, 0.006, 6, Vec3(0.12, 0.1, 0.08)));
  slivers.cases.back().name = "plates of 2,000 slivers";
  rows.push_back(slivers);
  return rows;
}

}  // namespace bin_scenes::stress
