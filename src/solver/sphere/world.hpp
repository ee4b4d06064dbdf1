/// One world of the default sphere solver: constant data, data of the passes, and bookkeeping. No pass allocates memory
/// in the steady state. Every list is ordered by keys, so that a world gives the same bits alone and in a batch.
///
///   bodies ──find_pairs──► pairs ──find_contacts──► manifolds ──color──► solve ──► bodies
///                            └ kept between steps: forces (warm start), contacts of pairs that hardly move (recycling)
///
/// Poses are of the centre of mass, in single precision, relative to the world's origin.
#pragma once

#include "bin_scenes/solver/solver.hpp"
#include "solver/sphere/shapes/shape.hpp"
#include "solver/sphere/shared_code.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace bin_scenes::sphere {

/// Compliance of contacts.
struct Softness {
  float hertz_share;    ///< contact frequency / sub-step rate; if lower, piles sag; if higher, rocking is damped less
  float damping_ratio;  ///< if it is below 1, contacts oscillate
  float slop;           ///< overlap that is not removed, so that contacts persist, as a share of d (see Settings)
  int refinement;       ///< factor on sub-steps; overlap under load falls with its square, the cost rises linearly
};

using Sleep = Phase::Sleep;

/// Settings in the form that the passes use (m, s). A length marked `d` is a share of d, the size of the smallest part.
///
/// The effect of each was measured without it (bench/ablation.cpp), by another number or by one of the switches below.
struct Settings {
  float time_step = 1.0f / 400;  ///< s: duration of a step, with one collision detection
  bool cut_steps = true;         ///< whether steps are shortened for small and for fast parts
  /// Number of sub-steps of a step. The stiffness of contacts grows with the square of this number. The default of 4 is
  /// for tests that build a World themselves: make_world() sets the number of the request, 2 by default.
  int sub_steps = 4;
  int sweeps = 2;          ///< sweeps before bodies move, and as many after it (rigid contacts: 1); with 1, stacks sway
  float tolerance = 0.1f;  ///< d per second: a contact whose speed changes by more in a sweep has not converged; if
                           ///< larger, an impact in a wedge or a chain adds energy
  int sharing_sweeps = 12;  ///< largest number of sweeps until contacts converge; if smaller, impacts add energy too
  int impact_sweeps = 24;   ///< most sweeps in a step with an impact, times heaviest / lightest part; with half as
                            ///< many, a light part under one of 100 times its mass leaves at 7 % of the impact's speed
  int most_impact_sweeps = 2400;  ///< limit of these sweeps for any masses; at a ratio of 1:10,000 no number suffices
  /// Worlds with more bodies do not repeat sweeps for an impact, but leave it to the next sub-steps: a heap that is
  /// poured always has an impact, which soon spreads among many parts, and the sweeps would cost 10 % of its time.
  std::size_t impact_bodies = 48;
  /// m/s: replaces `tolerance` in steps with an impact and in the steps after them, for worlds that solve impacts
  /// exactly. With three times as much, a cube of 5 mm leaves a symmetric impact at 0.02 % of its speed.
  float exact_tolerance = 3e-5f;
  int exact_sweeps = 60;  ///< largest number of sweeps to reach exact_tolerance, times heaviest / lightest part
  /// rad: largest angle by which the contact of a rolling body goes round it in a sub-step, for the same worlds. A
  /// sub-step takes as much energy as a corner of a polygon whose sides are this angle; with twice as much, a coin of
  /// 64 sides that rolls on its rim lies a tenth sooner.
  float roll = 0.02f;
  float roll_cuts = 16;  ///< largest number of steps for one step, for the sake of `roll`
  int cold_sweeps = 4;   ///< sweeps in the first steps of a world and of a probe, when contacts carry no forces yet
  int cold_steps = 50;   ///< number of such steps; with 0, a part under one of a thousand times its mass never rests
  int pressed_cold_steps = 10;  ///< number of such steps in a press after a probe, where forces are found sooner
  // World::effort multiplies the work on contacts. It is the largest of four bounds, each 1 in an ordinary bin.
  float default_layers = 4.5f;   ///< layers of a heap for which the default work suffices; beyond, work grows linearly;
                                 ///< higher = parts deep in a bin never rest: loads propagate by a layer per sweep
  float thin_part_sag = 0.024f;  ///< static sag that the default work allows: layers x gravity x (sub-step)^2 /
                                 ///< thickness of the thinnest part; higher = thin parts sink into each other
  float loaded_part_sag = 0.1f;  ///< the same sag, for each part under the load above it; higher = light parts sink in
  float max_load_effort = 8;     ///< largest effort for loaded parts; higher = a heavy part among light ones costs more
  float default_mass_ratio = 8;  ///< mass ratio of parts up to which the default sweeps suffice; they grow with its
                                 ///< square root; higher = heavy parts rebound from light ones, and squeeze them out
  float max_mass_effort = 16;    ///< largest factor on the number of sweeps for unequal masses
  float tower_effort = 0.16f;    ///< effort of a tower of n parts / n^1.5; lower = twenty cubes sway and never rest
  float max_tower_effort = 60;   ///< largest effort of a tower, of about 50 parts; higher = piles of sheets cost more
  Softness soft{0.25f, 10.0f, 2e-4f, 1};     ///< compliance while parts move; damps rocking
  Softness stiff{0.35f, 10.0f, 2.5e-5f, 4};  ///< compliance while the heap is pressed; leaves no overlap
  /// Compliance while the heap is probed: none; a sub-step removes 1/160 of the overlap. Stiff contacts would press
  /// neighbours apart, and parts squeezed like this are held by friction that another engine does not find.
  Softness rigid{1.0f, 500.0f, 0.0f, 4};
  float patch_radius = 1e-3f;  ///< d: radius of the patch of a point or line contact; resists spin and rolling.
                               ///< 0 = a part held at two points swings forever; higher = wheels stop
  float push_speed = 4.0f;  ///< d per second, / refinement: largest speed that removes overlap; higher = parts pop out
  float margin = 4e-3f;     ///< d: contacts are found up to this distance plus the displacement in one step; with half
                            ///< of it, a spike between others is thrown up by a hundredth of the height it fell
  float recycle = 1e-3f;    ///< d: contacts of a pair are reused until its relative pose has changed by this much
  float coarse_recycle = 3e-3f;   ///< d: the same on coarse samples, where less precision is needed
  float pressed_recycle = 1e-3f;  ///< d: the same on stiff and rigid contacts. If it is larger, parts are held by
                                  ///< contacts that are no longer there when they are found anew
  /// s: duration without friction at the start of a probe, while normal forces are found. If it is longer, the heap is
  /// shaken; if it is shorter, wedged parts hold that would slip in another engine.
  float probe_slip = 2.5e-3f;
  float restitution_speed = 0.05f;  ///< m/s: slower impacts do not bounce
  float rest_window = 0.1f;         ///< s: a body sleeps after staying within rest_move for this time
  float rest_move = 1e-4f;          ///< d: largest displacement of a body that may sleep
  float touch_move = 5e-4f;  ///< d: the same for Sleep::by_touch, and the displacement at which a body wakes others;
                             ///< less = a pick wakes more of the heap, more = creeping parts are frozen

