/// The one exception of the library. Loading and set-up throw it; a running simulation sets flags in the report
/// instead (scene/report.hpp); misuse of an interface asserts (core/assertion.hpp).
#pragma once

#include <stdexcept>
#include <string>

namespace bin_scenes {

/// Who has to act. The values are the exit codes of the command line (2 and 3) and map to the ROS error codes.
enum class ErrorKind {
  input = 2,        ///< the request or a file it names is wrong: correct the input
  environment = 3,  ///< no GL device, disk full, directory not writable: repair the machine
  cancelled = 4,    ///< the caller asked to stop
};

/// One clear message: what is wrong, where it is (file, key, line), and how to correct it. what() is one printable line
/// below 1 kB, whatever a file put into it; problem(), where() and remedy() are as they were given.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& what, const std::string& where, const std::string& remedy);

  ErrorKind kind() const { return kind_; }
  const std::string& problem() const { return problem_; }
  const std::string& where() const { return where_; }
  const std::string& remedy() const { return remedy_; }

 private:
  ErrorKind kind_;
  std::string problem_, where_, remedy_;
};

inline Error input_error(const std::string& what, const std::string& where, const std::string& remedy) {
  return {ErrorKind::input, what, where, remedy};
}
inline Error environment_error(const std::string& what, const std::string& where, const std::string& remedy) {
  return {ErrorKind::environment, what, where, remedy};
}

}  // namespace bin_scenes
