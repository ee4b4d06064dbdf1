/// A heap of small boxes in a small bin.
#pragma once

#include "solver/lab.hpp"

namespace bin_scenes::testing {

inline PartModelPtr small_box() {
  static const PartModelPtr part = PartModel::from_mesh(box_mesh({0.05, 0.03, 0.02}), "box");
  return part;
}

inline Request request_of(std::size_t count) {
  Request request;
  request.seed = 0;
  request.bin.inner_size = Vec3(0.2, 0.15, 0.12);
  PartLine line;
  line.model = "box";
  line.count = count;
  request.parts.push_back(line);
  return request;
}

}  // namespace bin_scenes::testing
