#include "bin_scenes/config/sensor_presets.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/metrics.hpp"
#include "tool/commands.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace bin_scenes {

namespace {

using Json = nlohmann::ordered_json;

double degrees(double radians) {
  return radians * 180.0 / M_PI;
}

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
  Json json = {{"model", name_of(sensor.model)}, {"preset", sensor.preset}, {"unit", "m"}};
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

void print_row(const char* name, const std::array<double, 7>& values) {
  std::printf("%-26s", name);
  for (const double v : values) std::printf(" %8.4f", 1e3 * v);
  std::printf("\n");
}

void print_text(const Sensor& sensor, const SensorMetrics& m) {
  std::printf("%s, %s; lengths in mm\n\n", sensor.name.c_str(), name_of(sensor.model));
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
  std::printf("%-26s %8.4f\n\nas vendors print them\n", "sphere spacing error", 1e3 * m.sphere_spacing);
  std::printf("%-26s %8.4f\n", "point precision", 1e3 * m.point_precision);
  std::printf("%-26s %8.4f\n", "temporal noise", 1e3 * m.temporal_noise);
  std::printf("%-26s %8.4f\n", "local planarity", 1e3 * m.local_planarity);
  std::printf("%-26s %8.4f\n", "global planarity trueness", 1e3 * m.global_planarity);
  std::printf("%-26s %8.4f %%\n", "dimension trueness", 100.0 * m.dimension_trueness);
  std::printf("%-26s %zu\n", "points a plate", m.valid_points);
}

/// Predicted sigma over incidence, a curve an albedo, for the middle distance; logarithmic.
void plot(const std::string& path, const SensorMetrics& m) {
  std::ofstream out(path);
  double least = 1e9, most = 0.0;
  for (const PredictedSigma& p : m.predicted) {
    if (p.distance != m.distances[1] || !(p.sigma > 0.0)) continue;
    least = std::min(least, p.sigma);
    most = std::max(most, p.sigma);
  }
  if (!(most > 0.0)) throw input_error("there is nothing to plot: no noise", path, "leave --plot out");
  const double first = std::floor(std::log10(least)), last = std::max(first + 1.0, std::ceil(std::log10(most)));
  const auto x = [](double incidence) { return 70.0 + 400.0 * degrees(incidence) / 70.0; };
  const auto y = [&](double sigma) { return 270.0 - 240.0 * (std::log10(sigma) - first) / (last - first); };
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"560\" height=\"320\" font-family=\"sans-serif\" "
         "font-size=\"12\">\n<rect width=\"560\" height=\"320\" fill=\"white\"/>\n";
  for (double decade = first; decade <= last; ++decade) {
    const double at = y(std::pow(10.0, decade));
    out << "<path d=\"M70 " << at << "H470\" stroke=\"#ccc\"/><text x=\"64\" y=\"" << at + 4
        << "\" text-anchor=\"end\">" << std::pow(10.0, decade + 3.0) << "</text>\n";
  }
  for (const int d : {0, 10, 20, 30, 40, 50, 60, 70}) {
    out << "<text x=\"" << x(d * M_PI / 180.0) << "\" y=\"288\" text-anchor=\"middle\">" << d << "</text>\n";
  }
  out << "<text x=\"270\" y=\"308\" text-anchor=\"middle\">incidence (degrees)</text>\n<text x=\"70\" y=\"18\">sigma "
         "of "
         "depth (mm) at "
      << m.distances[1] << " m</text>\n";
  const char* const colours[] = {"#000", "#a33", "#36a", "#2a2"};
  for (std::size_t k = 0; k < 4; ++k) {
    std::string path_of, separator = "M";
    double end = 0.0;
    for (std::size_t i = k; i < m.predicted.size(); i += 4) {
      const PredictedSigma& p = m.predicted[i];
      if (p.distance != m.distances[1] || !(p.sigma > 0.0)) continue;
      path_of += separator + std::to_string(x(p.incidence)) + " " + std::to_string(end = y(p.sigma));
      separator = "L";
    }
    out << "<path d=\"" << path_of << "\" fill=\"none\" stroke=\"" << colours[k] << "\" stroke-width=\"2\"/>"
        << "<text x=\"476\" y=\"" << end + 4 << "\" fill=\"" << colours[k] << "\">albedo " << m.predicted[k].albedo
        << "</text>\n";
  }
  out << "</svg>\n";
  if (!out.flush()) throw environment_error("the plot can not be written", path, "check folder and disk");
}

}  // namespace

int sensor(const SensorOptions& options) {
  const bool file = std::filesystem::is_regular_file(options.sensor);
  const Sensor sensor = file ? read_sensor_file(options.sensor) : sensor_preset(options.sensor);
  const SensorMetrics metrics = measure_sensor(sensor);
  if (!options.plot.empty()) plot(options.plot, metrics);
  if (options.json) {
    std::cout << json_of(sensor, metrics).dump(1) << "\n";
  } else {
    print_text(sensor, metrics);
  }
  return exit_done;
}

}  // namespace bin_scenes
