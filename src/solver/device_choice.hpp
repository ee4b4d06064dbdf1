/// Selects the device for the solver `sphere` if the request leaves it open: the one on which a standard heap took less
/// time. The measurement is made once and stored.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace bin_scenes {

/// Wall times of one step (s): few_s and many_s of a single heap of `few` or `many` parts, and together_s of each of
/// `worlds` heaps of `few` parts that are advanced together.
struct StepTimes {
  double few_s = 0.0, many_s = 0.0, together_s = 0.0;
};

/// The measured times of a step on the devices of this machine.
struct DeviceFigures {
  static constexpr std::size_t few = 64, many = 384, worlds = 64;
  std::string cpu, gpu;  ///< names of the devices
  StepTimes on_cpu, on_gpu;
};

struct DeviceChoice {
  bool gpu = false;
  std::string reason;  ///< cause of the choice, with the measured times
};

/// Chooses the device by predicted times, which follow from the measured steps by a power law in the number of parts.
/// Of several scenes, as many are advanced together as were measured. The GPU is chosen if it needs less than 0.8 times
/// as long, so that noise in near ties does not decide.
DeviceChoice choose_device(const DeviceFigures& figures, std::size_t parts, std::size_t scenes);

/// Chooses the device for a request on this machine. Measures when a device is first needed, then reads the figures
/// from the cache. Without a GPU nothing is measured, and no OpenGL context is made where no device file is found.
DeviceChoice choose_device(const Request& request);

/// Measures the times now, on the CPU and on the device that OpenGL provides. Throws an environment Error without one.
/// @param share  size of the measured heaps relative to the standard size; tests use less than 1
DeviceFigures measure_devices(double share = 1.0);

/// Returns the figures of this machine, from the cache if possible; none without a GPU.
std::optional<DeviceFigures> device_figures();

}  // namespace bin_scenes
