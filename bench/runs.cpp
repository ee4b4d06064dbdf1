/// Builds the usual requests, pours them in processes of their own, and turns reports into rows. Rows of several seeds
/// are joined into medians and ranges.
#include "runs.hpp"

#include "bin_scenes/core/error.hpp"
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "quality/clearance.hpp"

#include <sys/resource.h>

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

double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Poured pour_timed(const Request& request) {
  Poured out;
  Generator generator;
  Generator::Options options;
  options.render = false;
  const Clock clock;
  bool judging = false;
  options.hooks.progress = [&](const Progress& progress) {
    if (judging || progress.phase != "quality") return;  // the first word of the judge: the poses are final
    judging = true;
    out.scene_s = clock.wall_s();
    out.cpu_s = clock.cpu_s();
  };
  generator.generate(request, options, [&](Generator::Result&& result) { out.scene = std::move(result.scene); });
  out.parts = generator.loaded().parts;
  return out;
}

std::vector<PartModelPtr> load_parts(const Request& request) {
  std::vector<PartModelPtr> parts;
  for (const PartLine& line : request.parts) {
    LoadOptions options;
    options.unit = line.unit;
    parts.push_back(PartModel::load(line.path, options));
  }
  return parts;
}

namespace {

/// Of a scene of one part line: half a second more, by the request's own solver.
void measure_drift(Scene& scene, Request next, const std::vector<PartModelPtr>& parts) {
  next.pour.pattern = Pour::Pattern::given;
  next.seconds = 0.5;
  for (const ScenePart& part : scene.parts) next.parts[0].poses.push_back(part.pose);
  std::string reason;
  const std::unique_ptr<Solver> solver = make_solver(next, parts, reason);
  scene.report.drift = drift(scene, pour({next, parts}, *solver, {scene.index}).front(), parts);
}

}  // namespace

Poured pour_timed(const Request& request, const MakeSolver& make) {
  Poured out;
  const Clock clock;
  out.parts = load_parts(request);
  const std::unique_ptr<Solver> solver = make(out.parts);
  out.scene = std::move(pour({request, out.parts}, *solver, {request.first}).front());
  out.scene_s = clock.wall_s();
  out.cpu_s = clock.cpu_s();
  judge(out.scene, {request, out.parts});
  if (request.drift_check) measure_drift(out.scene, request, out.parts);
  return out;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> touching_pairs(const PartModel& part,
                                                                    const std::vector<Pose>& poses) {
  const double limit = 2e-3 * part.diagonal();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t i = 0; i < poses.size(); ++i)
    for (std::uint32_t k = 0; k < i; ++k) {
      const Vec3 apart = poses[i] * part.mass().center - poses[k] * part.mass().center;
      if (apart.norm() > 2.0 * part.radius() + limit) continue;
      if (test::clearance(part.query(), poses[i], part.query(), poses[k], 2.0 * limit) <= limit)
        pairs.emplace_back(k, i);
    }
  return pairs;
}

void warm_up(const Request& request) {
  isolated([&] {
    const std::vector<PartModelPtr> parts = load_parts(request);
    std::string reason;
    make_solver(request, parts, reason)->add_world(world_of({request, parts}));
    return Row();
  });
}

Row figures_of(const Poured& poured) {
  const Report& report = poured.scene.report;
  const double diagonal = poured.parts.front()->diagonal();
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

Row over_seeds(Request request, int seeds, double limit_cpu_s) {
  warm_up(request);
  std::vector<Row> rows;
  for (int k = 0; k < seeds; ++k, ++request.seed) {
    Isolated one = isolated([&] { return figures_of(pour_timed(request)); }, limit_cpu_s);
    if (!one.good) return one.row;
    rows.push_back(one.row.measure("peak_mb", one.peak_mb));
  }
  return joined(rows);
}

}  // namespace bin_scenes::bench
