/// The ends of every scale: friction 0 and 5, restitution 0 and 1, gravity 0, tilted, sideways and heavy.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

Case heap(const std::string& name, bool soak, double friction, double restitution) {
  Case c = a_case(name);
  c.request.bin.inner_size = Vec3(0.14, 0.12, 0.15);
  c.request.bin.friction = friction;
  PartLine& line = pour_in(c, "angle", angle(0.05, 0.01, 0.03), soak ? 16 : 8);
  line.density = 2700.0;
  line.friction = friction;
  line.restitution = restitution;
  return c;
}

/// Nothing takes its energy: it must not rise either.
Case elastic_balls() {
  Case c = a_case("balls that lose nothing");
  c.request.bin.inner_size = Vec3(0.15, 0.12, 0.6);  // too deep to be left
  c.request.bin.restitution = 1.0;
  c.request.bin.friction = 0.0;
  PartLine& line =
      put(c, "ball", ball(0.02), {{0, 0, 0.1}, {0.04, 0.01, 0.15}, {-0.04, 0.02, 0.2}, {0.01, -0.03, 0.25}});
  line.restitution = 1.0;
  line.friction = 0.0;
  c.request.seconds = 4.0;
  c.expect.rests = false;
  return c;
}

Case floating() {
  Case c = a_case("parts that float");
  c.request.gravity.setZero();
  c.request.bin.inner_size = Vec3(0.3, 0.3, 0.3);
  put(c, "angle", angle(0.05, 0.01, 0.03), {{0, 0, 0.1}, {0.08, 0, 0.12}, {-0.08, 0, 0.2}});
  return c;
}

}  // namespace

std::vector<Row> materials(bool soak) {
  std::vector<Row> rows;
  Row friction{"material", "friction 0 and 5", both, {}, {}};
  friction.cases.push_back(heap("friction 0", soak, 0.0, 0.0));
  friction.cases.back().expect.rests = false;  // nothing but the walls stops what slides
  friction.cases.push_back(heap("friction 5", soak, 5.0, 0.0));
  rows.push_back(friction);

  Row restitution{"material", "restitution 0 and 1", both, {}, {}};
  restitution.cases.push_back(heap("restitution 0", soak, 0.5, 0.0));
  restitution.cases.push_back(heap("restitution 1", soak, 0.5, 1.0));
  restitution.cases.back().expect.rests = false;
  restitution.cases.back().request.pour.limit = 3.0;
  restitution.cases.push_back(elastic_balls());
  rows.push_back(restitution);

  Row gravity{"material", "gravity", both, {floating()}, {}};
  const auto under = [&](const std::string& name, const Vec3& g) {
    gravity.cases.push_back(heap(name, soak, 0.5, 0.1));
    gravity.cases.back().request.gravity = g;
  };
  under("tilted by 30 degrees", 9.81 * Vec3(std::sin(M_PI / 6), 0, -std::cos(M_PI / 6)));
  under("the moon's", Vec3(0, 0, -1.62));
  under("ten times the earth's", Vec3(0, 0, -98.1));
  rows.push_back(gravity);

  Row thesis{"material", "thesis preset", {"thesis"}, {}, {}};
  thesis.cases.push_back(heap("friction 0", soak, 0.0, 0.0));
  thesis.cases.push_back(heap("friction 5", soak, 5.0, 0.0));
  thesis.cases.push_back(heap("restitution 1", soak, 0.5, 1.0));
  for (Case& c : thesis.cases) {
    c.request.solver.thesis.sub_steps = 4;
    c.request.pour.limit = 1.0;
    c.expect.rests = false;
    c.expect.penetration = 0.1;  // the method's surface is as rough as its spheres, a tenth of a part wide
  }
  thesis.cases[2].expect.all_in = false;  // who still bounces leaves no room to those who wait
  if (soak) thesis.known["thesis: friction 0"] = "ten iterations do not carry a heap that nothing but walls holds";
  rows.push_back(thesis);
  return rows;
}

}  // namespace bin_scenes::stress
