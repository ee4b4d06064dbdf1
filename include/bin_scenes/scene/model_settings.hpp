/// Settings of sensor models, stored by their type, so that Sensor can hold the settings of any model without including
/// its header.
#pragma once

#include <any>
#include <map>
#include <typeindex>

namespace bin_scenes {

class ModelSettings {
 public:
  /// The settings of that type; the first call makes them with their defaults.
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
