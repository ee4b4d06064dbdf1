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
  /// One model a part line, equal ones shared; sizes checked against the bin. Of the models that this request does not
  /// use, the last few are kept, for requests that take turns; memory does not grow with the number of requests.
  void load(const Request& request);

  const std::vector<PartModelPtr>& parts() const { return parts_; }
  const PartModelPtr& bin() const { return bin_; }

 private:
  static constexpr std::size_t most_unused = 8;  ///< models
  void keep(std::map<std::string, PartModelPtr>&& used);

  std::map<std::string, PartModelPtr> models_;
  std::vector<std::string> order_;  ///< keys of models_, those used last at the end
  std::vector<PartModelPtr> parts_;
  PartModelPtr bin_;
};

}  // namespace bin_scenes
