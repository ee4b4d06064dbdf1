#include "bin_scenes/sensor/sensor_model.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/image_settings.hpp"

namespace bin_scenes {

std::vector<const SensorModel*> built_in_sensor_models();  // made by CMake

namespace {

std::vector<const SensorModel*>& all_models() {
  static std::vector<const SensorModel*> models = built_in_sensor_models();
  return models;
}

}  // namespace

const std::vector<const SensorModel*>& sensor_models() {
  return all_models();
}

const SensorModel& sensor_model(const std::string& name) {
  std::string known;
  for (const SensorModel* model : sensor_models()) {
    if (name == model->name) return *model;
    known += (known.empty() ? "" : ", ") + std::string(model->name);
  }
  throw input_error("there is no sensor model '" + name + "'", "sensors[].model", "use one of " + known);
}

bool register_sensor_model(const SensorModel& model) {
  BIN_SCENES_ASSERT(model.name && *model.name && model.measure && model.predicted_sigma);
  for (const SensorModel* other : all_models()) {
    if (std::string(model.name) == other->name)
      throw input_error("a sensor model '" + std::string(model.name) + "' exists already", "register_sensor_model",
                        "choose another name");
  }
  all_models().push_back(&model);
  return true;
}

std::vector<std::pair<const char*, Pose>> light_of(const Sensor& sensor) {
  const SensorModel& model = sensor_model(sensor.model);
  std::vector<std::pair<const char*, Pose>> light;
  if (model.projector && sensor.projector.pose) light.emplace_back("projector", *sensor.projector.pose);
  if (model.laser && sensor.laser.pose) light.emplace_back("laser", *sensor.laser.pose);
  if (sensor.model != "image") return light;
  for (const ImageLamp& lamp : sensor.settings.of<ImageSettings>().lamps) {
    const bool flat = lamp.type == ImageLamp::Type::area || lamp.type == ImageLamp::Type::ring;
    if (flat && lamp.pose) light.emplace_back("lamp", *lamp.pose);
    if (lamp.type == ImageLamp::Type::projector && sensor.projector.pose)
      light.emplace_back("projector", *sensor.projector.pose);
  }
  return light;
}

}  // namespace bin_scenes
