/// One world of the default sphere solver: what never changes, what the passes touch, and bookkeeping. No pass
/// allocates in the steady state, and every list is ordered by keys, so the same world gives the same bits whatever
/// runs beside it.
///
///   bodies ──find_pairs──► pairs ──find_contacts──► manifolds ──color──► solve ──► bodies
///                            └ kept over steps: forces (warm start), contacts of pairs that hardly move (recycled)
///
/// Poses are of the centre of mass, in single precision, relative to the world's origin.
#pragma once

#include "bin_scenes/solver/solver.hpp"
#include "solver/sphere/shapes/shape.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes::sphere {

/// How contacts give way.
struct Softness {
  float hertz_share;    ///< contact frequency / sub-step rate; lower = piles sag, higher = less is lost while rocking
  float damping_ratio;  ///< of soft contacts; below 1 they ring
  float slop;           ///< d left overlapping, so that contacts persist
  int refinement;       ///< sub-steps in place of one; overlap under load falls with its square, cost rises with it
};

using Sleep = Phase::Sleep;

/// Settings as the passes use them (m, s); lengths follow from the smallest part's size d.
///
/// What each gives is measured by taking it away (bench/ablation.cpp): most by a number below, the others by a switch.
struct Settings {
  float time_step = 1.0f / 400;  ///< one collision detection
  bool cut_steps = true;         ///< for small and fast parts
  int sub_steps = 4;             ///< contact solves per time step; stiffness of contacts grows with its square
  int sweeps = 2;                ///< over all contacts before bodies move, and after if not rigid; with 1 stacks sway
  int cold_sweeps = 4;  ///< the same in the first steps of a world, and of a probe, when contacts have no forces
  int cold_steps = 50;  ///< such steps; with none, stacks that begin at rest sway by up to 2 % before forces are known
  int pressed_cold_steps = 10;  ///< the same of a press after a probe: what stood there finds its forces sooner
  float layers = 4.5f;  ///< of a heap that this work does for, one of twice as many gets twice as much (World::effort);
                        ///< more = parts deep in a bin never rest, as loads travel about a layer a sweep
  float sag = 0.024f;  ///< of the thinnest part: layers x gravity x the square of a sub-step, for which this work does;
                       ///< four times as much gets twice as much; more = thin parts sink in for good
  float weighed_sag = 0.1f;    ///< the same of each part under heavier ones; more = light parts are pressed through
  float most_for_weights = 8;  ///< times as much work at most for it; more = a heavy part among crumbs costs more
  float tower = 0.16f;         ///< work for parts on each other one by one, over their number to the power of 1.5;
                               ///< less = twenty cubes sway for ever
  float most_for_towers = 60;  ///< times as much work at most for it: of some 50; more = sheets in piles cost more
  Softness soft{0.25f, 10.0f, 2e-4f, 1};     ///< of contacts while bodies move: takes the energy out of rocking
  Softness stiff{0.35f, 10.0f, 2.5e-5f, 4};  ///< of contacts while they are pressed: leaves no overlap
  /// Of contacts while a heap is probed: they give way to nothing, and let a 160th of their overlap out in a sub-step.
  /// What stiff ones press apart is squeezed, and holds by friction where nothing else holds it.
  Softness rigid{1.0f, 500.0f, 0.0f, 4};
  float patch_radius = 1e-3f;    ///< d: of what presses at a point or along a line; resists spin and rolling there.
                                 ///< 0: what two points hold swings about them without end; larger: wheels stop
  float push_speed = 4.0f;       ///< d per second at which overlap is pushed out, over refinement; higher = popping
  float margin = 4e-3f;          ///< d: contacts are kept while closer than this, plus the way of one step
  float press_margin = 2e-3f;    ///< d: of them, those without force that are farther apart than this, plus that way,
                                 ///< are left out of the step's solve; smaller = what is pushed there sinks in first
  float recycle = 1e-3f;         ///< d: contacts of a pair are reused until it moved this far
  float coarse_recycle = 3e-3f;  ///< d: the same on coarse samples, where precision is not wanted yet
  float probe_slip = 2.5e-3f;    ///< s of a probe without friction, in its first step: weight finds its way without;
                                 ///< longer = heaps are shaken, shorter = wedged parts hold that would slip
  float restitution_speed = 0.05f;  ///< m/s: slower approaches do not bounce
  float rest_window = 0.1f;         ///< s over which a sleeping body must have stayed
  float rest_move = 1e-4f;          ///< d within which it must have stayed
  float touch_move = 5e-4f;  ///< d: the same where bodies sleep by touch, and way at which they wake others; less
                             ///< = a pick wakes more of the heap, more = what creeps is frozen