  // Switches for tests and benchmarks; a request cannot set them, and all are on.
  bool warm_start = true;             ///< a step begins with the contact forces of the last one
  bool speculation = true;            ///< contacts that may close in a step are found before they do
  bool soonest_first = true;          ///< contacts of a pair that are about to close have priority over others
  bool way_back = true;               ///< samples deep inside a part leave it through the face by which they entered
  bool poses_at_contact_time = true;  ///< contacts are found at the poses predicted for StepPlan::contact_time
  bool relaxation = true;             ///< sweeps that remove the velocity which the removal of overlap has added
  bool friction_reserve = true;       ///< stages of settling may reduce friction (Phase::friction)
  bool gyroscopic = true;             ///< gyroscopic torque of spinning parts with unequal moments of inertia
  bool oriented_boxes = true;         ///< pairs whose oriented bounding boxes do not overlap are rejected

  const Softness& softness(Stiffness of) const {
    return of == Stiffness::soft ? soft : of == Stiffness::stiff ? stiff : rigid;
  }
};

struct Body {
  // Constant properties.
  std::uint32_t shape = 0;
  float inverse_mass = 0;                                              ///< 1/kg; 0: fixed
  Mat3f inertia = Mat3f::Identity(), inverse_inertia = Mat3f::Zero();  ///< body frame (kg m2, 1/(kg m2))
  float friction = 0.5f, restitution = 0;
  // State that the solver changes.
  Vec3f x = Vec3f::Zero(), v = Vec3f::Zero(), w = Vec3f::Zero();
  Vec3f x_rest = Vec3f::Zero(), v_rest = Vec3f::Zero();  ///< rounding errors of x and v: see add_exactly() in math.hpp
  Quatf q = Quatf::Identity();
  Mat3f rotation = Mat3f::Identity();  ///< matrix of q when contacts were found
  Mat3f world_inverse_inertia = Mat3f::Zero();
  // Bookkeeping.
  bool present = false, asleep = false;
  bool driven = false;  ///< fixed body that moves along a prescribed path
  float still = 0;      ///< s: time that it has stayed within rest_move of the reference pose
  Vec3f still_x = Vec3f::Zero();
  Quatf still_q = Quatf::Identity();

