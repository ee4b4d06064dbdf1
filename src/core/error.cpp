#include "bin_scenes/core/error.hpp"

namespace bin_scenes {

namespace {
std::string sentence(const std::string& what, const std::string& where, const std::string& remedy) {
  std::string text = where.empty() ? what : where + ": " + what;
  if (!remedy.empty()) text += " (" + remedy + ")";
  return text;
}
}  // namespace

Error::Error(ErrorKind kind, const std::string& what, const std::string& where, const std::string& remedy)
    : std::runtime_error(sentence(what, where, remedy)), kind_(kind), problem_(what), where_(where), remedy_(remedy) {}

}  // namespace bin_scenes
