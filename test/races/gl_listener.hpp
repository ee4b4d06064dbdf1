/// Stands between the product and OpenGL: sees the sources of programs, and each dispatch before the device does.
/// libepoxy calls OpenGL through pointers; a listener puts its own functions there for as long as it lives.
#pragma once

#include "races/module.hpp"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace bin_scenes::races {

struct Pass {
  std::string name;  ///< label of the program, with what it was compiled for in brackets
  std::shared_ptr<const Module> module;
};

/// One at a time. Programs must be made while it lives; the cache of their binaries is off meanwhile.
class GlListener {
 public:
  using Groups = std::array<Word, 3>;

  explicit GlListener(Optimise optimise);
  virtual ~GlListener();
  GlListener(const GlListener&) = delete;
  GlListener& operator=(const GlListener&) = delete;

  // What OpenGL is asked for; the functions at the pointers of libepoxy call these.
  void take_source(unsigned shader, const std::string& text) { sources_[shader] = text; }
  void attach(unsigned program, unsigned shader) { programs_[program] = sources_[shader]; }
  virtual void take_barrier(unsigned /*bits*/) {}
  /// The numbers of groups of the next dispatch are about to be read from this place of a buffer.
  virtual void take_arguments(unsigned /*buffer*/, std::size_t /*offset*/) {}
  /// A dispatch of at least one group; it happens on the device when `issue` is called. Called while watching() only.
  virtual void take_dispatch(const Groups& groups, const std::function<void()>& issue) = 0;
  bool watching() const { return watching_; }

 protected:
  void watch(bool on) { watching_ = on; }
  Pass current_pass();
  /// The text that the driver compiled for the program in use.
  const std::string& current_source() const;
  /// Bits of the uniforms of the program in use.
  static std::map<std::string, Word> uniforms_of(const Pass& pass);
  /// Name of the buffer that is bound to a variable.
  static unsigned bound_to(const Pass& pass, const BufferVariable& variable);
  static std::vector<Word> contents_of(unsigned buffer);
  /// What the device has written so far can be read.
  static void wait_for_device();

 private:
  const Optimise optimise_;
  bool watching_ = false;
  std::map<unsigned, std::string> sources_, programs_;
  std::map<std::string, Pass> passes_;  ///< by source
};

}  // namespace bin_scenes::races
