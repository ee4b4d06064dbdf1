#include "meter/watch.hpp"

namespace bin_scenes::meter {

races::Dispatch Taken::dispatch(const races::Module& module, std::vector<races::Memory>& memory) const {
  races::Dispatch out;
  out.module = &module;
  out.groups = groups;
  out.uniforms = uniforms;
  for (const std::size_t index : bound) out.buffers.push_back(&memory[index]);
  return out;
}

Taken Watch::take(const races::Pass& pass, const Groups& groups) const {
  Taken taken{pass.name, current_source(), groups, uniforms_of(pass), {}, {}};
  std::map<unsigned, std::size_t> known;
  for (const races::BufferVariable& variable : pass.module->buffers) {
    const unsigned buffer = bound_to(pass, variable);
    if (known.emplace(buffer, taken.buffers.size()).second)
      taken.buffers.push_back({variable.name, contents_of(buffer), {}});
    taken.bound.push_back(known.at(buffer));
  }
  return taken;
}

void Watch::take_dispatch(const Groups& groups, const std::function<void()>& issue) {
  wait_for_device();
  const races::Pass pass = current_pass();
  Taken taken = take(pass, groups);
  if (on_taken) on_taken(taken, *pass.module);
  measure(taken.dispatch(*pass.module, taken.buffers), card_, passes_[pass.name]);
  issue();
}

}  // namespace bin_scenes::meter
