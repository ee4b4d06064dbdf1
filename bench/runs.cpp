#include "runs.hpp"

#include "framework/isolated.hpp"

#include <sys/resource.h>

#include <cmath>
#include <cstdio>

namespace bin_scenes::bench {

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
  out.parts = generator.parts();
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

Poured pour_timed(const Request& request, const MakeSolver& make) {
  Poured out;
  const Clock clock;
  out.parts = load_parts(request);
  const std::unique_ptr<Solver> solver = make(out.parts);
  out.scene = std::move(pour(request, out.parts, *solver, {request.first}).front());
  out.scene_s = clock.wall_s();
  out.cpu_s = clock.cpu_s();
  judge(out.scene, request, out.parts);
  return out;
}

void warm_up(const Request& request) {
  isolated([&] {
    const std::vector<PartModelPtr> parts = load_parts(request);
    std::string reason;
    make_solver(request, parts, reason)->add_world(world_of(request, parts));
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
        .measure("own_drift_max_rel", report.drift.max / diagonal);
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