  bool moves() const { return present && !asleep && (inverse_mass > 0 || driven); }
};

constexpr int max_contacts = SPHERE_MAX_CONTACTS;
constexpr std::uint32_t ground = SPHERE_GROUND;  ///< body index of the bin's walls and floor

/// One contact point of a manifold. Anchors are in body frames, so that a recycled contact follows both bodies.
struct Contact {
  Vec3f anchor_a = Vec3f::Zero(), anchor_b = Vec3f::Zero();  ///< points on the surfaces of a and b (m, body frames)
  Vec3f local_normal = Vec3f::Zero();  ///< unit normal from a to b, in the frame of the body whose field gave it
  std::uint32_t feature = 0;  ///< bit 31: sample of b against field of a; bit 30: edge; rest: node, edge or plane
  float normal_force = 0;     ///< N; a force and not an impulse, because the next sub-step may have another length
  Vec3f friction_force = Vec3f::Zero();  ///< N, force on b, world frame
  Vec3f normal = Vec3f::Zero();          ///< from a to b in the last solve, world frame
};

/// Where two bodies press on each other at one place, and how fast this place goes round one that rolls.
struct Rolling {
  Vec3f on_a = Vec3f::Zero(), on_b = Vec3f::Zero();  ///< the place in both body frames (m)
  Vec3f moved = Vec3f::Zero();                       ///< by how much it last moved over a (m, body frame)
  double since = 0;                                  ///< s: value of World::clock when it did
  float took = 0;                                    ///< s: time from the movement before to this one
  float speed = 0;                                   ///< rad/s: of the place about the centre of the body
};

struct Manifold {
  std::uint32_t a = 0, b = 0;  ///< indices of the bodies, a < b; b may be ground
  int color = 0;
  float friction = 0, restitution = 0;
  // Relative pose at which the contacts were found, for recycling; for a contact with the ground, the pose of a.
  Vec3f found_x = Vec3f::Zero();
  Quatf found_q = Quatf::Identity();
  bool found = false;
  Rolling rolling;
  std::vector<Contact> contacts;  ///< at most max_contacts; carrying a manifold to the next step does not copy them
};

/// The boundary of a half-space that bodies may not enter: a wall, up to World::wall_top, or the unbounded floor.
struct Plane {
  Vec3f normal = Vec3f::UnitZ();
  float offset = 0;  ///< m: points p outside of the half-space have normal . p >= offset
  bool wall = false;
};

/// Jaws in the form that the passes use: driven bodies, whose common closing speed is reduced by their contacts.
struct JawPair {
  std::uint32_t first = 0, second = 0;                    ///< indices of the two bodies
  Vec3f axis = Vec3f::UnitX(), velocity = Vec3f::Zero();  ///< unit vector; velocity of the hand (m/s)
  float force = 0, speed = 0, mass = 0;                   ///< of each jaw: N, largest closing speed (m/s), kg
};

