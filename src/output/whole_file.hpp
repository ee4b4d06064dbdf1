/// A file that is written in pieces and appears either complete or not at all. The pieces go to a temporary file in the
/// same folder, which commit() renames. If the object is destroyed without commit(), nothing remains.
#pragma once

#include "bin_scenes/core/temporary.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace bin_scenes {

/// If a piece cannot be written, an environment Error that names the file is thrown.
class WholeFile {
 public:
  explicit WholeFile(const std::string& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void append(const void* data, std::size_t size);
  std::uint64_t size() const { return size_; }
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::string path_;
  Temporary temporary_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

}  // namespace bin_scenes
