/// The one exception type of the library. Loading and set-up throw it. A running simulation does not throw it for a
/// poor result but sets flags in the report (scene/report.hpp), and misuse of an interface violates an assertion
/// (core/assertion.hpp).
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

/// An error with one clear message: what is wrong, where it is (file, key, line), and how to correct it. what() returns
/// one printable line of less than 1 kB, whatever characters a file contained; problem(), where() and remedy() return
/// the texts as they were given.
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

/// Shorthands for the two kinds of error that most code throws.
inline Error input_error(const std::string& what, const std::string& where, const std::string& remedy) {
  return {ErrorKind::input, what, where, remedy};
}
inline Error environment_error(const std::string& what, const std::string& where, const std::string& remedy) {
  return {ErrorKind::environment, what, where, remedy};
}

}  // namespace bin_scenes
