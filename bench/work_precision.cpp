/// Work-precision diagram: error of the final scene over scene time, each solver over its settings, on parts whose
/// exact convex pieces are known, so that other engines get the exact shape and the referee judges all alike.
#include "framework/benchmark.hpp"
#include "judged.hpp"

#include <cmath>

namespace bin_scenes::bench {
namespace {

/// One point of a curve.
struct Setting {
  std::string solver, sleeping, varied, value;
  std::function<void(Request&)> apply;  ///< on the request; none for a peer
  std::optional<PeerSettings> peer;
};

std::vector<Setting> settings(bool quick) {
  std::vector<Setting> all;
  const auto add = [&](const std::string& solver, const std::string& varied, double value,
                       const std::function<void(SolverSettings&)>& change) {
    all.push_back({solver, "yes", varied, Row::text(value),
                   [=](Request& request) {
                     choose_solver(request, solver);
                     change(request.solver);
                   },
                   std::nullopt});
  };
  const SphereSettings sphere;
  const BulletSettings bullet;
  add("sphere", "default", 0, [](SolverSettings&) {});
  for (const double factor : {8.0, 4.0, 2.0, 0.5}) {
    if (quick && factor != 4.0) continue;
    const double dt = factor * sphere.time_step;
    add("sphere", "time_step", dt, [=](SolverSettings& s) { s.sphere.time_step = dt; });
  }
  if (!quick) {
    for (const double factor : {0.5, 2.0, 4.0}) {
      const int steps = std::max(1, static_cast<int>(std::lround(factor * sphere.sub_steps)));
      add("sphere", "sub_steps", steps, [=](SolverSettings& s) { s.sphere.sub_steps = steps; });
    }
    for (const double factor : {0.25, 0.5, 3.0}) {
      const int samples = static_cast<int>(std::lround(factor * sphere.fine_samples));
      add("sphere", "fine_samples", samples, [=](SolverSettings& s) {
        s.sphere.fine_samples = samples;
        s.sphere.coarse_samples = std::min(s.sphere.coarse_samples, samples);
      });
    }
    for (const double factor : {4.0, 2.0, 0.5}) {
      const double cell = factor * sphere.field_cell;
      add("sphere", "field_cell", cell, [=](SolverSettings& s) { s.sphere.field_cell = cell; });
    }
    for (const int steps : {1, 4}) {
      add("sphere/thesis", "sub_steps", steps, [=](SolverSettings& s) { s.thesis.sub_steps = steps; });
      all.back().sleeping = "no";
    }
  }
  for (const bool sleeping : {true, false}) {
    for (const double factor : {4.0, 1.0, 0.5}) {
      if (quick && (!sleeping || factor != 1.0)) continue;
      const double dt = factor * bullet.time_step;
      add("bullet", "time_step", dt, [=](SolverSettings& s) {
        s.bullet.time_step = dt;
        s.bullet.sleeping = sleeping;
      });
      all.back().sleeping = sleeping ? "yes" : "no";
    }
  }
  for (const double rate : quick ? std::vector<double>{240} : std::vector<double>{100, 240, 1000}) {
    for (const char* engine : {"bullet_stock", "ode", "dart"}) {
      if (std::string(engine) == "dart" && rate > 240) continue;  // its dense systems take minutes a scene as it is
      const bool stock = std::string(engine) == "bullet_stock";
      Setting peer{engine, stock ? "yes" : "no", "time_step", Row::text(1.0 / rate), {}, PeerSettings{}};
      peer.peer->engine = engine;
      peer.peer->time_step = 1.0 / rate;
      peer.peer->iterations = stock ? 10 : 50;
      all.push_back(peer);
    }
  }
  return all;
}

bool dominates(const Row& a, const Row& b, const std::string& error) {
  const double time_a = a.number("cpu_s"), time_b = b.number("cpu_s");
  const double error_a = a.number(error), error_b = b.number(error);
  return time_a <= time_b && error_a <= error_b && (time_a < time_b || error_a < error_b);
}

/// Marks the rows that no other row beats in both time and error. Scenes that did not come to rest, or lost parts,
/// have no place on it.
void mark_front(std::vector<Row>& rows, const std::string& error, const std::string& column) {
  const auto stands = [&](const Row& row) {
    return row.at("at_rest") == row.at("scenes") && row.at("escaped") == "0" && !std::isnan(row.number(error));
  };
  for (Row& row : rows) {
    if (row.at("scenes").empty()) continue;
    bool front = stands(row);
    for (const Row& other : rows) front = front && !(stands(other) && dominates(other, row, error));
    row.info(column, front);
  }
}

void run(Run& out) {
  struct Pile {
    const char* part;
    std::size_t count;
    int seeds;
  };
  const std::vector<Pile> piles = out.quick() ? std::vector<Pile>{{"channel_u", 8, 1}}
                                              : std::vector<Pile>{{"channel_u", 32, 2}, {"ring_24", 16, 1}};
  for (const Pile& pile : piles) {
    for (const Setting& setting : settings(out.quick())) {
      Row row;
      row.key("part", pile.part)
          .key("bodies", pile.count)
          .key("solver", setting.solver)
          .key("sleeping", setting.sleeping);
      row.key("varied", setting.varied).key("value", setting.value);
      if (!out.wanted(row)) continue;
      if (setting.apply) {
        Request request = bin_of(pile.part, pile.count);
        setting.apply(request);
        warm_up(request);
      }
      std::vector<Row> scenes;
      for (int seed = 1; seed <= pile.seeds; ++seed) {
        Request request = bin_of(pile.part, pile.count);
        request.seed = static_cast<std::uint64_t>(seed);
        if (setting.apply) setting.apply(request);
        scenes.push_back(judged_scene(out.scratch(), request, Run::pieces(pile.part), setting.peer,
                                      {out.quick() ? 20.0 : 60.0, true}));
        if (scenes.back().at("scenes").empty()) break;
      }
      row.append(scenes.back().at("scenes").empty() ? scenes.back() : joined(scenes));
      out.row(row);
    }
    std::vector<Row> rows;
    for (std::size_t r = 0; r < out.table().rows.size(); ++r)
      if (out.table().rows[r].at("part") == pile.part) rows.push_back(out.table().row(r));
    mark_front(rows, "penetration_p95_rel", "front_penetration");
    mark_front(rows, "drift_p95_rel", "front_drift");
    for (const Row& row : rows) out.amend(row);
  }
}

const Registration registration{"work_precision",
                                "error over scene time: all solvers over their settings, ODE and DART beside",
                                {"part", "bodies", "solver", "sleeping", "varied", "value"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
