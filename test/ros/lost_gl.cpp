/// To be preloaded: loses the OpenGL context that is current once the file $LOSE_GL is there, as a driver does that was
/// reset. A context made afterwards is whole. Stands before libepoxy's pointers of the same names.
#include <EGL/egl.h>
#include <GL/glcorearb.h>

#include <unistd.h>
#include <cstdlib>

namespace {

EGLContext lost_context = EGL_NO_CONTEXT;

bool lost() {
  return lost_context != EGL_NO_CONTEXT && eglGetCurrentContext() == lost_context;
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

GLenum client_wait_sync(GLsync sync, GLbitfield flags, GLuint64 timeout) {
  static const auto wait = real<PFNGLCLIENTWAITSYNCPROC>("glClientWaitSync");
  const char* file = std::getenv("LOSE_GL");
  if (file && unlink(file) == 0) lost_context = eglGetCurrentContext();
  return lost() ? static_cast<GLenum>(GL_WAIT_FAILED) : wait(sync, flags, timeout);
}

GLenum graphics_reset_status() {
  static const auto status = real<PFNGLGETGRAPHICSRESETSTATUSPROC>("glGetGraphicsResetStatus");
  return lost() ? static_cast<GLenum>(GL_UNKNOWN_CONTEXT_RESET) : status();
}

}  // namespace

extern "C" {
__attribute__((visibility("default"))) PFNGLCLIENTWAITSYNCPROC epoxy_glClientWaitSync = client_wait_sync;
__attribute__((visibility("default"))) PFNGLGETGRAPHICSRESETSTATUSPROC epoxy_glGetGraphicsResetStatus =
    graphics_reset_status;
}
