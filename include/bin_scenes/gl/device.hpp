/// A headless OpenGL 4.5 context through EGL. This layer is independent of the physics.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace bin_scenes::gl {

/// One EGL device, as `bin_scenes doctor` lists it.
struct DeviceInfo {
  std::string name;                       ///< EGL vendor / DRM node
  bool software = false;                  ///< EGL_MESA_device_software
  bool usable = false;                    ///< a 4.5 core context could be made
  std::string renderer, version, detail;  ///< GL_RENDERER, GL_VERSION; what failed if not usable
};

struct Limits {
  int storage_blocks = 0, shared_bytes = 0, invocations = 0, groups_per_axis = 0;
  long long storage_bytes = 0;
};

/// Owns the context; made current on the thread that constructs it, which then owns all GL calls. Its objects
/// must be deleted while it is current: an owner of such objects keeps a reference to the device, and makes it current
/// before it destroys them.
class Device {
 public:
  /// Prefers hardware; software devices only if nothing else works or BIN_SCENES_GL=software; surfaceless Mesa last.
  /// Throws an environment Error that lists every attempt.
  Device();
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// The device of this thread. It is made on first use, and made again after it was lost.
  static std::shared_ptr<Device> shared();
  /// The device that is current on this thread, or shared() if there is none.
  static Device& current();
  static bool is_current();  ///< whether this thread may make GL calls

  std::string renderer() const;  ///< GL_RENDERER
  std::string vendor() const;
  std::string version() const;  ///< GL_VERSION, with the driver's
  bool software() const;        ///< llvmpipe, softpipe, swrast
  const Limits& limits() const;
  void make_current();  ///< throws an environment Error
  bool try_make_current() noexcept;
  void lose();  ///< marks the device as lost, called when its results are gone; its objects cannot be used any more
  bool lost() const;

  static std::vector<DeviceInfo> enumerate();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes::gl
