#include "scene_stream.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <utility>

namespace bin_scenes::python {

SceneStream::SceneStream(std::shared_ptr<Session> session, const Request& request, std::size_t ahead,
                         const Wanted& wanted)
    : session_(std::move(session)), state_(std::make_shared<State>()) {
  const Generator::Options chosen = options_of(wanted, request, "Generator.generate");
  const auto make = [=, state = state_](Session& own) {
    std::shared_ptr<const LoadedRequest> loaded;
    Generator::Options options = chosen;
    options.hooks = own.hooks();
    const CancelScope scope(options.hooks.cancel);
    own.generator().generate(request, options, [&](Generator::Result&& result) {
      if (!loaded) loaded = std::make_shared<LoadedRequest>(own.generator().loaded());
      auto scene = std::make_shared<SceneData>(std::move(result), loaded);
      std::unique_lock<std::mutex> lock(own.mutex());
      state->ready.push_back(std::move(scene));
      own.changed().notify_all();
      own.changed().wait(lock, [&] {
        return own.cancelled() || state->ready.size() < ahead || (state->ready.empty() && state->wanted);
      });
      stop_if_cancelled();
    });
  };
  job_ = session_->start("Generator.generate", [make, state = state_](Session& own) {
    try {
      make(own);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(own.mutex());
      state->failed = std::current_exception();
    }
  });
}

std::shared_ptr<SceneData> SceneStream::next(const Poll& poll) {
  session_->refuse_if_closed("Generator.generate");
  State& state = *state_;
  {
    const std::lock_guard<std::mutex> lock(session_->mutex());
    if (stopped_) return nullptr;
    if (state.wanted) {
      throw input_error("another thread waits for the next of these scenes", "Generator.generate",
                        "let one thread ask, or make a Generator for each thread");
    }
    state.wanted = true;
    session_->changed().notify_all();
  }
  std::exception_ptr failed;
  try {
    session_->wait(
        job_, [&] { return !state.ready.empty(); }, poll);
  } catch (...) {
    failed = std::current_exception();
  }
  std::shared_ptr<SceneData> scene;
  {
    const std::lock_guard<std::mutex> lock(session_->mutex());
    state.wanted = false;
    if (!failed && !state.ready.empty()) {
      scene = std::move(state.ready.front());
      state.ready.pop_front();
      session_->changed().notify_all();
      return scene;
    }
    if (!failed) failed = std::exchange(state.failed, nullptr);
    stopped_ = true;
    state.ready.clear();
  }
  session_->refuse_if_closed("Generator.generate");  // close() is why it was cancelled
  if (failed) std::rethrow_exception(failed);
  return nullptr;
}

void SceneStream::stop() {
  try {
    session_->refuse_if_closed("");  // then there is nothing to stop
  } catch (const Error&) {
    return;
  }
  session_->cancel(job_);
  session_->wait(
      job_, [] { return false; }, [] {});
  const std::lock_guard<std::mutex> lock(session_->mutex());
  stopped_ = true;
  state_->ready.clear();
  state_->failed = nullptr;
}

std::size_t SceneStream::ready() const {
  session_->refuse_if_closed("Scenes.ready");
  const std::lock_guard<std::mutex> lock(session_->mutex());
  return state_->ready.size();
}

}  // namespace bin_scenes::python
