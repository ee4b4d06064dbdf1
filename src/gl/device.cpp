/// Chooses an EGL device, hardware first unless software is asked for, makes its context and asks its limits. One
/// context is shared by all users of a process, one thread at a time.
#include "bin_scenes/gl/device.hpp"

#include "bin_scenes/core/error.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace bin_scenes::gl {

namespace {

bool has(const char* extensions, const char* name) {
  // Whole words only: EGL_EXT_device_drm is also the beginning of EGL_EXT_device_drm_render_node.
  if (!extensions) return false;
  const std::string words = std::string(" ") + extensions + " ";
  return words.find(std::string(" ") + name + " ") != std::string::npos;
}

const char* egl_error() {
  switch (eglGetError()) {
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED (driver missing, or no access to the device node)";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH (OpenGL 4.5 core not supported)";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_SUCCESS:
      return "refused without an error code";
    default:
      return "unknown EGL error";
  }
}

bool software_renderer(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

bool opens(const char* library) {
  return dlopen(library, RTLD_LAZY) != nullptr;  // kept, as libepoxy keeps it
}

/// A place to try: an EGL device, or Mesa's surfaceless platform (device == nullptr).
struct Candidate {
  EGLDeviceEXT device = nullptr;
  DeviceInfo info;
};

std::vector<Candidate> candidates() {
  // libepoxy ends the program where it does not find them.
  const bool opengl = opens("libOpenGL.so.0") || opens("libGL.so.1");
  if (!opengl || !opens("libEGL.so.1")) return {};
  std::vector<Candidate> found;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (has(client, "EGL_EXT_platform_device") &&
      (has(client, "EGL_EXT_device_enumeration") || has(client, "EGL_EXT_device_base"))) {
    EGLint count = 0;
    EGLDeviceEXT devices[64];
    if (eglQueryDevicesEXT(64, devices, &count)) {
      for (EGLint i = 0; i < count; ++i) {
        const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
        Candidate candidate{devices[i], {}};
        candidate.info.software = has(extensions, "EGL_MESA_device_software");
        candidate.info.name = "EGL device " + std::to_string(i);
        if (candidate.info.software) candidate.info.name += " (Mesa software)";
        if (has(extensions, "EGL_EXT_device_drm"))
          if (const char* node = eglQueryDeviceStringEXT(devices[i], EGL_DRM_DEVICE_FILE_EXT))
            candidate.info.name += std::string(" (") + node + ")";
        found.push_back(candidate);
      }
    }
  }
  if (has(client, "EGL_MESA_platform_surfaceless")) {
    Candidate surfaceless;
    surfaceless.info.name = "Mesa surfaceless";
    found.push_back(surfaceless);
  }
  return found;
}

struct Context {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

EGLContext core_context(EGLDisplay display, EGLConfig config) {
  EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                         4,
                         EGL_CONTEXT_MINOR_VERSION,
                         5,
                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                         EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                         EGL_LOSE_CONTEXT_ON_RESET,
                         EGL_NONE};
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) {  // a driver that does not report resets
    attributes[6] = EGL_NONE;
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  }
  return context;
}

/// Makes a 4.5 core context without a surface and leaves it current; fills in what became of it.
/// Displays stay initialised: another context of this process may live on the same one.
Context open(Candidate& candidate) {
  DeviceInfo& info = candidate.info;
  Context made;
  made.display = candidate.device
                     ? eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, candidate.device, nullptr)
                     : eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (made.display == EGL_NO_DISPLAY) {
    info.detail = std::string("no display: ") + egl_error();
    return made;
  }
  if (!eglInitialize(made.display, nullptr, nullptr)) {
    info.detail = std::string("eglInitialize: ") + egl_error();
    return made;
  }
  const char* extensions = eglQueryString(made.display, EGL_EXTENSIONS);
  if (!has(extensions, "EGL_KHR_surfaceless_context")) {
    info.detail = "no EGL_KHR_surfaceless_context";
    return made;
  }
  eglBindAPI(EGL_OPENGL_API);
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has(extensions, "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(made.display, wanted, &config, 1, &count) || count == 0) {
      info.detail = "no config for desktop OpenGL";
      return made;
    }
  }
  made.context = core_context(made.display, config);
  if (made.context == EGL_NO_CONTEXT) {
    info.detail = std::string("no OpenGL 4.5 core context: ") + egl_error();
    return made;
  }
  if (!eglMakeCurrent(made.display, EGL_NO_SURFACE, EGL_NO_SURFACE, made.context)) {
    info.detail = std::string("eglMakeCurrent: ") + egl_error();
    eglDestroyContext(made.display, made.context);
    made.context = EGL_NO_CONTEXT;
    return made;
  }
  const auto text = [](GLenum name) {
    const auto* value = reinterpret_cast<const char*>(glGetString(name));
    return std::string(value ? value : "");
  };
  info.renderer = text(GL_RENDERER);
  info.version = text(GL_VERSION);
  info.software = info.software || software_renderer(info.renderer);
  info.usable = true;
  return made;
}

