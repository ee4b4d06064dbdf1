/// Published figures of data sets of real bins, beside the same figures of a simulated data set: number of parts,
/// visible fraction, distance and missing depth. The report of a data set shows them as a table. Each published figure
/// states its source.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

/// Adds up what summaries of scenes state (dataset/record.hpp).
class Seen {
 public:
  void add(const nlohmann::json& summary);
  /// Rows of what, here, published, source.
  nlohmann::json rows() const;

 private:
  struct BySensor {
    std::size_t images = 0, instances = 0;
    double near = 0.0, far = 0.0;  ///< m
    std::array<std::size_t, 3> holes{};
  };
  std::map<std::string, BySensor> sensors_;
  std::size_t least_ = 0, most_ = 0, scenes_ = 0;  ///< parts of a scene
  std::vector<std::size_t> visible_;               ///< twentieths of visible fraction
};

}  // namespace bin_scenes
