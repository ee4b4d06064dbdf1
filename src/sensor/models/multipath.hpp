/// Light that reaches a time-of-flight camera via other surfaces. It arrives later than direct light, and the
/// camera measures the phase of their sum. The measured distance of corners, and of surfaces beside walls, is therefore
/// too large (Fuchs 2010, "Multipath interference compensation in time-of-flight camera images"; Freedman et al. 2014,
/// "SRA: fast removal of general multipath for ToF sensors").
#pragma once

#include "light/indirect_field.hpp"

#include <complex>
#include <cstddef>

namespace bin_scenes {

/// Computes the indirect light of a camera whose light source is at its lens and illuminates exactly its field of view.
class Multipath {
 public:
  /// @param modulation  modulation frequency (MHz)
  Multipath(const Scenery& scenery, const View& view, const Surfaces& surfaces, const IndirectField::Setup& setup,
            double modulation, const Random& rays);

  /// Returns the indirect light of a pixel as a phasor, in the unit Lit::reflected / distance^2 (1/m2) of direct light.
  /// Its argument is the phase by which it arrives later than direct light.
  std::complex<double> at(std::size_t pixel) const;
  /// Returns the distance (m) of a surface whose direct light has this phase (rad).
  double range(double phase) const { return 0.5 * phase / wave_; }

 private:
  IndirectField::Pattern phasors(double unit) const;

  const View& view_;
  double wave_;  ///< phase per length of the light path (rad/m)
  ProjectorLamp lamp_;
  IndirectField field_;
};

}  // namespace bin_scenes
