/// Measures what the product dispatches, pass by pass, whatever passes there are.
#pragma once

#include "meter/meter.hpp"
#include "races/gl_listener.hpp"

#include <functional>
#include <map>
#include <string>

namespace bin_scenes::meter {

/// A dispatch as it can be measured again.
struct Taken {
  std::string pass, source;
  std::array<Word, 3> groups{1, 1, 1};
  std::map<std::string, Word> uniforms;
  std::vector<races::Memory> buffers;  ///< one for each buffer that is bound
  std::vector<std::size_t> bound;      ///< by buffer variable of the module: index into `buffers`

  /// Of `module`, on `memory`, which are copies of `buffers`.
  races::Dispatch dispatch(const races::Module& module, std::vector<races::Memory>& memory) const;
};

class Watch final : public races::GlListener {
 public:
  explicit Watch(const Card& card = {}) : GlListener(races::Optimise::yes), card_(card) {}

  void begin() { watch(true); }
  void end() { watch(false); }
  const std::map<std::string, Counts>& passes() const { return passes_; }
  const Card& card() const { return card_; }

  /// What is called with each dispatch, before it is measured.
  std::function<void(const Taken&, const races::Module&)> on_taken;

  void take_dispatch(const Groups& groups, const std::function<void()>& issue) override;

 private:
  Taken take(const races::Pass& pass, const Groups& groups) const;

  Card card_;
  std::map<std::string, Counts> passes_;
};

}  // namespace bin_scenes::meter
