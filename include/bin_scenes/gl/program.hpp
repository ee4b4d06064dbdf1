/// Programs that are compiled from shader files, and the dispatch of compute passes.
///
/// A shader file contains no #version line. The loader puts `#version 450 core` and the definitions in front and
/// replaces `#include "shared/x.h"` (a path below the shader directory; each file is included at most once). Linked
/// programs are stored in $XDG_CACHE_HOME/bin_scenes/programs under a key of driver and source. A stored file that is
/// damaged, or that the driver refuses, is compiled again.
#pragma once

#include "bin_scenes/gl/buffer.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes::gl {

using Defines = std::vector<std::pair<std::string, std::string>>;

/// Returns the directory of the shaders: $BIN_SCENES_SHADERS if it is set, otherwise the directory of the build or
/// installation, otherwise share/bin_scenes/shaders one or two directories above that of the executable. Throws an
/// environment Error that lists these directories if none exists.
std::string shader_directory();

/// One linked compute program. The default-constructed object holds none.
class Program {
 public:
  Program() = default;
  /// Compiles `file`, a path below the shader directory such as "thesis/detect.comp". Throws an environment Error with
  /// the message of the compiler, file and line.
  static Program compute(const std::string& file, const Defines& defines = {});
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  void use() const;
  void set(const char* uniform, int value) const;
  void set(const char* uniform, unsigned value) const;
  void set(const char* uniform, float value) const;

  unsigned id() const { return id_; }
  unsigned group_size() const { return group_size_; }  ///< invocations per group along x
  /// Whether the program was read from the disk instead of being compiled.
  bool from_cache() const { return from_cache_; }

 private:
  static Program link(const std::string& name, const std::vector<std::pair<unsigned, std::string>>& stages,
                      const Defines& defines);
  int location(const char* uniform) const;

  unsigned id_ = 0;
  unsigned group_size_ = 0;
  bool from_cache_ = false;
  mutable std::map<std::string, int> locations_;
};

/// Which later commands wait for a pass. The default, `all`, is always safe.
enum class Barrier {
  storage,    ///< later passes see what this pass wrote
  arguments,  ///< the same, and later passes may take their numbers of groups from what it wrote; the front end of a
              ///< GPU then waits until the pass has ended
  none,       ///< the next pass uses nothing that this pass wrote
  all         ///< also rendering, textures, copies and read-backs through the API
};
void barrier(Barrier kind = Barrier::all);

/// Returns the numbers of groups along x and y. One axis allows at most 65,535 groups; more are folded into y. The
/// shader computes its index with thread_index() or group_index() of shared/dispatch.h and checks the bound itself.
/// With 0 groups, nothing is dispatched.
std::array<unsigned, 2> folded_groups(std::size_t groups);
void dispatch_groups(const Program& program, std::size_t groups, Barrier after = Barrier::storage);
/// Dispatches enough groups for one invocation per item.
void dispatch(const Program& program, std::size_t items, Barrier after = Barrier::storage);
/// Dispatches the numbers of groups (three words) that are stored in `arguments` at `offset` bytes; see folded_groups()
/// of shared/dispatch.h.
void dispatch_indirect(const Program& program, const Storage& arguments, std::size_t offset = 0,
                       Barrier after = Barrier::storage);

}  // namespace bin_scenes::gl
