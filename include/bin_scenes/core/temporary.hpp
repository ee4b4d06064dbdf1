/// Files and directories that appear complete or not at all. Once they have appeared they survive a loss of power, and
/// leftovers of killed processes are removed by later ones.
#pragma once

#include <cstddef>
#include <string>

namespace bin_scenes {

/// A file or directory that appears under its name only when it is complete: work on path(), then call commit(), which
/// replaces an existing file of that name. Destroyed without commit(), it leaves nothing behind.
///
/// Until then it is hidden beside its target as .NAME.tmp-PID-NUMBER@HOST, so that processes of several hosts can share
/// a directory. remove_leftovers() removes what a killed process left.
class Temporary {
 public:
  explicit Temporary(const std::string& target);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const std::string& path() const { return path_; }
  /// Contents are on the disk before the name changes, and the name before this returns; what lies in a directory that
  /// is itself temporary gets there with it. Throws an environment Error.
  void commit();

 private:
  std::string target_, path_;
};

/// Removes temporaries in `directory` whose writer ran on this host and runs no more. Those of other hosts are not
/// touched: this host cannot know whether they are still being written. Returns how many.
std::size_t remove_leftovers(const std::string& directory);

}  // namespace bin_scenes
