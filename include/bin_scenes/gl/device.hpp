/// A headless OpenGL 4.5 context that is made through EGL, and the list of the devices that offer one. This layer
/// contains no physics; solvers and sensors build their passes on it.
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

/// The limits of a driver: counts, and sizes in bytes.
struct Limits {
  int storage_blocks = 0, shared_bytes = 0, invocations = 0, groups_per_axis = 0;
  long long storage_bytes = 0;
};

/// Owns the context. The constructor makes it current on the calling thread, and from then on only this thread may make
/// GL calls. GL objects must be deleted while the context is current: an owner of such objects keeps a reference to the
/// device and makes it current before it destroys them.
class Device {
 public:
  /// Prefers hardware. Software devices are used only if nothing else works or if BIN_SCENES_GL=software is set;
  /// surfaceless Mesa is tried last. Throws an environment Error that lists every attempt.
  Device();
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Returns the device of this thread. It is created on first use, and created again after it was lost.
  static std::shared_ptr<Device> shared();
  /// Returns the device that is current on this thread, or shared() if there is none.
  static Device& current();
  static bool is_current();  ///< whether this thread may make GL calls

  std::string renderer() const;  ///< GL_RENDERER
  std::string vendor() const;
  std::string version() const;  ///< GL_VERSION, which includes the driver's version
  bool software() const;        ///< llvmpipe, softpipe, swrast
  const Limits& limits() const;
  void make_current();  ///< throws an environment Error
  bool try_make_current() noexcept;
  /// Marks the device as lost, which is called when its results are gone; its objects cannot be used any more.
  void lose();
  bool lost() const;

  /// Lists all EGL devices and tries to create a context on each.
  static std::vector<DeviceInfo> enumerate();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes::gl
