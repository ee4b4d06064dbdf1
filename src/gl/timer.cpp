#include "bin_scenes/gl/timer.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <epoxy/gl.h>

namespace bin_scenes::gl {

Timer::~Timer() {
  for (const Pair& pair : open_) free_.insert(free_.end(), {pair.begin, pair.end});
  for (unsigned id : free_)
    if (id) glDeleteQueries(1, &id);
}

unsigned Timer::query() {
  unsigned id = 0;
  if (free_.empty()) {
    glCreateQueries(GL_TIMESTAMP, 1, &id);
  } else {
    id = free_.back();
    free_.pop_back();
  }
  return id;
}

void Timer::begin(const std::string& stage) {
  glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, static_cast<GLsizei>(stage.size()), stage.data());
  BIN_SCENES_ASSERT(open_.empty() || open_.back().end);  // stages do not nest
  open_.push_back({stage, query(), 0});
  glQueryCounter(open_.back().begin, GL_TIMESTAMP);
}

void Timer::end() {
  BIN_SCENES_ASSERT(!open_.empty() && !open_.back().end);
  open_.back().end = query();
  glQueryCounter(open_.back().end, GL_TIMESTAMP);
  glPopDebugGroup();
}

void Timer::collect(Profile& profile, bool wait) {
  while (!open_.empty() && open_.front().end) {
    const Pair& pair = open_.front();
    GLint done = GL_TRUE;
    if (!wait) glGetQueryObjectiv(pair.end, GL_QUERY_RESULT_AVAILABLE, &done);
    if (!done) return;
    GLuint64 begin = 0, end = 0;
    glGetQueryObjectui64v(pair.begin, GL_QUERY_RESULT, &begin);
    glGetQueryObjectui64v(pair.end, GL_QUERY_RESULT, &end);
    profile.add(pair.stage, 1e-6 * static_cast<double>(end - begin));
    free_.insert(free_.end(), {pair.begin, pair.end});
    open_.pop_front();
  }
}

}  // namespace bin_scenes::gl
