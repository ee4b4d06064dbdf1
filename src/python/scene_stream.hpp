/// The scenes of a request as a Python iterator. It returns them in order, one by one, while further scenes are made in
/// other threads. Python's `Generator.generate()` returns such a stream.
#pragma once

#include "scene_data.hpp"
#include "session.hpp"

#include <deque>
#include <exception>
#include <memory>
#include <string>

namespace bin_scenes::python {

/// A stream of scenes in the order of their index. A scene depends only on request, seed and index, and not on the
/// number of scenes that are made ahead.
class SceneStream {
 public:
  /// @param ahead  largest number of finished scenes that wait, in addition to those in progress; 0: work pauses unless
  /// next() is waiting
  SceneStream(std::shared_ptr<Session> session, const Request& request, std::size_t ahead, const Wanted& wanted);
  ~SceneStream() { stop(); }
  SceneStream(const SceneStream&) = delete;
  SceneStream& operator=(const SceneStream&) = delete;

  /// Returns the next scene; null after the last one and after stop(). Throws the error that occurred while it was
  /// made, which ends the stream.
  std::shared_ptr<SceneData> next(const Poll& poll);
  /// Cancels the scenes that are being made, and waits until this is done. The scenes that wait are dropped.
  void stop();
  /// Returns the number of scenes that wait now.
  std::size_t ready() const;

 private:
  struct State {
    std::deque<std::shared_ptr<SceneData>> ready;
    std::exception_ptr failed;
    bool wanted = false;  ///< whether a call of next() waits
  };
  std::shared_ptr<Session> session_;
  std::shared_ptr<State> state_;
  std::size_t job_ = 0;
  bool stopped_ = false;
};

}  // namespace bin_scenes::python
