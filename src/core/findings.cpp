#include "core/findings.hpp"

#include <algorithm>
#include <tuple>

namespace bin_scenes {

bool Findings::expect(bool holds, const char* check, const std::string& where, const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++checked_[check];
  if (!holds) all_.push_back({check, where, text});
  return holds;
}

std::vector<Finding> Findings::sorted() const {
  std::vector<Finding> all = all_;
  std::sort(all.begin(), all.end(), [](const Finding& a, const Finding& b) {
    return std::tie(a.where, a.check, a.text) < std::tie(b.where, b.check, b.text);
  });
  return all;
}

}  // namespace bin_scenes
