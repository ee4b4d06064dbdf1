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
  /// Loads one model for each part line; equal models are shared. Throws an input Error if the size of a part is not
  /// plausible for the bin. A few models that the present request does not use are kept, for requests that alternate;
  /// memory does not grow with the number of requests.
  void load(const Request& request);

  const LoadedRequest& loaded() const { return loaded_; }  ///< the last request with its models

 private:
  static constexpr std::size_t most_unused = 8;  ///< number of kept models that the present request does not use
  void keep(std::map<std::string, PartModelPtr>&& used);

  std::map<std::string, PartModelPtr> models_;
  std::vector<std::string> order_;  ///< keys of models_; the most recently used is the last
  LoadedRequest loaded_;
};

}  // namespace bin_scenes