void close(const Context& context) {
  if (context.context == EGL_NO_CONTEXT) return;
  if (eglGetCurrentContext() == context.context)
    eglMakeCurrent(context.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(context.display, context.context);
}

bool software_asked() {
  const char* asked = std::getenv("BIN_SCENES_GL");
  return asked && std::strcmp(asked, "software") == 0;
}

template <class Get>
long long limit(Get get) {
  GLint64 value = 0;
  get(&value);
  return value;
}

}  // namespace

struct Device::State {
  Context context;
  DeviceInfo info;
  std::string vendor;
  Limits limits;
  bool lost = false;
};

namespace {
thread_local Device* current_here = nullptr;
}

Device::Device() : state_(std::make_unique<State>()) {
  std::vector<Candidate> list = candidates();
  const bool software = software_asked();
  // What is asked for first; the order within a kind is the driver's.
  std::stable_sort(list.begin(), list.end(), [&](const Candidate& a, const Candidate& b) {
    return (a.info.software == software) > (b.info.software == software);
  });

  std::string attempts;
  // A device may turn out to be software only once its renderer is known: keep such a one as the second choice.
  for (const bool insist : {true, false}) {
    for (Candidate& candidate : list) {
      if (insist && candidate.info.software != software && candidate.device) continue;
      candidate.info.detail.clear();
      const Context context = open(candidate);
      if (candidate.info.usable && !(insist && candidate.info.software != software)) {
        state_->context = context;
        state_->info = candidate.info;
        break;
      }
      close(context);
      if (!insist) attempts += (attempts.empty() ? "" : "; ") + candidate.info.name + ": " + candidate.info.detail;
    }
    if (state_->context.context != EGL_NO_CONTEXT) break;
  }
  if (state_->context.context == EGL_NO_CONTEXT)
    throw environment_error(
        "no OpenGL 4.5 device could be opened through EGL; tried: " +
            (attempts.empty() ? std::string("nothing, as there is no EGL, or it lists no device") : attempts),
        "GL",
        "install a driver with EGL, or Mesa's software renderer: apt install libegl1 "
        "libgl1-mesa-dri");

  const auto* vendor = reinterpret_cast<const char*>(glGetString(GL_VENDOR));
  state_->vendor = vendor ? vendor : "";
  const auto get = [](GLenum name) { return limit([&](GLint64* value) { glGetInteger64v(name, value); }); };
  state_->limits.storage_blocks = static_cast<int>(get(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS));
  state_->limits.shared_bytes = static_cast<int>(get(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE));
  state_->limits.invocations = static_cast<int>(get(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS));
  state_->limits.storage_bytes = get(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  state_->limits.groups_per_axis =
      static_cast<int>(limit([](GLint64* value) { glGetInteger64i_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0, value); }));
  current_here = this;
}

Device::~Device() {
  if (current_here == this) current_here = nullptr;
  close(state_->context);
}

std::shared_ptr<Device> Device::shared() {
  thread_local std::shared_ptr<Device> device;
  if (device && (!device->try_make_current() || glGetGraphicsResetStatus() != GL_NO_ERROR)) device->lose();
  if (!device || device->lost()) device = std::make_shared<Device>();
  return device;
}

Device& Device::current() {
  return current_here ? *current_here : *shared();
}

bool Device::is_current() {
  return eglGetCurrentContext() != EGL_NO_CONTEXT;
}

void Device::lose() {
  state_->lost = true;
}
bool Device::lost() const {
  return state_->lost;
}

std::string Device::renderer() const {
  return state_->info.renderer;
}
std::string Device::vendor() const {
  return state_->vendor;
}
std::string Device::version() const {
  return state_->info.version;
}
bool Device::software() const {
  return state_->info.software;
}
const Limits& Device::limits() const {
  return state_->limits;
}

bool Device::try_make_current() noexcept {
  if (!eglMakeCurrent(state_->context.display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context.context)) return false;
  current_here = this;
  return true;
}

void Device::make_current() {
  if (!try_make_current())
    throw environment_error(std::string("the OpenGL context can not be made current: ") + egl_error(),
                            state_->info.name, "one thread owns a device; use it from the thread that made it");
}

std::vector<DeviceInfo> Device::enumerate() {
  std::vector<Candidate> list = candidates();
  if (list.empty()) return {};
  const EGLDisplay display = eglGetCurrentDisplay();
  const EGLContext context = eglGetCurrentContext();
  std::vector<DeviceInfo> infos;
  for (Candidate& candidate : list) {
    close(open(candidate));
    infos.push_back(candidate.info);
  }
  if (context != EGL_NO_CONTEXT) eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
  return infos;
}

}  // namespace bin_scenes::gl
