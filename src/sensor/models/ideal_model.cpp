/// Exact depth at pixel centres.
#include "sensor/models/ideal.hpp"
#include "sensor/models/of_sensor.hpp"

namespace bin_scenes {

namespace {

RangeImage measured(const Scenery&, View&& view, const Sensor&, const Surfaces&, const Draw&) {
  return measure_ideal(std::move(view));
}

double sigma(const Sensor&, double, double, double) {
  return 0.0;
}

constexpr SensorModel model() {
  SensorModel m{"ideal", "", nullptr, nullptr, nullptr, measured, sigma};
  m.exact = true;
  return m;
}

}  // namespace

extern const SensorModel ideal_model = model();

}  // namespace bin_scenes
