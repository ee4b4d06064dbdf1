/// The energy audit detects mechanical energy that contacts created, which is the sign of an explosion.
///
/// Contacts and friction can only remove mechanical energy. A group of parts that may have touched can therefore not
/// gain any between two observations, and a part gains only what its neighbours lose. Parts within reach of each other
/// form a group, and the gain of a part is limited to the gain of its group:
///
///     gain of part i = min(E_i now - E_i before, sum of the same over its group) / (m_i g d_i)
///
/// where E is the kinetic and potential energy, m the mass, g gravity, and d the diagonal of the bounding box: a gain
/// of 1 throws the part up by its own size. Rounding errors of fast parts are subtracted, and so is the possible error
/// of integrating friction and rotation, which is a share of the kinetic energy.
///
/// Energy alone does not reveal a light part that heavy parts pinch out, because they lose more energy than it gains.
/// Without restitution, nothing leaves a contact faster than the body that hit it. A part that is faster than
/// everything in its group was before, gravity's share subtracted, was therefore thrown. Wedges and levers multiply
/// speeds to some degree: twice as fast is reported, and five times as fast sets the scene apart.
///
/// The gain of a part in one interval misses slow gains, and includes energy that a part recovers from others that
/// gained it before. The energy of all parts together is therefore also compared with its lowest earlier value
/// (WorldEnergy):
///
///     gain of the world = sum over all parts (E_i now - E_i at the lowest) / sum over those that moved (m_i g d_i)
#pragma once

#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/solver/solver.hpp"
#include "core/disjoint_sets.hpp"

#include <vector>

namespace bin_scenes {

/// The gain from which a scene has the flag energy_gained.
constexpr double flagged_gain = 0.1;
/// The ratio of speeds from which a scene has the flag part_thrown.
constexpr double flagged_ratio = 2.0;

/// Compares the energy of all bodies together with its lowest earlier value.
class WorldEnergy {
 public:
  explicit WorldEnergy(std::size_t bodies) : bodies_(bodies) {}

  /// Starts the observation again with the next energies, because something has worked on the bodies.
  void begin() { begins_ = true; }
  /// States that a body enters with this energy (J).
  void enter(std::size_t body, double energy) { bodies_[body].least = energy; }
  /// Adds the present energies (J) of a body, and its unit of energy m g d. Call it for each body that is present, then
  /// call finish().
  void observe(std::size_t body, double kinetic, double potential, double unit);
  /// Ends an observation.
  void finish(double time);

  const WorstReport::EnergyGain& worst() const { return worst_; }

 private:
  struct Body {
    double now = 0.0, least = 0.0;  ///< J: latest value, and value when the sum was lowest
    double swiftest = 0.0;          ///< J: largest kinetic energy since then
    double unit = 0.0;
    bool in = false;  ///< whether the body is present in this observation
  };
  std::vector<Body> bodies_;
  bool begins_ = false;
  WorstReport::EnergyGain worst_;
};

class EnergyAudit {
 public:
  explicit EnergyAudit(const WorldDef& world);

  /// States that a body enters or is moved: its observation starts with this state.
  void enter(std::size_t body, const BodyState& state);
  void leave(std::size_t body) { bodies_[body].in = false, world_energy_.begin(); }
  /// Observes all bodies at `time` (s). Bodies that have never entered are not observed, whatever their states.
  /// `driven`: moving fixed bodies or a moving frame may have worked on the bodies since the last observation, so that
  /// all observations start again.
  void observe(double time, const std::vector<BodyState>& states, bool driven = false);

  const EnergyReport& worst() const { return worst_; }
  const WorstReport::EnergyGain& worst_of_world() const { return world_energy_.worst(); }

 private:
  struct Body {
    bool in = false, fixed = false;
    double kinetic = 0.0, potential = 0.0;  ///< J, at the last observation
    Vec3 center = Vec3::Zero();             ///< centre of mass at the last observation (m)
    double speed = 0.0;                     ///< m/s
    double swift = 0.0;                     ///< m/s, speed of the body's fastest point
  };
  /// A ball that contains all positions of a body since the last observation.
  struct Reach {
    std::size_t body;
    Vec3 center;    ///< m
    double radius;  ///< m
    double gain;    ///< J, energy gained since the last observation
    double before;  ///< m/s, speed of the body's fastest point at the last observation
    double now;     ///< m/s, present speed of the centre of mass
  };

  void observe_world(double time);
  Body body_at(std::size_t body, const BodyState& state) const;
  DisjointSets groups(const std::vector<Reach>& reaches) const;
  void compare_gains(DisjointSets& group, const std::vector<Reach>& reaches, double time);
  void compare_speeds(DisjointSets& group, const std::vector<Reach>& reaches, double seconds, double time);
  /// Returns the speed (m/s) from which a part is examined: its energy then equals a gain that would be flagged.
  double least_speed(std::size_t body) const;

  const WorldDef& world_;
  double gravity_;  ///< m/s2; without gravity, that of the earth, so that there is a unit of energy
  double last_ = 0.0;
  std::vector<Body> bodies_;
  EnergyReport worst_;
  WorldEnergy world_energy_;
};

std::vector<Flag> flags_of(const EnergyReport& worst);

}  // namespace bin_scenes
