#include "sensors/rows.hpp"
#include "sensors/stage.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes::bench {
namespace {

/// Errors of the disparity (pixel). NaN: not matched, or matched wrongly by a pixel or more.
std::vector<double> disparity_errors(const Shot& shot, double scale) {
  std::vector<double> errors(shot.view.depth.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i] = scale / shot.measured.depth[i] - scale / shot.view.depth[i];
    if (!(std::abs(errors[i]) < 1.0)) errors[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return errors;
}

double correlation(const std::vector<double>& errors, int width, int lag) {
  double product = 0.0, square = 0.0, pairs = 0.0, count = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (std::isnan(errors[i])) continue;
    square += errors[i] * errors[i];
    ++count;
    if (static_cast<int>(i) % width + lag >= width || std::isnan(errors[i + lag])) continue;
    product += errors[i] * errors[i + lag];
    ++pairs;
  }
  return product / pairs / (square / count);
}

}  // namespace

void stereo_rows(Run& out) {
  for (const Fidelity fidelity : {Fidelity::decoded, Fidelity::analytic}) {
    for (const int window : {5, 11}) {
      Sensor sensor = sensor_of("stereo", 1.0);
      sensor.fidelity = fidelity;
      sensor.settings.of<StereoSettings>().window = window;
      sensor.settings.of<StereoSettings>().disparities = 256;
      std::vector<double> errors;  // made for the first row that is wanted
      const struct {
        int lag;
        const char* goal;
      } rows[] = {{1, "at least 0.5; white noise: 0"}, {window / 2, ""}, {window, ""}, {3 * window, "at most 0.25"}};
      for (const auto& [lag, goal] : rows) {
        Figure figure{"stereo: autocorrelation of errors at a lag of " + std::to_string(lag) + " pixels"};
        figure.setting =
            std::string(fidelity == Fidelity::decoded ? "matched" : "analytic") + ", window " + std::to_string(window);
        figure.incidence_deg = 17.0;
        if (!out.wanted(figure.key())) continue;
        if (errors.empty()) {
          Targets targets = plate(1.0, 17.0, 0.6);
          const double scale = sensor.k[0] * sensor.settings.of<StereoSettings>().baseline;
          errors = disparity_errors(shoot(targets, sensor, 1), scale);
        }
        out.row(row_of(figure, correlation(errors, sensor.width, lag), "", goal));
      }
    }
  }
}

}  // namespace bin_scenes::bench
