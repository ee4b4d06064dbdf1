#include "page/sensor_plot.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "page/html.hpp"
#include "page/svg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace bin_scenes {

namespace {

constexpr double width = 400.0, height = 240.0, top = 30.0;  // of a panel, SVG units
const char* const colours[] = {"#000", "#a33", "#36a", "#2a2"};

/// Whole decades that hold all values; sigma is drawn between them.
struct Decades {
  double first, last;
  double y(double sigma) const { return top + height * (last - std::log10(sigma)) / (last - first); }
};

Decades decades_of(const SensorMetrics& m) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const PredictedSigma& p : m.predicted) {
    if (!(p.sigma > 0.0)) continue;
    least = std::min(least, p.sigma);
    most = std::max(most, p.sigma);
  }
  if (!(most > 0.0))
    throw input_error("there is nothing to plot: the sensor has no noise", "--plot", "remove this option");
  const double first = std::floor(std::log10(least));
  return {first, std::max(first + 1.0, std::ceil(std::log10(most)))};
}

using Curves = std::map<double, std::vector<Eigen::Vector2d>>;  ///< x and sigma, by albedo

/// @param ticks  values of x that are written below the panel, the first and last one at its ends
void draw_panel(Svg& svg, double left, const std::string& axis, const std::vector<double>& ticks, const Curves& curves,
                const Decades& decades) {
  const auto x = [&](double value) { return left + width * (value - ticks.front()) / (ticks.back() - ticks.front()); };
  const double bottom = top + height;
  for (double decade = decades.first; decade <= decades.last; ++decade) {
    const double y = decades.y(std::pow(10.0, decade));
    svg.curve({{left, y}, {left + width, y}}, "#ccc");
    svg.text({left - 6.0, y + 4.0}, short_number(std::pow(10.0, decade + 3.0), 6), "end");
  }
  for (const double tick : ticks) svg.text({x(tick), bottom + 18.0}, short_number(tick, 6), "middle");
  svg.text({left + 0.5 * width, bottom + 38.0}, axis, "middle");
  std::size_t number = 0;
  for (const auto& [albedo, points] : curves) {
    const char* const colour = colours[number++ % std::size(colours)];
    if (points.empty()) continue;
    std::vector<Eigen::Vector2d> drawn;
    for (const Eigen::Vector2d& p : points) drawn.emplace_back(x(p.x()), decades.y(p.y()));
    svg.curve(drawn, colour, 2.0);
    svg.text(drawn.back() + Eigen::Vector2d(6.0, 4.0), "albedo " + short_number(albedo, 6), "start", colour);
  }
}

}  // namespace

void write_sigma_plot(const std::string& path, const SensorMetrics& m) {
  const Decades decades = decades_of(m);
  Curves over_distance, over_incidence;
  for (const PredictedSigma& p : m.predicted) {
    auto &far = over_distance[p.albedo], &tilted = over_incidence[p.albedo];  // also of an albedo that is not measured
    if (!(p.sigma > 0.0)) continue;
    if (p.incidence == 0.0) far.emplace_back(p.distance, p.sigma);
    if (p.distance == m.distances[1]) tilted.emplace_back(degrees(p.incidence), p.sigma);
  }
  Svg svg("width=\"1110\" height=\"320\" font-family=\"sans-serif\" font-size=\"12\"");
  svg.bar({0.0, 0.0}, {1110.0, 320.0}, "white");
  svg.text({60.0, 18.0}, "predicted sigma of depth (mm)");
  draw_panel(svg, 60.0, "distance (m), facing", {m.distances.begin(), m.distances.end()}, over_distance, decades);
  draw_panel(svg, 610.0, "incidence (degrees) at " + short_number(m.distances[1], 3) + " m",
             {0, 10, 20, 30, 40, 50, 60, 70}, over_incidence, decades);
  write_text(path, svg.str());
}

}  // namespace bin_scenes
