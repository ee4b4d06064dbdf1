/// Light that reaches a time-of-flight camera via other surfaces. It arrives later than direct light, and the
/// camera measures the phase of their sum. The measured distance of corners, and of surfaces beside walls, is therefore
/// too large (Fuchs 2010, "Multipath interference compensation in time-of-flight camera images"; Freedman et al. 2014,
/// "SRA: fast removal of general multipath for ToF sensors").
#pragma once

#include "light/indirect_field.hpp"

#include <complex>
#include <cstddef>

namespace bin_scenes {

/// The camera's light stands at its lens and lights its image, no more.
class Multipath {
 public:
  /// @param modulation  MHz
  Multipath(const Scenery& scenery, const View& view, const Surfaces& surfaces, const IndirectField::Setup& setup,
            double modulation, const Random& rays);

  /// Returns the indirect light of a pixel, in units of reflected / distance^2 of direct light, with the phase by which
  /// it arrives later.
  std::complex<double> at(std::size_t pixel) const;
  /// Returns the distance (m) that belongs to a phase.
  double range(double phase) const { return 0.5 * phase / wave_; }

 private:
  IndirectField::Pattern phasors(double unit) const;

  const View& view_;
  double wave_;  ///< rad/m of the light's path
  ProjectorLamp lamp_;
  IndirectField field_;
};

}  // namespace bin_scenes
