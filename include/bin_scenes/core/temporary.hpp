/// Files and directories that appear either complete or not at all. Output files, data sets and the disk cache are
/// written in this manner. What has appeared survives a loss of power, and what a killed process left behind is removed
/// by later processes.
#pragma once

#include <cstddef>
#include <string>

namespace bin_scenes {

/// A file or directory that appears under its name only when it is complete. The caller writes to path() and then calls
/// commit(), which replaces an existing file of that name. If a Temporary is destroyed without commit(), nothing
/// remains on the disk.
///
/// Before commit(), the file is hidden beside its target as .NAME.tmp-PID-NUMBER@HOST, so that processes of several
/// hosts can share a directory. remove_leftovers() removes the files of killed processes.
class Temporary {
 public:
  explicit Temporary(const std::string& target);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const std::string& path() const { return path_; }
  /// Gives the file its final name. The contents are on the disk before the name changes, and the name is on the disk
  /// before this function returns. Files within a directory that is itself a Temporary are written to the disk by the
  /// commit() of that directory. Throws an environment Error.
  void commit();

 private:
  std::string target_, path_;
};

/// Removes temporary files in `directory` whose writer was a process of this host that no longer runs. Files of other
/// hosts are not touched, because this host cannot know whether they are still being written. Returns the number of
/// files removed.
std::size_t remove_leftovers(const std::string& directory);

}  // namespace bin_scenes
