/// A container for the settings of sensor models, stored by their type. Through it, Sensor (scene/request.hpp) holds
/// the settings of any model, also of models in other programs, without including their headers.
#pragma once

#include <any>
#include <map>
#include <typeindex>

namespace bin_scenes {

/// At most one object for each type of settings.
class ModelSettings {
 public:
  /// Returns the settings of this type. The first call creates them with their default values; the const form returns
  /// the defaults if none were set.
  template <class Settings>
  Settings& of() {
    std::any& found = all_[typeid(Settings)];
    if (!found.has_value()) found = Settings();
    return std::any_cast<Settings&>(found);
  }
  template <class Settings>
  const Settings& of() const {
    static const Settings defaults;
    const auto found = all_.find(typeid(Settings));
    return found == all_.end() ? defaults : std::any_cast<const Settings&>(found->second);
  }

 private:
  std::map<std::type_index, std::any> all_;
};

}  // namespace bin_scenes