/// A force that acts on a body in addition to gravity.
struct Pull {
  std::uint32_t body = 0;
  Vec3f force = Vec3f::Zero(), arm = Vec3f::Zero();  ///< N, world frame; m from the centre of mass, body frame
};

struct Counters {
  std::uint64_t steps = 0, free_steps = 0, asleep_steps = 0, pairs = 0, pairs_recycled = 0, pairs_asleep = 0,
                pairs_culled = 0, clusters_tested = 0, nodes_tested = 0, nodes_possible = 0, contacts = 0, dropped = 0;

  /// Calls visit(name in the profile, pointer to member) for each counter. This is the only list of the counters.
  template <class Visit>
  static void each(Visit&& visit) {
    visit("steps", &Counters::steps);
    visit("body_steps_in_free_fall", &Counters::free_steps);
    visit("body_steps_asleep", &Counters::asleep_steps);
    visit("pairs", &Counters::pairs);
    visit("pairs_recycled", &Counters::pairs_recycled);
    visit("pairs_asleep", &Counters::pairs_asleep);
    visit("pairs_culled", &Counters::pairs_culled);
    visit("clusters_tested", &Counters::clusters_tested);
    visit("nodes_tested", &Counters::nodes_tested);
    visit("nodes_possible", &Counters::nodes_possible);
    visit("contacts", &Counters::contacts);
    visit("contacts_reduced", &Counters::dropped);
  }
  Counters& operator+=(const Counters& c) {
    each([&](const char*, std::uint64_t Counters::*member) { this->*member += c.*member; });
    return *this;
  }
};

/// The deepest contact, which Solver::take_worst_contact() reports. Depths are those at the start of a step.
struct DeepestContact {
  std::uint32_t a = ground, b = ground;
  float depth = 0, relative = 0;  ///< m; depth / diagonal of the smaller part
  double time = 0;                ///< s, value of World::clock in that step
  std::uint64_t unresolved_impacts = 0;
};

/// Wall time of each pass (ms), for the profile only.
struct Spent {
  double find_pairs = 0, find_contacts = 0, color_manifolds = 0, solve = 0, update_sleep = 0;
};

struct World {
  Settings settings;
  std::int64_t scene = -1;  ///< WorldDef::scene
  std::vector<const Shape*> shapes;
  std::vector<Body> bodies;
  std::vector<Plane> planes;
  float wall_top = 0;
  float ground_friction = 0.5f, ground_restitution = 0;
  Vec3f gravity = Vec3f(0, 0, -9.81f);
  Frame frame;                            ///< motion of the bin; its gravity is equal to `gravity`
  bool fine = false;                      ///< whether fine samples are used, or coarse ones
  Stiffness stiffness = Stiffness::soft;  ///< kind of the contacts
  Sleep sleep = Sleep::by_island;         ///< how bodies fall asleep and wake
  float friction_share = 1;               ///< share of the coefficients of friction that acts
  bool exact_impacts = true;              ///< WorldDef::exact_impacts
  bool struck = false;                    ///< whether the last step had an impact, if impacts are solved exactly
  bool forgets = false;                   ///< whether the next step starts without remembered forces
  std::optional<JawPair> jaws;            ///< Solver::set_jaws()
  std::vector<Pull> pulls;                ///< Solver::set_force()
  int cold_steps = 0;                     ///< number of remaining steps with Settings::cold_sweeps
  int effort = 1;                         ///< factor on the number of sub-steps or sweeps (effort.hpp)
  float mass_ratio = 1;                   ///< mass of the heaviest part / mass of the lightest part
  int mass_effort = 1;                    ///< lower bound of the factor on the number of sweeps, for unequal masses
  float smallest_size = 0, least_thickness = 0, thinnest = 0;  ///< m: smallest Shape::size, thickness and wall
  float whole_step = 0;                                        ///< s: Settings::time_step while no part is fast
  int cuts = 1;  ///< number of steps for one time step of the request; more than 1 for small parts

  std::vector<Manifold> manifolds, previous;  ///< of this step and of the last one, sorted by (a, b)
  std::vector<std::uint32_t> order;           ///< manifolds to solve, by color, those with most contacts first
  Counters counters;
  Spent spent;
  double clock = 0;        ///< s of simulated time
  float rolling = 0;       ///< rad/s: largest Rolling::speed, where impacts are solved exactly
  DeepestContact deepest;  ///< since the last call of take_worst_contact()

