#include "bin_scenes/gl/raster.hpp"

#include "bin_scenes/core/error.hpp"

#include <epoxy/gl.h>

#include <limits>
#include <string>

namespace bin_scenes::gl {

Triangles::Triangles(const std::vector<float>& corners) : count_(static_cast<int>(corners.size() / 6)) {
  const float nothing[6] = {};
  glCreateBuffers(1, &buffer_);
  glNamedBufferStorage(buffer_,
                       static_cast<GLsizeiptr>(corners.empty() ? sizeof nothing : corners.size() * sizeof(float)),
                       corners.empty() ? nothing : corners.data(), 0);
  glCreateVertexArrays(1, &array_);
  glVertexArrayVertexBuffer(array_, 0, buffer_, 0, 6 * sizeof(float));
  for (unsigned attribute = 0; attribute < 2; ++attribute) {
    glEnableVertexArrayAttrib(array_, attribute);
    glVertexArrayAttribFormat(array_, attribute, 3, GL_FLOAT, GL_FALSE, attribute * 3 * sizeof(float));
    glVertexArrayAttribBinding(array_, attribute, 0);
  }
}

Triangles::~Triangles() {
  glDeleteVertexArrays(1, &array_);
  glDeleteBuffers(1, &buffer_);
}

void Triangles::draw() const {
  glBindVertexArray(array_);
  glDrawArrays(GL_TRIANGLES, 0, count_);
  glBindVertexArray(0);
}

Target::Target(int width, int height, const std::vector<Channel>& channels)
    : width_(width), height_(height), channels_(channels), buffers_(channels.size() + 1) {
  glCreateFramebuffers(1, &frame_);
  glCreateRenderbuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  std::vector<GLenum> outputs;
  const auto attach = [&](unsigned buffer, GLenum format, GLenum point) {
    glNamedRenderbufferStorage(buffer, format, width, height);
    glNamedFramebufferRenderbuffer(frame_, point, GL_RENDERBUFFER, buffer);
  };
  for (std::size_t i = 0; i < channels.size(); ++i) {
    outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
    const GLenum format = channels[i] == Channel::float1   ? GL_R32F
                          : channels[i] == Channel::float4 ? GL_RGBA32F
                                                           : GL_R16UI;
    attach(buffers_[i], format, outputs.back());
  }
  attach(buffers_.back(), GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL_ATTACHMENT);
  glNamedFramebufferDrawBuffers(frame_, static_cast<GLsizei>(outputs.size()), outputs.data());
  if (glCheckNamedFramebufferStatus(frame_, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    release();
    throw environment_error(
        "no image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels can be rendered",
        "GL framebuffer", "ask for a smaller image or use another GL device (bin_scenes doctor)");
  }
}

Target::~Target() {
  release();
}

void Target::release() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
  glDeleteFramebuffers(1, &frame_);
  glDeleteRenderbuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
}

void Target::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, width_, height_);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float unseen[4] = {nan, nan, nan, nan};
  const GLuint zero[4] = {0, 0, 0, 0};
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i] == Channel::uint16) {
      glClearNamedFramebufferuiv(frame_, GL_COLOR, static_cast<GLint>(i), zero);
    } else {
      glClearNamedFramebufferfv(frame_, GL_COLOR, static_cast<GLint>(i), unseen);
    }
  }
  glClearNamedFramebufferfi(frame_, GL_DEPTH_STENCIL, 0, 0.0f, 0);
}

void Target::read(int channel, float* to) const {
  glNamedFramebufferReadBuffer(frame_, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(channel));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  glReadPixels(0, 0, width_, height_, channels_[channel] == Channel::float1 ? GL_RED : GL_RGBA, GL_FLOAT, to);
}

void Target::read(int channel, std::uint16_t* to) const {
  glNamedFramebufferReadBuffer(frame_, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(channel));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RED_INTEGER, GL_UNSIGNED_SHORT, to);
}

void Target::begin_counting() {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_REPLACE, GL_REPLACE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  mark_ = 255;
}

void Target::begin_count() {
  // A mark of its own in the stencil lets every pixel pass once; after the last mark the stencil starts anew.
  if (++mark_ > 255) {
    glClearNamedFramebufferfi(frame_, GL_DEPTH_STENCIL, 0, 0.0f, 0);
    mark_ = 1;
  }
  glStencilFunc(GL_NOTEQUAL, mark_, 0xff);
  queries_.emplace_back();
  glCreateQueries(GL_SAMPLES_PASSED, 1, &queries_.back());
  glBeginQuery(GL_SAMPLES_PASSED, queries_.back());
}

void Target::end_count() {
  glEndQuery(GL_SAMPLES_PASSED);
}

std::vector<std::size_t> Target::counts() {
  std::vector<std::size_t> counts;
  for (const unsigned query : queries_) {
    GLuint64 passed = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &passed);
    counts.push_back(passed);
  }
  return counts;
}

}  // namespace bin_scenes::gl
