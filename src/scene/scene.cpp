#include "bin_scenes/scene/scene.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/scene/lift_proof.hpp"
#include "scene/report_keys.hpp"

#include <iterator>

namespace bin_scenes {

const char* name_of(ContactAction action) {
  static const char* const names[] = {"resting", "sliding", "pushed apart", "impact"};
  BIN_SCENES_ASSERT(static_cast<std::size_t>(action) < std::size(names));
  return names[static_cast<std::size_t>(action)];
}

const char* name_of(PartState state) {
  return name_in_table(state);
}

const char* name_of(LiftProof::Outcome outcome) {
  switch (outcome) {
    case LiftProof::Outcome::lifted:
      return "lifted";
    case LiftProof::Outcome::missed:
      return "missed";
    case LiftProof::Outcome::slipped:
      return "slipped";
    case LiftProof::Outcome::jammed:
      return "jammed";
    case LiftProof::Outcome::dragged:
      return "dragged";
  }
  return "?";
}

}  // namespace bin_scenes
