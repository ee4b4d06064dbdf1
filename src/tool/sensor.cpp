#include "bin_scenes/config/presets.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/metrics.hpp"
#include "page/sensor_plot.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

namespace bin_scenes {

namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json list(const std::array<double, 7>& values) {
  Json json = Json::array();
  for (const double v : values) json.push_back(number(v));
  return json;
}

Json json_of(const Sensor& sensor, const SensorMetrics& m) {
  Json json = {{"model", sensor.model}, {"preset", sensor.preset}, {"unit", "m"}};
  json["distances"] = m.distances;
  for (const PredictedSigma& p : m.predicted) {
    json["predicted_sigma"].push_back({{"distance", p.distance},
                                       {"incidence_deg", std::round(degrees(p.incidence))},
                                       {"albedo", p.albedo},
                                       {"sigma", number(p.sigma)}});
  }
  json["ball_radius"] = m.ball_radius;
  json["probing_error_form"] = list(m.probing_form);
  json["probing_error_size"] = list(m.probing_size);
  json["sphere_spacing_error"] = number(m.sphere_spacing);
  json["flatness"] = list(m.flatness);
  json["point_precision"] = number(m.point_precision);
  json["temporal_noise"] = number(m.temporal_noise);
  json["local_planarity"] = number(m.local_planarity);
  json["global_planarity_trueness"] = number(m.global_planarity);
  json["dimension_trueness"] = number(m.dimension_trueness);
  json["valid_points"] = m.valid_points;
  return json;
}

void print_value(double value) {
  if (std::isnan(value))
    std::printf(" %8s", "unseen");
  else
    std::printf(" %8.4f", value);
}

/// @param factor  of the unit: 1e3 prints mm
void print_figure(const char* name, double value, double factor = 1e3, const char* unit = "") {
  std::printf("%-26s", name);
  print_value(factor * value);
  std::printf("%s\n", std::isnan(value) ? "" : unit);
}

void print_row(const char* name, const std::array<double, 7>& values) {
  std::printf("%-26s", name);
  for (const double v : values) print_value(1e3 * v);
  std::printf("\n");
}

void print_text(const Sensor& sensor, const SensorMetrics& m) {
  std::printf("%s, %s; lengths in mm\n\n", sensor.name.c_str(), sensor.model.c_str());
  std::printf("predicted sigma of depth   ");
  for (const double a : {0.05, 0.2, 0.5, 0.9}) std::printf(" albedo %3.0f %%", 100.0 * a);
  std::printf("\n");
  for (std::size_t i = 0; i + 3 < m.predicted.size(); i += 4) {
    std::printf("  %5.3f m, incidence %2.0f deg ", m.predicted[i].distance, degrees(m.predicted[i].incidence));
    for (std::size_t k = i; k < i + 4; ++k) {
      if (std::isfinite(m.predicted[k].sigma))
        std::printf(" %12.4f", 1e3 * m.predicted[k].sigma);
      else
        std::printf(" %12s", "-");
    }
    std::printf("\n");
  }
  std::printf("\nVDI/VDE 2634 part 2 at seven positions (ball radius %.1f mm; albedo 80 %%)\n", 1e3 * m.ball_radius);
  print_row("probing error, form", m.probing_form);
  print_row("probing error, size", m.probing_size);
  print_row("flatness error", m.flatness);
  print_figure("sphere spacing error", m.sphere_spacing);
  std::printf("\nas vendors print them\n");
  print_figure("point precision", m.point_precision);
  print_figure("temporal noise", m.temporal_noise);
  print_figure("local planarity", m.local_planarity);
  print_figure("global planarity trueness", m.global_planarity);
  print_figure("dimension trueness", m.dimension_trueness, 100.0, " %");
  std::printf("%-26s %zu\n", "points a plate", m.valid_points);
}

}  // namespace

int sensor(const SensorOptions& options) {
  const bool file = std::filesystem::is_regular_file(options.sensor);
  const Sensor sensor = file ? read_sensor_file(options.sensor) : sensor_preset(options.sensor);
  ProgressBar bar;
  bar.stage(0.0, 1.0, "measuring plates and balls");
  const SensorMetrics metrics = measure_sensor(sensor);
  bar.clear();
  if (!options.plot.empty()) write_sigma_plot(options.plot, metrics);
  if (options.json) {
    std::cout << json_of(sensor, metrics).dump(1) << "\n";
  } else {
    print_text(sensor, metrics);
  }
  return exit_done;
}

}  // namespace bin_scenes
