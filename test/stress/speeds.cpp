/// A hundred metres a second, a thousand radians a second: nothing goes through anything.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

Case at_wall(const std::string& model, const Mesh& mesh, double speed, const Vec3& direction, const std::string& name) {
  Case c = a_case(name);
  c.request.bin.inner_size = Vec3(0.4, 0.4, 20.0);  // too deep to be left again
  throw_with(put(c, model, mesh, {{0, 0, 0.3}}), speed * direction.normalized(), Vec3(5, 7, 3));
  return c;
}

Case at_plate(double speed, double thickness, bool fixed) {
  Case c = in_free_flight(fixed ? "a cube at a fixed plate" : "a cube at a plate in free flight");
  throw_with(put(c, "cube_30", cube(0.03), {{-0.3, 0.004, 0.002}}), Vec3(speed, 0, 0), Vec3(1, 2, 3));
  PartLine& plate = put(c, with("plate_", thickness), box(Vec3(thickness, 0.4, 0.4)), {{0, 0, 0}});
  plate.fixed = fixed;
  c.expect.side = Vec3(-1, 0, 0);  // where it came from
  c.request.parts[0].restitution = 0.0;
  c.request.seconds = 1.2 / speed;
  c.expect.rests = false;
  if (!fixed) c.expect.momentum = 2e-3;
  return c;
}

Case spinning(const std::string& model, const Mesh& mesh, double rate, const std::string& name) {
  Case c = on_floor(name);
  throw_with(put(c, model, mesh, {{0, 0, 0.06}}), Vec3::Zero(), rate * Vec3(0.3, 0.2, 1.0).normalized());
  c.expect.rests = false;  // a spun top may take long
  c.request.pour.limit = 3.0;
  return c;
}

Case spinning_free(double rate) {
  Case c = in_free_flight("a plate tumbling in free flight");
  throw_with(put(c, "plate", box(Vec3(0.06, 0.04, 0.006)), {{0, 0, 0}}), Vec3::Zero(),
             rate * Vec3(0.01, 1.0, 0.01).normalized());
  c.request.seconds = 1.0;
  c.expect.rests = false;
  c.expect.energy = 1e-3;
  c.expect.momentum = 5e-3;
  return c;
}

}  // namespace

std::vector<Row> speeds(bool soak) {
  std::vector<Row> rows;
  for (const double speed : soak ? std::vector<double>{3, 10, 30, 100} : std::vector<double>{10, 100}) {
    Row row{"speed", with("", speed) + " m/s", speed == 10 ? both_forms : both, {}, {}};
    row.cases.push_back(at_wall("cube_30", cube(0.03), speed, Vec3(1, 0.2, 0), "a cube at a wall"));
    row.cases.push_back(at_wall("angle", angle(0.05, 0.01, 0.03), speed, Vec3(0, 0.1, -1), "an angle at the floor"));
    row.cases.push_back(at_wall("plate", box(Vec3(0.06, 0.04, 0.006)), speed, Vec3(1, 1, -1), "a plate into a corner"));
    row.cases.push_back(at_plate(speed, 0.005, true));
    row.cases.push_back(at_plate(speed, 0.005, false));
    // Linear momentum is kept; what changes is angular momentum.
    if (speed < 30) row.known["bullet: a cube at a plate in free flight"] = impact;
    rows.push_back(row);
  }
  for (const double rate : soak ? std::vector<double>{100, 1000} : std::vector<double>{1000}) {
    Row row{"speed", with("", rate) + " rad/s", both, {spinning_free(rate)}, {}};
    row.cases.push_back(spinning("ring", ring(0.018, 0.0275, 0.012), rate, "a ring dropped on the floor"));
    row.cases.push_back(spinning("cube_30", cube(0.03), rate, "a cube dropped on the floor"));
    if (rate >= 1000)
      row.known["sphere: a plate tumbling in free flight"] =
          "spin and axis are told half a sub-step apart, which is a hundredth of the angular momentum";
    rows.push_back(row);
  }
  return rows;
}

}  // namespace bin_scenes::stress
