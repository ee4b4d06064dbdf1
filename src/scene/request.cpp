#include "bin_scenes/scene/request.hpp"

#include "bin_scenes/core/error.hpp"

namespace bin_scenes {

double metres_per(Unit unit) {
  switch (unit) {
    case Unit::metre: return 1.0;
    case Unit::centimetre: return 1e-2;
    case Unit::millimetre: return 1e-3;
    case Unit::inch: return 0.0254;
  }
  return 1.0;
}

const char* name_of(Unit unit) {
  switch (unit) {
    case Unit::metre: return "m";
    case Unit::centimetre: return "cm";
    case Unit::millimetre: return "mm";
    case Unit::inch: return "inch";
  }
  return "?";
}

const char* name_of(SolverType type) {
  switch (type) {
    case SolverType::automatic: return "auto";
    case SolverType::sphere: return "sphere";
    case SolverType::bullet: return "bullet";
  }
  return "?";
}

std::size_t Request::part_count() const {
  std::size_t n = 0;
  for (const PartLine& line : parts) n += line.count;
  return n;
}

}  // namespace bin_scenes
