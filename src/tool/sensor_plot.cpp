#include "tool/sensor_plot.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
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
  if (!(most > 0.0)) throw input_error("there is nothing to plot: the sensor has no noise", "--plot", "leave it out");
  const double first = std::floor(std::log10(least));
  return {first, std::max(first + 1.0, std::ceil(std::log10(most)))};
}

struct Point {
  double x, sigma;
};
using Curves = std::map<double, std::vector<Point>>;  ///< by albedo

/// @param ticks  values of x that are written below the panel, the first and last one at its ends
void draw(std::ostream& out, double left, const std::string& axis, const std::vector<double>& ticks,
          const Curves& curves, const Decades& decades) {
  const auto x = [&](double value) { return left + width * (value - ticks.front()) / (ticks.back() - ticks.front()); };
  const double bottom = top + height;
  for (double decade = decades.first; decade <= decades.last; ++decade) {
    const double y = decades.y(std::pow(10.0, decade));
    out << "<path d=\"M" << left << " " << y << "h" << width << "\" stroke=\"#ccc\"/><text x=\"" << left - 6
        << "\" y=\"" << y + 4 << "\" text-anchor=\"end\">" << std::pow(10.0, decade + 3.0) << "</text>\n";
  }
  for (const double tick : ticks) {
    out << "<text x=\"" << x(tick) << "\" y=\"" << bottom + 18 << "\" text-anchor=\"middle\">" << tick << "</text>\n";
  }
  out << "<text x=\"" << left + 0.5 * width << "\" y=\"" << bottom + 38 << "\" text-anchor=\"middle\">" << axis
      << "</text>\n";
  std::size_t number = 0;
  for (const auto& [albedo, points] : curves) {
    const char* const colour = colours[number++ % std::size(colours)];
    if (points.empty()) continue;
    out << "<path d=\"";
    for (const Point& p : points) out << (&p == &points.front() ? "M" : "L") << x(p.x) << " " << decades.y(p.sigma);
    out << "\" fill=\"none\" stroke=\"" << colour << "\" stroke-width=\"2\"/><text x=\"" << x(points.back().x) + 6
        << "\" y=\"" << decades.y(points.back().sigma) + 4 << "\" fill=\"" << colour << "\">albedo " << albedo
        << "</text>\n";
  }
}

}  // namespace

void write_sigma_plot(const std::string& path, const SensorMetrics& m) {
  const Decades decades = decades_of(m);
  Curves over_distance, over_incidence;
  for (const PredictedSigma& p : m.predicted) {
    auto &far = over_distance[p.albedo], &tilted = over_incidence[p.albedo];  // also of an albedo that is not measured
    if (!(p.sigma > 0.0)) continue;
    if (p.incidence == 0.0) far.push_back({p.distance, p.sigma});
    if (p.distance == m.distances[1]) tilted.push_back({degrees(p.incidence), p.sigma});
  }
  std::ofstream out(path);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1110\" height=\"320\" font-family=\"sans-serif\" "
         "font-size=\"12\">\n<rect width=\"1110\" height=\"320\" fill=\"white\"/>\n<text x=\"60\" y=\"18\">predicted "
         "sigma of depth (mm)</text>\n";
  draw(out, 60.0, "distance (m), facing", {m.distances.begin(), m.distances.end()}, over_distance, decades);
  char axis[64];
  std::snprintf(axis, sizeof axis, "incidence (degrees) at %.3g m", m.distances[1]);
  draw(out, 610.0, axis, {0, 10, 20, 30, 40, 50, 60, 70}, over_incidence, decades);
  out << "</svg>\n";
  if (!out.flush()) throw environment_error("the plot can not be written", path, "check folder and disk");
}

}  // namespace bin_scenes
