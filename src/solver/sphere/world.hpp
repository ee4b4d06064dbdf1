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
  float hertz_share;    ///< contact frequency / sub-step rate; lower = piles sag, higher = rocking is damped less
  float damping_ratio;  ///< below 1 contacts oscillate
  float slop;           ///< d: overlap that is left, so that contacts persist
  int refinement;       ///< factor on sub-steps; overlap under load falls with its square, cost rises linearly
};

using Sleep = Phase::Sleep;

/// Settings as the passes use them (m, s). d is the diagonal of the smallest part.
///
/// What each gives is measured by taking it away (bench/ablation.cpp): most by a number below, the others by a switch.
struct Settings {
  float time_step = 1.0f / 400;  ///< duration of a step, with one collision detection
  bool cut_steps = true;         ///< shorter steps for small and for fast parts
  /// A step. Stiffness of contacts grows with the square of their number. 4 is for tests that build a World themselves:
  /// make_world() sets the request's number, 2 by default.
  int sub_steps = 4;
  int sweeps = 2;          ///< before bodies move, and as many after unless contacts are rigid; with 1 stacks sway
  float tolerance = 0.1f;  ///< d per second: a contact whose speed a sweep changes by more is not solved yet; more = an
                           ///< impact in a wedge or a chain gives energy
  int sharing_sweeps = 12;  ///< most sweeps for that; fewer = the same
  int impact_sweeps = 24;  ///< most in a step with an impact, times heaviest / lightest part; with half as many a light
                           ///< part under one of a hundred times its mass leaves at 7 % of the impact's speed
  int most_impact_sweeps = 2400;  ///< whatever the masses; at 1:10,000 no number suffices
  /// Larger worlds leave an impact to the next sub-steps: in a heap that is poured there is always one, soon shared
  /// among many, and the sweeps would cost a tenth of its time.
  std::size_t impact_bodies = 48;
  /// m/s: the same as tolerance in a step with an impact, of worlds that solve impacts exactly; more = a symmetric
  /// impact leaves a hundredth of its speed sideways.
  float exact_tolerance = 1e-4f;
  int exact_sweeps = 60;  ///< most sweeps for that, times heaviest / lightest part
  int cold_sweeps = 4;    ///< sweeps in the first steps of a world and of a probe, when contacts carry no forces yet
  int cold_steps = 50;    ///< number of such steps; with 0, a part under one of a thousand times its mass never rests
  int pressed_cold_steps = 10;  ///< number of such steps in a press after a probe, where forces are found sooner
  // World::effort multiplies the work on contacts. It is the largest of four bounds, each 1 in an ordinary bin.
  float default_layers = 4.5f;   ///< layers of a heap for which the default work suffices; work grows linearly beyond;
                                 ///< higher = parts deep in a bin never rest: loads travel about one layer a sweep
  float thin_part_sag = 0.024f;  ///< static sag that the default work allows: layers x gravity x (sub-step)^2 /
                                 ///< thickness of the thinnest part; higher = thin parts sink into each other
  float loaded_part_sag = 0.1f;  ///< the same of each part under the load above it; higher = light parts sink in
  float max_load_effort = 8;     ///< largest effort for that load; higher = a heavy part among light ones costs more
  float default_mass_ratio = 8;  ///< of parts for which the default sweeps suffice; they grow with its square root;
                                 ///< higher = what is heavy rebounds from what is light, and squeezes it out
  float max_mass_effort = 16;    ///< largest factor on sweeps for that
  float tower_effort = 0.16f;    ///< effort of a tower of n parts / n^1.5; lower = twenty cubes sway and never rest
  float max_tower_effort = 60;   ///< largest effort of a tower, of about 50 parts; higher = piles of sheets cost more
  Softness soft{0.25f, 10.0f, 2e-4f, 1};     ///< while parts move: damps rocking
  Softness stiff{0.35f, 10.0f, 2.5e-5f, 4};  ///< while the heap is pressed: leaves no overlap
  /// While the heap is probed: no compliance; 1/160 of the overlap is removed in a sub-step. Stiff contacts press
  /// neighbours apart, and parts squeezed like this are held by friction that another engine will not find.
  Softness rigid{1.0f, 500.0f, 0.0f, 4};
  float patch_radius = 1e-3f;  ///< d: radius of the patch of a point or line contact; resists spin and rolling.
                               ///< 0 = a part held at two points swings forever; higher = wheels stop
  float push_speed = 4.0f;  ///< d per second: largest speed that removes overlap, / refinement; higher = parts pop out
  float margin = 4e-3f;     ///< d: contacts are found up to this distance plus the path of one step; with half of it a
                            ///< spike between others is thrown up by a hundredth of the height it fell
  float recycle = 1e-3f;    ///< d: contacts of a pair are reused until it has moved this far
  float coarse_recycle = 3e-3f;  ///< d: the same on coarse samples, where less precision is needed
  /// S without friction at the start of a probe, while normal forces are found; longer = the heap is shaken, shorter =
  /// wedged parts hold that would slip in another engine.
  float probe_slip = 2.5e-3f;
  float restitution_speed = 0.05f;  ///< m/s: slower impacts do not bounce
  float rest_window = 0.1f;         ///< s: a body sleeps after staying within rest_move for this time
  float rest_move = 1e-4f;          ///< d: largest move of a body that may sleep
  float touch_move = 5e-4f;  ///< d: the same where bodies sleep by touch, and distance at which they wake others; less
                             ///< = a pick wakes more of the heap, more = what creeps is frozen