  const Softness& softness() const { return settings.softness(stiffness); }
  /// Returns the factor on the number of sub-steps. Soft contacts sag with the square of the layers above them and
  /// stiffen with the square of the number of sub-steps; therefore their effort multiplies sub-steps, and that of other
  /// contacts multiplies sweeps. With sweeps for both, a deep heap rises by 1 % of d when it is pressed.
  int refinement() const {
    return stiffness == Stiffness::soft ? effort * softness().refinement : softness().refinement;
  }
  int sweep_effort() const { return stiffness == Stiffness::soft ? mass_effort : std::max(effort, mass_effort); }
  /// Returns the change of a contact's speed in a sweep (m/s) above which the contact has not converged.
  /// @param impact  whether two bodies approach each other fast in this step, or did in the last one (`struck`)
  float tolerance(bool impact) const {
    const float usual = settings.tolerance * smallest_size;
    return impact && exact_impacts ? std::min(usual, settings.exact_tolerance) : usual;
  }
  /// Returns the largest number of sweeps of a sub-step while an impact has not propagated; 0: later sub-steps do that.
  /// @param impact  as for tolerance()
  int impact_sweeps(bool impact) const {
    if (bodies.size() > settings.impact_bodies || settings.sharing_sweeps == 0) return 0;
    if (!impact) return settings.sharing_sweeps;
    const int sweeps = exact_impacts ? settings.exact_sweeps : settings.impact_sweeps;
    const float wanted = mass_ratio * static_cast<float>(sweeps);
    return static_cast<int>(std::min(wanted, static_cast<float>(settings.most_impact_sweeps)));
  }
  /// Returns whether the steps of bodies that roll are shortened. Poured heaps keep their time instead.
  bool cuts_rolling() const { return settings.cut_steps && exact_impacts && bodies.size() <= settings.impact_bodies; }
  /// Returns the plan of the next step.
  StepPlan plan() const {
    StepPlan plan = plan_step(settings.time_step, settings.sub_steps * refinement(),
                              sweep_effort() * (cold_steps > 0 ? settings.cold_sweeps : settings.sweeps),
                              stiffness == Stiffness::rigid, forgets, settings.probe_slip);
    if (!settings.relaxation) plan.relaxing_sweeps = 0;
    if (!settings.poses_at_contact_time) plan.contact_time = 0;
    return plan;
  }
  bool is_ball(const Body& b) const { return shapes[b.shape]->field.ball > 0; }
  /// Returns the change of the relative pose of a pair (d) up to which its contacts are reused.
  float recycle() const {
    if (!fine) return settings.coarse_recycle;
    return stiffness == Stiffness::soft ? settings.recycle : settings.pressed_recycle;
  }
  const Samples& samples(const Body& b) const { return fine ? shapes[b.shape]->fine : shapes[b.shape]->coarse; }
};

// The passes in the order of a step; each is a file of passes/.
void find_pairs(World& world);       ///< finds candidate pairs, and matches them with the manifolds of the last step
void find_contacts(World& world);    ///< tests samples against fields, selects contacts, and matches forces
void wake_struck(World& world);      ///< wakes sleeping bodies that are hit in this step, and their islands
void color_manifolds(World& world);  ///< colors manifolds so that no two of a color share a moving body
void note_depths(World& world);      ///< records the deepest contact of this step in World::deepest
void solve(World& world);            ///< solves the sub-steps, and moves the bodies
void update_sleep(World& world);     ///< puts parts at rest to sleep

void note_rolling(World& world);  ///< updates Manifold::rolling and World::rolling

/// Returns the bodies, except fixed ones, that have contacts with this body, whether these carry a force or not.
std::vector<std::uint32_t> touched_by(const World& world, std::uint32_t body);
void wake(Body& body);
void put_to_sleep(const Settings& settings, Body& body);  ///< puts the body to sleep at its present pose

/// Simulates one time step.
void step(World& world);

}  // namespace bin_scenes::sphere
