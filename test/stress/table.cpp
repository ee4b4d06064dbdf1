#include "stress/table.hpp"

#include "bin_scenes/core/error.hpp"
#include "framework/host.hpp"
#include "framework/table.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace bin_scenes::stress {

namespace {

std::string figure(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// "2 to 100", of what is asked of the cases of a row.
std::string range_of(const LimitRange& limit, double scale) {
  const auto text = [&](double value) { return std::isinf(value) ? "none" : figure("%.3g", scale * value); };
  return limit.least == limit.most ? text(limit.least) : text(limit.least) + " to " + text(limit.most);
}

std::string joined(const std::vector<std::string>& texts, const std::string& between) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : between) + text;
  return all;
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw environment_error("cannot be written", path, "choose another path");
}

}  // namespace

void LimitRange::extend(double limit) {
  least = std::min(least, limit);
  most = std::max(most, limit);
}

void Tally::add(const Case& c, const Outcome& o, const std::string& why_known) {
  ++tried;
  penetration_limit.extend(c.expect.penetration);
  energy_limit.extend(c.expect.traced ? c.expect.energy : std::numeric_limits<double>::infinity());
  steps += o.steps;
  if (c.expect.flat) {
    flat = true;
    growth_bytes = o.growth_bytes;
    pace = o.pace;
  }
  survived += o.survived();
  flagged += !o.flags.empty();
  if (!o.device.empty()) device = o.device;
  penetration = std::max(penetration, o.penetration);
  drift = std::max(drift, o.drift);
  energy = std::max(energy, o.energy);
  cpu_s += o.cpu_s;
  simulated_s += o.simulated_s;
  peak_mb = std::max(peak_mb, o.peak_mb);
  if (!o.survived())
    failures.push_back(c.name + ": " + joined(o.failures, "; ") +
                       (why_known.empty() ? "" : " (known: " + why_known + ")"));
}

void write_csv(const std::string& path, const std::vector<Tally>& rows, const std::string& command) {
  using bench::Row;
  bench::Table table;
  table.header = {{"benchmark", "stress"}, {"command", command}, {"measures", "src shaders"}};
  for (const auto& line : bench::host()) table.header.push_back(line);
  for (const Tally& t : rows)
    table.add(Row()
                  .key("theme", t.theme)
                  .key("row", t.row)
                  .key("solver", t.solver)
                  .info("device", t.device)
                  .exact("tried", t.tried)
                  .exact("survived", t.survived)
                  .info("penetration_max_rel", t.penetration)
                  .info("drift_max_rel", t.drift)
                  .info("energy_gain_rel", t.energy)
                  .info("penetration_limit_rel", range_of(t.penetration_limit, 1.0))
                  .info("energy_limit_rel", range_of(t.energy_limit, 1.0))
                  .info("simulated_s", t.simulated_s)
                  .info("mean_step_s", t.mean_step())
                  .info("growth_bytes", t.flat ? Row::text(t.growth_bytes) : "")
                  .info("pace", t.flat ? Row::text(t.pace) : "")
                  .info("cpu_s", t.cpu_s)
                  .info("peak_mb", t.peak_mb)
                  .info("failures", joined(t.failures, " | ")));
  write_file(path, bench::to_csv(table));
}

}  // namespace bin_scenes::stress