  // Switches for tests and benchmarks; a request cannot set them, and all are on.
  bool warm_start = true;             ///< a step begins with the forces of the last one
  bool speculation = true;            ///< contacts that may close in a step are found before they do
  bool soonest_first = true;          ///< of a pair's contacts those about to close go before those farther off
  bool way_back = true;               ///< samples that are deep inside go back to where they came in
  bool poses_at_contact_time = true;  ///< contacts are found at the poses at StepPlan::contact_time
  bool relaxation = true;             ///< sweeps that take back the velocity which pushing overlap out has left
  bool friction_reserve = true;       ///< a stage of settling may let a share of friction hold
  bool gyroscopic = true;             ///< torque of spinning parts whose inertia is not the same about all axes
  bool oriented_boxes = true;         ///< pairs whose oriented boxes are apart are no pairs

  const Softness& softness(Stiffness of) const {
    return of == Stiffness::soft ? soft : of == Stiffness::stiff ? stiff : rigid;
  }
};

struct Body {
  // What never changes.
  std::uint32_t shape = 0;
  float inverse_mass = 0;                                              ///< 0: fixed
  Mat3f inertia = Mat3f::Identity(), inverse_inertia = Mat3f::Zero();  ///< body frame (kg m2)
  float friction = 0.5f, restitution = 0;
  // What the solver touches.
  Vec3f x = Vec3f::Zero(), v = Vec3f::Zero(), w = Vec3f::Zero();
  Vec3f x_rest = Vec3f::Zero(), v_rest = Vec3f::Zero();  ///< what x and v are too coarse for: math.hpp, add_exactly
  Quatf q = Quatf::Identity();
  Mat3f rotation = Mat3f::Identity();  ///< of q when contacts were found
  Mat3f world_inverse_inertia = Mat3f::Zero();
  // Bookkeeping.
  bool present = false, asleep = false;
  bool driven = false;  ///< fixed, and moves on a given path
  float still = 0;      ///< s within rest_move of the reference pose
  Vec3f still_x = Vec3f::Zero();
  Quatf still_q = Quatf::Identity();

  bool moves() const { return present && !asleep && (inverse_mass > 0 || driven); }
};

constexpr int max_contacts = SPHERE_MAX_CONTACTS;
constexpr std::uint32_t ground = SPHERE_GROUND;  ///< body index of the bin's walls and floor

/// One contact point of a manifold. Anchors are in body frames, so that a recycled contact follows both bodies.
struct Contact {
  Vec3f anchor_a = Vec3f::Zero(), anchor_b = Vec3f::Zero();  ///< on the surfaces of a and b (body frames)
  Vec3f local_normal = Vec3f::Zero();  ///< from a to b, in the frame of the body whose field gave it
  std::uint32_t feature = 0;  ///< bit 31: sample of b against field of a; bit 30: edge; rest: node, edge or plane
  float normal_force = 0;     ///< N; not an impulse, because the next sub-step may have another length
  Vec3f friction_force = Vec3f::Zero();  ///< N, on b, world frame
  Vec3f normal = Vec3f::Zero();          ///< of the last solve, world frame
};

struct Manifold {
  std::uint32_t a = 0, b = 0;  ///< a < b; b may be ground
  int color = 0;
  float friction = 0, restitution = 0;
  // Relative pose at which the contacts were found, for recycling; against the ground, the pose of a.
  Vec3f found_x = Vec3f::Zero();
  Quatf found_q = Quatf::Identity();
  bool found = false;
  float depth = 0;                ///< m: deepest of its contacts when the step began, if it is solved in this step
  std::vector<Contact> contacts;  ///< at most max_contacts; carrying a manifold over moves only the vector's handle
};

/// Half space that solids may not enter, up to `top` along +z of the bin (walls) or unbounded (floor).
struct Plane {
  Vec3f normal = Vec3f::UnitZ();
  float offset = 0;  ///< normal . p >= offset outside
  bool wall = false;
};

/// Jaws as the passes use them: bodies that are driven, and whose closing speed contacts slow as if each had this mass.
struct JawPair {
  std::uint32_t first = 0, second = 0;
  Vec3f axis = Vec3f::UnitX(), velocity = Vec3f::Zero();
  float force = 0, speed = 0, mass = 0;
};