  // Switches of what no number turns off, on in every request.
  bool warm_start = true;      ///< a step begins with the forces of the last one
  bool speculation = true;     ///< contacts that may close in a step are found before they do
  bool soonest_first = true;   ///< of a pair's contacts those about to close go before those farther off
  bool way_back = true;        ///< samples that are deep inside go back the way they came in
  bool half_way_poses = true;  ///< contacts are found where bodies are half way through the step
  bool relaxation = true;      ///< sweeps that take back the velocity which pushing overlap out has left
  bool friction_reserve = true;  ///< a stage of settling may let a share of friction hold
  bool gyroscopic = true;      ///< torque of spinning parts whose inertia is not the same about all axes
  bool oriented_boxes = true;  ///< pairs whose oriented boxes are apart are no pairs

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
  Quatf q = Quatf::Identity();
  Mat3f rotation = Mat3f::Identity();  ///< of q when contacts were found
  Mat3f world_inverse_inertia = Mat3f::Zero();
  // Bookkeeping.
  bool present = false, asleep = false;
  float still = 0;  ///< s within rest_move of the reference pose
  Vec3f still_x = Vec3f::Zero();
  Quatf still_q = Quatf::Identity();

  bool moves() const { return present && !asleep && inverse_mass > 0; }
};

constexpr int max_contacts = 8;                ///< per pair, after reduction; on more, faces on each other sway
constexpr std::uint32_t ground = 0xffffffffu;  ///< body index of the bin's walls and floor

/// One point of a manifold. Anchors are in body frames, so that a recycled contact follows both bodies.
struct Contact {
  Vec3f anchor_a = Vec3f::Zero(), anchor_b = Vec3f::Zero();  ///< on the surfaces of a and b (body frames)
  Vec3f local_normal = Vec3f::Zero();  ///< from a to b, in the frame of the body whose field gave it
  std::uint32_t feature = 0;  ///< bit 31: sample of b against field of a; bit 30: edge; rest: node, edge or plane
  float normal_force = 0;     ///< N, not an impulse: the next sub-step may be of another length
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
  std::vector<Contact> contacts;  ///< at most max_contacts; a manifold that is carried over moves only its handle
  std::uint32_t solved = 0;       ///< of them, the first so many: the others are too far apart to press in this step
};

/// Half space that solids may not enter, up to `top` along +z of the bin (walls) or unbounded (floor).
struct Plane {
  Vec3f normal = Vec3f::UnitZ();
  float offset = 0;  ///< normal . p >= offset outside
  bool wall = false;
};

struct Counters {
  std::uint64_t steps = 0, free_steps = 0, asleep_steps = 0, pairs = 0, pairs_recycled = 0, pairs_asleep = 0,
                pairs_culled = 0, groups_tested = 0, clusters_tested = 0, nodes_tested = 0, nodes_possible = 0,
                contacts = 0, contacts_solved = 0, dropped = 0;

  Counters& operator+=(const Counters& c) {
    steps += c.steps, free_steps += c.free_steps, asleep_steps += c.asleep_steps, pairs += c.pairs,
        pairs_recycled += c.pairs_recycled;
    pairs_asleep += c.pairs_asleep, pairs_culled += c.pairs_culled, groups_tested += c.groups_tested,
        clusters_tested += c.clusters_tested;
    nodes_tested += c.nodes_tested, nodes_possible += c.nodes_possible, contacts += c.contacts;
    contacts_solved += c.contacts_solved, dropped += c.dropped;
    return *this;
  }
};

/// Wall time of the passes so far (ms), by file; the profile shows it, nothing else looks at it.
struct Spent {
  double find_pairs = 0, find_contacts = 0, color_manifolds = 0, solve = 0, update_sleep = 0;
};

