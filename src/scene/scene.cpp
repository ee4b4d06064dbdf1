#include "bin_scenes/scene/scene.hpp"

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

}  // namespace bin_scenes
