/// Programs from shader files, and the dispatch of compute passes.
///
/// A shader file contains no #version: the loader puts `#version 450 core` and the defines in
/// front, and replaces `#include "shared/x.h"` (path below the shader directory, each file at most once).
/// Linked binaries are kept in $XDG_CACHE_HOME/bin_scenes/programs, keyed by driver and source; a file that is
/// damaged or refused by the driver is compiled anew.
#pragma once

#include "bin_scenes/gl/buffer.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes::gl {

using Defines = std::vector<std::pair<std::string, std::string>>;

/// BIN_SCENES_SHADERS, else the directory of the build or installation, else share/bin_scenes/shaders one or two
/// directories above the executable's. Throws an environment Error that lists them if none exists.
std::string shader_directory();

class Program {
 public:
  Program() = default;
  /// `file` below the shader directory, e.g. "thesis/detect.comp". Throws an environment Error with the compiler's
  /// message, file and line.
  static Program compute(const std::string& file, const Defines& defines = {});
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  void use() const;
  void set(const char* uniform, int value) const;
  void set(const char* uniform, unsigned value) const;
  void set(const char* uniform, float value) const;

  const std::string& name() const { return name_; }  ///< file name without directory and extension
  unsigned id() const { return id_; }
  unsigned group_size() const { return group_size_; }  ///< invocations per group along x
  bool from_cache() const { return from_cache_; }

 private:
  static Program link(const std::string& name, const std::vector<std::pair<unsigned, std::string>>& stages,
                      const Defines& defines);
  int location(const char* uniform) const;

  unsigned id_ = 0;
  unsigned group_size_ = 0;
  bool from_cache_ = false;
  std::string name_;
  mutable std::map<std::string, int> locations_;
};

/// What later commands wait for. The default, `all`, is always safe.
enum class Barrier {
  storage,    ///< later passes see what this one wrote
  arguments,  ///< the same, and their numbers of groups: a GPU's front end waits until the pass has ended
  none,       ///< the next pass touches nothing this one wrote
  all         ///< also rendering, textures, copies and read-backs through the API
};
void barrier(Barrier kind = Barrier::all);

/// An axis takes at most 65,535 groups; more are folded into y. The shader computes its index with thread_index() or
/// group_index() of shared/dispatch.h and checks its bound itself. With 0 groups nothing is dispatched.
std::array<unsigned, 2> folded_groups(std::size_t groups);
void dispatch_groups(const Program& program, std::size_t groups, Barrier after = Barrier::storage);
/// Enough groups for one invocation per item.
void dispatch(const Program& program, std::size_t items, Barrier after = Barrier::storage);
/// Group counts (three words) lie in `arguments` at `offset` bytes; see folded_groups() of shared/dispatch.h.
void dispatch_indirect(const Program& program, const Storage& arguments, std::size_t offset = 0,
                       Barrier after = Barrier::storage);

}  // namespace bin_scenes::gl
