/// Settings of sensor models by their type, so that a sensor holds those of models it does not know.
#pragma once

#include <any>
#include <map>
#include <typeindex>

namespace bin_scenes {

class ModelSettings {
 public:
  /// Made with its defaults when it is asked for first.
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
