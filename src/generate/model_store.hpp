/// Keeps the models of requests in memory between requests, so that a model is loaded once. The disk cache
/// (core/cache.hpp) works below it.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"

#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

class ModelStore {
 public:
  /// Loads one model for each part line; equal ones are shared. Sizes are compared with the bin. The last few models
  /// that the present request does not use are kept, for requests that alternate. Memory does not grow with the number
  /// of requests.
  void load(const Request& request);

  const LoadedRequest& loaded() const { return loaded_; }  ///< the last one

 private:
  static constexpr std::size_t most_unused = 8;  ///< models
  void keep(std::map<std::string, PartModelPtr>&& used);

  std::map<std::string, PartModelPtr> models_;
  std::vector<std::string> order_;  ///< keys of models_, those used last at the end
  LoadedRequest loaded_;
};

}  // namespace bin_scenes
