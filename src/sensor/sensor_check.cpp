#include "bin_scenes/core/error.hpp"
#include "bin_scenes/scene/sensor_name.hpp"
#include "scene/range_check.hpp"
#include "sensor/sensor_keys.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <set>
#include <string>

namespace bin_scenes {

namespace {

void check_name(const std::string& key, const std::string& name) {
  bool plain = !name.empty() && name.size() <= 100;
  for (const char c : name) plain &= std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
  if (!plain)
    throw input_error("is '" + name + "'", key,
                      "use letters, digits, _ and - only, because frames and files are named by it");
}

void check_intrinsics(const std::string& key, const std::vector<double>& k) {
  if (k.empty()) return;
  bool good = k.size() == 9 && std::all_of(k.begin(), k.end(), [](double value) { return std::isfinite(value); });
  good = good && k[0] > 0 && k[4] > 0 && k[3] == 0 && k[6] == 0 && k[7] == 0 && k[8] == 1;
  if (!good) throw input_error("is not a matrix of intrinsics", key, "give [fx, 0, cx, 0, fy, cy, 0, 0, 1] in pixels");
  if (k[1] != 0) throw input_error("has a skew, which is not supported", key, "set the second number to 0");
}

void check_exposures(const std::string& key, const std::vector<double>& exposures) {
  if (std::adjacent_find(exposures.begin(), exposures.end(), std::greater_equal<>()) == exposures.end()) return;
  throw input_error("is not in ascending order", key,
                    "list each exposure once, the shortest first, for instance [0.2, 0.8, 3.2]");
}

void check_outliers(const std::string& key, const OutlierFilter& outlier) {
  if (outlier.window % 2 == 0)
    throw input_error("is even, but a window must have a central pixel", key + ".window",
                      "give an odd number, usually 3, 5 or 7");
  const int most = outlier.window * outlier.window - 1;
  if (outlier.neighbours > most)
    throw input_error(
        "is more than the number of neighbours in a window of " + std::to_string(outlier.window) + " pixels",
        key + ".neighbours", "give at most " + std::to_string(most) + ", or a larger window");
}

void check_median(const std::string& key, const MedianFilter& median) {
  if (median.window > 0 && median.window % 2 == 0)
    throw input_error("is even, but a window must have a central pixel", key + ".window",
                      "give an odd number, usually 3 or 5, or 0 for no filter");
}

void check_smoothing(const std::string& key, const Sensor& sensor) {
  if (sensor.settings.of<FilterSettings>().smoothing.sigma == 0.0) return;
  if (sensor_model(sensor.model).image == SensorModel::Image::pinhole) return;
  throw input_error("model " + sensor.model + " measures profiles, and its points are not on the rays of pixels", key,
                    "remove this key, or use another model");
}

/// What only some models use is checked whatever the model: a mistake in it must not wait for a change of model.
void check_sensor(const std::string& key, const Sensor& sensor) {
  Sensor copy = sensor;  // visitors take references to fields that are not const
  RangeCheck ranges(key + ".");
  check_intrinsics(key + ".k", sensor.k);
  visit(ranges, copy);
  check_name(key + ".name", sensor.name);
  check_exposures(key + ".imager.exposures", sensor.imager.exposures);
  check_outliers(key + ".filter.outlier", sensor.settings.of<FilterSettings>().outlier);
  check_median(key + ".filter.median", sensor.settings.of<FilterSettings>().median);
  check_smoothing(key + ".filter.smoothing", sensor);
  if (sensor.bounces.value_or(0) > 0 && !sensor_model(sensor.model).indirect)
    throw input_error(
        "model " + sensor.model + " does not simulate indirect light", key + ".bounces",
        "remove this key, or use one of the models that simulate it: " + names_of(&SensorModel::indirect));
  if (sensor.settings.of<CalibrationSettings>().any() && sensor_model(sensor.model).exact)
    throw input_error(
        "model " + sensor.model + " measures the exact depth, so that errors of calibration have no effect",
        key + ".calibration", "remove this key, or use another model");
  if (sensor.settings.of<CalibrationSettings>().range > 0.0 && sensor_model(sensor.model).report)
    throw input_error("model " + sensor.model + " measures by triangulation, and has no range error",
                      key + ".calibration.range", "give `baseline` instead");
  for (const SensorModel* model : sensor_models())
    if (model->check) model->check(sensor, key);
  if (!(sensor.far >= sensor.near))
    throw input_error("is less than `near`", key + ".far", "give a distance (m) that is larger than `near`");
}

}  // namespace

void check_sensors(const std::vector<Sensor>& sensors) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string key = "sensors[" + std::to_string(i) + "]";
    check_sensor(key, sensors[i]);
    if (!names.insert(graph_name(sensors[i].name)).second) {
      throw input_error(
          "'" + sensors[i].name + "' is also the name of an earlier sensor", key + ".name",
          "give each sensor another name; a hyphen counts as an underscore, because names of topics and frames "
          "contain an underscore instead");
    }
  }
}

}  // namespace bin_scenes