struct World {
  Settings settings;
  std::vector<const Shape*> shapes;
  std::vector<Body> bodies;
  std::vector<Plane> planes;
  float wall_top = 0;
  float ground_friction = 0.5f, ground_restitution = 0;
  Vec3f gravity = Vec3f(0, 0, -9.81f);
  bool fine = false;                      ///< exact samples
  Stiffness stiffness = Stiffness::soft;  ///< of contacts
  Sleep sleep = Sleep::by_island;         ///< how bodies fall asleep and wake
  float grip = 1;                         ///< share of friction that holds
  bool forgets = false;                   ///< the next step begins without the forces of the last one
  int cold_steps = 0;                     ///< yet to come, with Settings::cold_sweeps
  int effort = 1;                         ///< times as much work on contacts: effort.hpp
  float smallest_size = 0, thinnest = 0;  ///< m, of the parts: Shape::size, Shape::thickness
  float whole_step = 0;                   ///< s: Settings::time_step while nothing is fast
  int cuts = 1;                           ///< whole steps for one of the request: small parts need short ones

  std::vector<Manifold> manifolds, previous;  ///< sorted by (a, b)
  std::vector<std::uint32_t> order;           ///< manifolds with contacts to solve, by color, most contacts first
  Counters counters;
  Spent spent;

  const Softness& softness() const { return settings.softness(stiffness); }
  /// Soft contacts sag with the square of the layers above them and stiffen with that of the sub-steps: their effort is
  /// sub-steps, that of others sweeps. With sweeps for both, a deep heap jumps up by a hundredth of d when it is
  /// pressed.
  int refinement() const {
    return stiffness == Stiffness::soft ? effort * softness().refinement : softness().refinement;
  }
  int sweep_effort() const { return stiffness == Stiffness::soft ? 1 : effort; }
  int sub_steps() const { return settings.sub_steps * refinement(); }
  /// Of the next step, over all contacts before bodies move, and after.
  int sweeps() const { return sweep_effort() * (cold_steps > 0 ? settings.cold_sweeps : settings.sweeps); }
  /// Rigid contacts push slowly: one takes back what that leaves. With none a gear on its teeth rolls for ever.
  int relaxing_sweeps() const {
    if (!settings.relaxation) return 0;
    return stiffness == Stiffness::rigid ? 1 : sweeps();
  }
  float sub_step() const { return settings.time_step / static_cast<float>(sub_steps()); }  ///< s
  /// Of the next step, in which nothing holds by friction.
  int slip_sub_steps() const {
    const bool slips = forgets && stiffness == Stiffness::rigid && settings.probe_slip > 0;
    return slips ? std::max(1, static_cast<int>(settings.probe_slip / sub_step() + 0.5f)) : 0;
  }
  /// s from the start of a step to the mean of its sub-steps' beginnings. Contacts are found, and have their levers and
  /// normals, where bodies are then, as in the symplectic Euler method over the sub-steps, which keeps energy: with
  /// those of the start what rolls on an edge is pushed on by the point that it has left.
  float half_way() const { return settings.half_way_poses ? 0.5f * (settings.time_step - sub_step()) : 0; }
  bool is_ball(const Body& b) const { return shapes[b.shape]->field.ball > 0; }
  const Samples& samples(const Body& b) const { return fine ? shapes[b.shape]->fine : shapes[b.shape]->coarse; }
};

// The passes, in order of a step, one file of passes/ each.
void find_pairs(World& world);       ///< candidates, manifolds carried over by key
void find_contacts(World& world);    ///< samples against fields, reduced, forces matched
void color_manifolds(World& world);  ///< no two manifolds of a color share a moving body
void solve(World& world);            ///< sub-steps, moves the bodies
void update_sleep(World& world);     ///< what rests sleeps

/// Bodies with contacts with this one, whether they press or not; fixed ones left out.
std::vector<std::uint32_t> touched_by(const World& world, std::uint32_t body);
void wake(Body& body);
void put_to_sleep(const Settings& settings, Body& body);  ///< where it is

/// One time step.
void step(World& world);

}  // namespace bin_scenes::sphere
