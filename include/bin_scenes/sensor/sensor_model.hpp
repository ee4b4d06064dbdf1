/// The interface of a sensor model, and the list of all models. A model is one file that ends with its SensorModel.
/// Built-in models are src/sensor/models/NAME_model.cpp, listed in src/sensor/CMakeLists.txt; a program may register
/// models of its own. Request files, `--set`, suggestions, docs/use/request.md, check_sensors(), messages, scene.json,
/// frames, outputs and `bin_scenes sensor` all use this list, so that nothing else must be changed for a new model.
#pragma once

#include "bin_scenes/scene/key.hpp"
#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/sensor/models.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// An operation on the keys of a model's settings: reading, writing, checking or listing them.
class KeyVisitor {
 public:
  /// Visits a map of further keys; `visit_keys` visits these.
  virtual void section(const Key& key, const std::function<void(KeyVisitor&)>& visit_keys) = 0;
  virtual void field(const Key& key, double& value) = 0;
  virtual void field(const Key& key, int& value) = 0;
  virtual void field(const Key& key, bool& value) = 0;
  virtual void field(const Key& key, Word& value) = 0;
  template <class Enum>
  void field(const Key& key, Enum& value, const Names<Enum>& names) {
    Word word;
    for (const auto& [name, meaning] : names) {
      word.known.emplace_back(name);
      if (meaning == value) word.value = name;
    }
    field(key, word);
    for (const auto& [name, meaning] : names)
      if (word.value == name) value = meaning;
  }

 protected:
  ~KeyVisitor() = default;
};

/// One sensor model: its names, its functions, and the properties of its device.
struct SensorModel {
  const char* name;  ///< value of the key `model`, and name of the section of its settings
  const char* text;  ///< description of that section
  /// Visits all keys of the model's settings, which it takes from the ModelSettings by their type. Null: the model has
  /// no section.
  void (*visit)(KeyVisitor& visitor, ModelSettings& settings);
  /// Throws an input Error that names a key below `key`, for mistakes that the ranges of single keys do not exclude. It
  /// is called for every sensor, whatever its model is, so that a mistake is found before the model is selected.
  void (*check)(const Sensor& sensor, const std::string& key);
  /// Makes the same tests for a resolved() sensor of this model, whose poses are known.
  void (*check_places)(const Sensor& sensor, const std::string& where);
  /// Makes the measured and the true images. @param view  view of the sensor's camera; its images may be moved out of
  /// it
  RangeImage (*measure)(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                        const Draw& draw);
  /// Returns the value of predicted_sigma() for a sensor with noise.
  double (*predicted_sigma)(const Sensor& sensor, double distance, double incidence, double albedo);

  enum class Image {
    pinhole,  ///< the point of a pixel is on its ray
    profiles  ///< the rows are the Scan::profiles profiles of a scan
  } image = Image::pinhole;
  // Which further devices, settings and effects the model uses.
  bool imager = false;
  bool projector = false;
  bool laser = false;     ///< the laser, and Scan
  bool fidelity = false;  ///< it supports both values of Fidelity
  bool indirect = false;  ///< it sees light that was reflected by other surfaces
  int bounces = 0;        ///< default of Sensor::bounces
  bool gray = false;      ///< whether it makes RangeImage::gray if Draw::gray is true
  bool exact = false;     ///< whether it measures without errors, with the true normals
  /// Converts the depths or points that `device` measured into those that it reports with the calibration of
  /// `believed`. Null: the range along the ray of a pixel stays the same.
  void (*report)(RangeImage& image, const Sensor& device, const Sensor& believed) = nullptr;
};

/// Returns all models in the order of messages and reference.
const std::vector<const SensorModel*>& sensor_models();
/// Returns the model of that name. Throws an input Error for an unknown name.
const SensorModel& sensor_model(const std::string& name);
/// Adds a model, which must exist until the end of the program. Call it from one thread only and before the first
/// request is read, for instance in the initialiser of a constant. Returns true. Throws an input Error if the name
/// exists.
bool register_sensor_model(const SensorModel& model);

/// Returns the light sources that a sensor's model uses: "projector" and "laser" with their poses. @param sensor  as
/// returned by resolved()
std::vector<std::pair<const char*, Pose>> light_of(const Sensor& sensor);

/// Throws an input Error for the first key of a sensor whose value is impossible.
void check_sensors(const std::vector<Sensor>& sensors);

}  // namespace bin_scenes
