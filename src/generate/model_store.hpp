/// Models of requests, kept in memory between them.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/scene/request.hpp"

#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

class ModelStore {
 public:
  /// One model a part line, equal ones shared; sizes checked against the bin. Models of earlier requests that this
  /// one does not use are let go: memory does not grow with the number of requests.
  void load(const Request& request);

  const std::vector<PartModelPtr>& parts() const { return parts_; }
  const PartModelPtr& bin() const { return bin_; }

 private:
  std::map<std::string, PartModelPtr> models_;
  std::vector<PartModelPtr> parts_;
  PartModelPtr bin_;
};

}  // namespace bin_scenes
