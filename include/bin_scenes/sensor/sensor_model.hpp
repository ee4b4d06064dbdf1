/// The interface of a sensor model, and the list of all models. A model is one file that ends in its SensorModel:
/// built-in ones are src/sensor/models/NAME_model.cpp, listed in src/sensor/CMakeLists.txt; a program may register
/// models of its own. Request files, `--set`, suggestions, docs/use/request.md, check_sensors(), messages, scene.json,
/// frames, outputs and `bin_scenes sensor` all use this table.
#pragma once

#include "bin_scenes/scene/key.hpp"
#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/sensor/models.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// An operation on the keys of a model's settings: they are read, written, checked or listed.
class KeyVisitor {
 public:
  /// A map of further keys, which `visit_keys` visits.
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

struct SensorModel {
  const char* name;  ///< of `model`, and of the section of its settings
  const char* text;  ///< of that section
  /// All keys of its settings, which it takes from the ModelSettings by their type. None: it has no section.
  void (*visit)(KeyVisitor& visitor, ModelSettings& settings);
  /// Throws an input Error that names a key below `key` for mistakes that the ranges of single keys do not exclude. It
  /// is called for every sensor, whatever its model is, so that a mistake is found before the model is selected.
  void (*check)(const Sensor& sensor, const std::string& key);
  /// The same for a sensor of this model that is resolved().
  void (*check_places)(const Sensor& sensor, const std::string& where);
  /// Measured and true images. @param view  of the sensor's camera; its images may be taken over
  RangeImage (*measure)(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                        const Draw& draw);
  /// predicted_sigma() of a sensor with noise.
  double (*predicted_sigma)(const Sensor& sensor, double distance, double incidence, double albedo);

  enum class Image {
    pinhole,  ///< a pixel's point lies on its ray
    profiles  ///< rows are profiles of a scan: Scan::profiles of them
  } image = Image::pinhole;
  // The devices beside the camera's lens whose settings and places it uses.
  bool imager = false;
  bool projector = false;
  bool laser = false;     ///< and Scan
  bool fidelity = false;  ///< it has both
  bool indirect = false;  ///< it sees light that met other surfaces
  int bounces = 0;        ///< Sensor::bounces unless given
  bool exact = false;     ///< it measures the truth: without noise, with true normals
  /// Turns depths or points that `device` measured into those that it reports with the calibration of `believed`. None:
  /// the range along a pixel's ray stays.
  void (*report)(RangeImage& image, const Sensor& device, const Sensor& believed) = nullptr;
};

/// In the order of messages and reference.
const std::vector<const SensorModel*>& sensor_models();
/// The model of that name. Throws an input Error for an unknown name.
const SensorModel& sensor_model(const std::string& name);
/// Adds a model, which must live until the end of the program. Call it before the first request is read and from one
/// thread only, for instance in the initialiser of a constant. Returns true; throws an input Error if the name exists.
bool register_sensor_model(const SensorModel& model);

/// The light that a sensor's model uses beside the camera: "projector" and "laser" with their poses, resolved().
std::vector<std::pair<const char*, Pose>> light_of(const Sensor& sensor);

/// Throws an input Error for the first key of a sensor that is impossible.
void check_sensors(const std::vector<Sensor>& sensors);

}  // namespace bin_scenes
