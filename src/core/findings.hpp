/// The errors that a check of files has found, with the number of checks that were made. The checks of data sets
/// collect their results here from several threads. The list is sorted for output, so that it does not depend on the
/// order of the threads.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace bin_scenes {

struct Finding {
  std::string check, where, text;
};

/// A list of findings to which several threads may add.
class Findings {
 public:
  /// Counts a check, and adds a finding if `holds` is false. Returns `holds`.
  bool expect(bool holds, const char* check, const std::string& where, const std::string& text);
  std::vector<Finding> sorted() const;
  std::map<std::string, std::size_t> checked() const { return checked_; }

 private:
  std::mutex mutex_;
  std::vector<Finding> all_;
  std::map<std::string, std::size_t> checked_;  ///< how often each check was made, by its name
};

}  // namespace bin_scenes
