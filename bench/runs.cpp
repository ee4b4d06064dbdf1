/// Builds the usual requests, pours them, and turns reports into rows. Rows of several seeds are joined into medians
/// and ranges.
#include "runs.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "framework/benchmark.hpp"

#include <cmath>
#include <cstdio>

namespace bin_scenes::bench {

Request bin_of(const std::string& part, std::size_t count) {
  Request request;
  PartLine line;
  line.model = part + ".stl";
  line.path = Run::part(part);
  line.unit = Unit::millimetre;
  line.count = count;
  line.density = 7850.0;
  request.parts.push_back(line);
  const double side = std::sqrt(static_cast<double>(count) / 150.0);
  request.bin.inner_size = Vec3(0.40 * side, 0.30 * side, 0.20);
  request.seed = 1;
  return request;
}

void choose_solver(Request& request, const std::string& name) {
  if (name == "bullet") {
    request.solver.type = SolverType::bullet;
  } else if (name == "sphere/quick") {
    request.solver.type = SolverType::sphere;
    apply(SolverSettings::Preset::quick, request);
  } else if (name == "sphere" || name == "sphere/gpu" || name == "sphere/thesis") {
    request.solver.type = SolverType::sphere;
    request.solver.preset = name == "sphere/thesis" ? SolverSettings::Preset::thesis : SolverSettings::Preset::standard;
    if (name == "sphere/gpu") request.solver.sphere.device = SphereSettings::Device::gpu;
  } else {
    throw input_error("no solver is called '" + name + "'", "benchmark",
                      "sphere, sphere/quick, sphere/gpu, sphere/thesis or bullet");
  }
}

std::string stages_of(const Profile& profile, double scale) {
  double total = 0.0;
  for (const auto& [stage, ms] : profile.stages_ms) total += ms;
  std::string out;
  for (const auto& [stage, ms] : profile.stages_ms) {
    if (ms < 0.01 * total) continue;
    char text[96];
    std::snprintf(text, sizeof text, "%s%s %.4g", out.empty() ? "" : "; ", stage.c_str(), scale * ms);
    out += text;
  }
  return out;
}

LoadedRequest loaded(const Request& request) {
  LoadedRequest out{request};
  for (const PartLine& line : request.parts) {
    LoadOptions options;
    options.unit = line.unit;
    out.parts.push_back(PartModel::load(line.path, options));
  }
  return out;
}

std::unique_ptr<Solver> solver_of(const LoadedRequest& loaded) {
  std::string reason;
  return make_solver(loaded, reason);
}

void pour_into(const std::string& path, const Request& request) {
  isolated([&] {
    const LoadedRequest all = loaded(request);
    write_text(path, scene_json(pour(all, *solver_of(all), {0}).front(), all));
    return Row();
  });
}

namespace {

/// Of a scene of one part line: half a second more, by the request's own solver.
void measure_drift(Scene& scene, LoadedRequest next) {
  next.request.pour.pattern = Pour::Pattern::given;
  next.request.seconds = 0.5;
  for (const ScenePart& part : scene.parts) next.request.parts[0].poses.push_back(part.pose);
  scene.report.drift = drift(scene, pour(next, *solver_of(next), {scene.index}).front(), next.parts);
}

}  // namespace

Poured pour_timed(const Request& request, const MakeSolver& make) {
  Poured out;
  const Clock clock;
  out.loaded = loaded(request);
  const std::unique_ptr<Solver> solver = make ? make() : solver_of(out.loaded);
  out.scene = std::move(pour(out.loaded, *solver, {request.first}).front());
  out.scene_s = clock.wall_s();
  out.cpu_s = clock.cpu_s();
  judge(out.scene, out.loaded);
  if (request.drift_check) measure_drift(out.scene, out.loaded);
  return out;
}

void warm_up(const Request& request) {
  isolated([&] {
    const LoadedRequest all = loaded(request);
    solver_of(all)->add_world(world_of(all));
    return Row();
  });
}

void warm_up(Request& request, const std::string& solver) {
  choose_solver(request, solver);
  warm_up(request);
}

Row figures_of(const Poured& poured) {
  const Report& report = poured.scene.report;
  const double diagonal = poured.loaded.parts.front()->diagonal();
  const Profile& profile = report.profile;
  Row row;
  row.measure("scene_s", poured.scene_s)
      .measure("cpu_s", poured.cpu_s)
      .measure("simulated_s", report.simulated_s)
      .measure("steps", static_cast<double>(report.steps))
      .measure("penetration_p95_rel", report.penetration.p95_relative)
      .measure("penetration_max_rel", report.penetration.max_relative)
      .measure("bin_penetration_max_rel", report.penetration.bin_max / diagonal)
      .measure("gap_p95_rel", report.gap.p95 / diagonal);
  if (report.drift.measured) {
    row.measure("own_drift_p95_rel", report.drift.p95 / diagonal)
        .measure("own_drift_max_rel", report.drift.max / diagonal)
        .measure("own_turn_p95_deg", report.drift.turn_p95 * 180.0 / M_PI);
  }
  return row.exact("scenes", 1)
      .exact("at_rest", static_cast<int>(report.at_rest))
      .exact("accepted", static_cast<int>(report.accepted))
      .exact("escaped", report.escaped.size())
      .exact("not_poured", report.not_poured.size())
      .info("device", report.device)
      .info("stages_ms", stages_of(profile));
}

Row joined(const std::vector<Row>& samples) {
  if (const Row& last = samples.back(); last.at("scenes").empty() && !last.at("status").empty()) return last;
  Row out;
  for (const auto& [column, first] : samples.front().cells()) {
    if (column.role == Role::spread) continue;
    if (column.role == Role::measure) {
      std::vector<double> values;
      for (const Row& row : samples)
        if (!row.at(column.name).empty()) values.push_back(row.number(column.name));
      out.measure(column.name, values);
    } else if (column.role == Role::exact && !std::isnan(samples.front().number(column.name))) {
      double sum = 0.0;
      for (const Row& row : samples) sum += row.number(column.name);
      out.exact(column.name, sum);
    } else {
      out.add(column, first);
    }
  }
  return out;
}

}  // namespace bin_scenes::bench
