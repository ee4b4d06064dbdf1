/// Compares published values of data sets of real bins with those of a simulated data set: number of parts, visible
/// fraction, distance, and share of parts with missing depth. The report of a data set shows them as a table, in which
/// each published value states its source.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

/// Adds up the summaries of scenes (dataset/record.hpp) to compare them with the published figures.
class Seen {
 public:
  void add(const nlohmann::json& summary);
  /// Returns the rows of the table: name of the figure, its value here, the published value, and the source.
  nlohmann::json rows() const;

 private:
  struct BySensor {
    std::size_t images = 0, instances = 0;  ///< number of images, and of parts that are visible in them
    double near = 0.0, far = 0.0;           ///< least and greatest depth of these parts (m)
    std::array<std::size_t, 3> holes{};     ///< parts by share of visible pixels with depth: < 0.9, <= 0.99, more
  };
  std::map<std::string, BySensor> sensors_;
  std::size_t least_ = 0, most_ = 0, scenes_ = 0;  ///< least and most parts of a scene; number of scenes
  std::vector<std::size_t> visible_;               ///< histogram of the visible fraction in steps of 1/20
};

}  // namespace bin_scenes
