// In place of cad_occt.cpp where OpenCASCADE is not installed.
#include "cad.hpp"

namespace bin_scenes {

bool reads_cad() {
  return false;
}

cad::Solids cad::read_here(const std::string&, const std::string& format, const LoadOptions&) {
  Solids none;
  none.complaint = "this build does not read " + format;
  return none;
}

}  // namespace bin_scenes
