#include "bin_scenes/scene/scene.hpp"

#include "bin_scenes/scene/lift_proof.hpp"

namespace bin_scenes {

const char* name_of(PartState state) {
  switch (state) {
    case PartState::resting:
      return "resting";
    case PartState::moving:
      return "moving";
    case PartState::escaped:
      return "escaped";
    case PartState::fixed:
      return "fixed";
    case PartState::not_poured:
      return "not_poured";
    case PartState::removed:
      return "removed";
  }
  return "?";
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