/// A force that acts on a body beside gravity.
struct Pull {
  std::uint32_t body = 0;
  Vec3f force = Vec3f::Zero(), arm = Vec3f::Zero();  ///< N, world frame; m from the centre of mass, body frame
};

struct Counters {
  std::uint64_t steps = 0, free_steps = 0, asleep_steps = 0, pairs = 0, pairs_recycled = 0, pairs_asleep = 0,
                pairs_culled = 0, clusters_tested = 0, nodes_tested = 0, nodes_possible = 0, contacts = 0, dropped = 0;

  /// Calls visit(name in the profile, member) for each counter: the only list of them.
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

/// What Solver::take_worst_contact() reports. A manifold's depth is that at the beginning of a step.
struct DeepestContact {
  std::uint32_t a = ground, b = ground;
  float depth = 0, relative = 0;  ///< m; / diagonal of the smaller part
  double time = 0;                ///< s, by World::clock
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
  Frame frame;                            ///< how the bin turns; its gravity is the one above
  bool fine = false;                      ///< fine samples instead of coarse ones
  Stiffness stiffness = Stiffness::soft;  ///< of contacts
  Sleep sleep = Sleep::by_island;         ///< how bodies fall asleep and wake
  float friction_share = 1;               ///< share of friction that acts
  bool exact_impacts = true;              ///< WorldDef::exact_impacts
  bool forgets = false;                   ///< the next step starts without remembered forces
  std::optional<JawPair> jaws;            ///< Solver::set_jaws()
  std::vector<Pull> pulls;                ///< Solver::set_force()
  int cold_steps = 0;                     ///< remaining steps with Settings::cold_sweeps
  int effort = 1;                         ///< factor on sub-steps or sweeps: effort.hpp
  float mass_ratio = 1;                   ///< heaviest part / lightest
  int mass_effort = 1;                    ///< least factor on sweeps of soft and stiff contacts, for unequal masses
  float smallest_size = 0, least_thickness = 0, thinnest = 0;  ///< m, of the parts: Shape::size, thickness, wall
  float whole_step = 0;                                        ///< s: Settings::time_step while no part is fast
  int cuts = 1;  ///< steps for one time step of the request; more than 1 for small parts

  std::vector<Manifold> manifolds, previous;  ///< sorted by (a, b)
  std::vector<std::uint32_t> order;           ///< manifolds with contacts to solve, by color, most contacts first
  Counters counters;
  Spent spent;
  double clock = 0;        ///< s simulated
  DeepestContact deepest;  ///< since the solver was last asked

  const Softness& softness() const { return settings.softness(stiffness); }
  /// Soft contacts sag with the square of the layers above them and stiffen with the square of the sub-steps; therefore
  /// their effort multiplies sub-steps, that of stiff and rigid ones sweeps. With sweeps for both, a deep heap rises by
  /// 1 % of d when it is pressed.
  int refinement() const {
    return stiffness == Stiffness::soft ? effort * softness().refinement : softness().refinement;
  }
  int sweep_effort() const { return stiffness == Stiffness::soft ? mass_effort : std::max(effort, mass_effort); }
  /// m/s: a contact whose speed a sweep changes by more is not solved yet.
  /// @param impact  something closes fast in this step
  float tolerance(bool impact) const {
    const float usual = settings.tolerance * smallest_size;
    return impact && exact_impacts ? std::min(usual, settings.exact_tolerance) : usual;
  }
  /// Most sweeps of a sub-step while an impact is not shared; 0: it is left to the next ones.
  /// @param impact  something closes fast in this step
  int impact_sweeps(bool impact) const {
    if (bodies.size() > settings.impact_bodies || settings.sharing_sweeps == 0) return 0;
    if (!impact) return settings.sharing_sweeps;
    const int sweeps = exact_impacts ? settings.exact_sweeps : settings.impact_sweeps;
    const float wanted = mass_ratio * static_cast<float>(sweeps);
    return static_cast<int>(std::min(wanted, static_cast<float>(settings.most_impact_sweeps)));
  }
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
  const Samples& samples(const Body& b) const { return fine ? shapes[b.shape]->fine : shapes[b.shape]->coarse; }
};

// The passes in the order of a step; each is a file of passes/.
void find_pairs(World& world);       ///< candidate pairs; manifolds of the last step are matched by key
void find_contacts(World& world);    ///< samples against fields, contact reduction, matching of forces
void color_manifolds(World& world);  ///< no two manifolds of a color share a moving body
void solve(World& world);            ///< sub-steps; moves the bodies
void update_sleep(World& world);     ///< puts parts at rest to sleep

void note_depths(World& world);  ///< of the manifolds that this step solves: World::deepest

/// Bodies that are not fixed with contacts with this one, whether they press or not.
std::vector<std::uint32_t> touched_by(const World& world, std::uint32_t body);
void wake(Body& body);
void put_to_sleep(const Settings& settings, Body& body);  ///< where it is

/// One time step.
void step(World& world);

}  // namespace bin_scenes::sphere
