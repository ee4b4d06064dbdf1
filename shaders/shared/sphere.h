// Data of the default solver `sphere` as shaders and C++ see it. Lengths are in m and axes are those of the world
// unless stated otherwise. Indices of pairs and manifold slots count within their world, so that all regions of a world
// can be moved together.
#ifndef SHARED_SPHERE_H
#define SHARED_SPHERE_H
#include "shared/sphere/constants.h"
#include "shared/types.h"

// Binding numbers; the same buffer has the same number in every pass.
#define BIND_SETTINGS 0
#define BIND_RUNNING 1
#define BIND_WORLDS 2
#define BIND_PROGRESS 3
#define BIND_PLANES 4
#define BIND_BODIES 5
#define BIND_STATES 6
#define BIND_TENSORS 7
#define BIND_SHAPES 8
#define BIND_NODES 9
#define BIND_EDGES 10
#define BIND_CLUSTERS 11
#define BIND_FIELDS 12
#define BIND_NEAR 13
#define BIND_RANGES 14
#define BIND_PAIRS 15
#define BIND_FREE 16
#define BIND_MANIFOLDS 17
#define BIND_CONTACTS 18
#define BIND_JOBS 19
#define BIND_CANDIDATES 20
#define BIND_COLORS 21
#define BIND_ORDER 22
#define BIND_BOXES 23
#define BIND_ROWS 31
#define BIND_SAMPLES 32
#define BIND_IMPULSES 33
#define BIND_WORST 34
#define BIND_ASKS 35
#define BIND_WATCHED 36
#define BIND_AUDITS 37
#define BIND_SEEN 38

#define SPHERE_JOB_GROUP 64         // of a group that decides about pairs, one each
#ifndef SPHERE_PAIR_GROUP
#define SPHERE_PAIR_GROUP 64        // of a group that takes pairs: Capacity::pair_group
#endif
#ifndef SPHERE_WORLD_GROUP
#define SPHERE_WORLD_GROUP 64       // of a group that takes a world: Capacity::world_group
#endif
#define SPHERE_PREPARE_GROUP 64     // invocations of a group that prepares rows
#define SPHERE_PREPARE_GROUPS 8u    // of these, of a world
#define SPHERE_GROUP_JOBS 16        // pairs after which a group that takes them ends: llvmpipe lets no invocation take more
                                    // than 65,535 turns in all its loops together, and then silently ends each after one
#define SPHERE_MAX_BODIES 384       // of a world that one group solves: their velocities fill 24 of 32 KiB shared memory
#define SPHERE_RIGID 2u             // of the three kinds of softness, while a heap is probed
#define SPHERE_SLEEP_BY_ISLAND 0u  // Phase::Sleep
#define SPHERE_SLEEP_BY_PART 1u
#define SPHERE_SLEEP_BY_TOUCH 2u
#define SPHERE_MAX_CLUSTERS 1024    // of a part at one resolution
#define SPHERE_CHAINS 14            // of a job's candidates, each walked by one invocation

#define SPHERE_NO_COLOR 0xffffffffu  // of a pair: nothing of it is solved

#define SPHERE_GROUND_BODY SPHERE_MAX_BODIES  // of a world: the ground, behind all bodies

// SphereOrdered.kind.
#define SPHERE_STRIKES 1u    // a contact closes fast enough to bounce
#define SPHERE_BOUNCES 2u    // and has pressed: it bounces at the end of the step
#define SPHERE_REFRESHED 4u  // strikes, and no ball is in it
#define SPHERE_RESTITUTES 8u // a restitution above 0

// A row, by vec4: normal, effective mass along it (kg); lever of a, effective mass along tangents; lever of b, gap when
// contacts were found (m). The impulses of a contact, by vec2 and at the same place of their own buffer, so that sweeps
// only read rows: normal impulse, gap (m); friction along x, y; friction along z, and the normal impulse that the sub-step
// began with, negative (-0 for 0) if the contact has pressed in this step.
#define SPHERE_ROW_PARTS 3u
#define SPHERE_ROW_BLOCK 32u  // manifolds whose rows lie side by side, part by part: their invocations' reads are one

// Sweeps of the solve over all manifolds.
#define SWEEP_PUSH 0u
#define SWEEP_RELAX 1u
#define SWEEP_FIRST_PUSH 2u  // from here on there is more to do than to push contacts
#define SWEEP_FIRST_RELAX 3u
#define SWEEP_WARM_START 4u  // from here on nothing is pushed
#define SWEEP_BOUNCE 5u

// Buffers of a part's samples, which no struct describes (read by shaders/sphere/samples.h):
// An edge is four words: its two nodes, its normal cone, its length (m, bits of a float; negative: no two faces meet
// there). Behind the edges of a part lie the lists of those near a point (EdgeGrid).
// A normal cone is one word: place of its vectors behind the nodes << 3 | how many bounds they are; 0 = all directions,
// SPHERE_AXIS = one axis.

// SphereState.flags.x
#define SPHERE_PRESENT 1u
#define SPHERE_ASLEEP 2u
#define SPHERE_OUTSIDE 4u  // has left the bin; the host takes it out

// SphereProgress.overflow: the world waits, as it was before the step, until the host has made room.
#define SPHERE_PAIR_OVERFLOW 1u
#define SPHERE_CANDIDATE_OVERFLOW 2u
#define SPHERE_ROW_OVERFLOW 4u
#define SPHERE_SAMPLE_OVERFLOW 8u

// SphereAsk.flags: WatchAsk in solver/world_watch.hpp; COUNTED: the host has taken the counters of SphereProgress.
#define SPHERE_REST_ANEW 1u
#define SPHERE_ENERGY_ANEW 2u
#define SPHERE_DRIVEN 4u
#define SPHERE_COUNTED 8u

#define SPHERE_BLOCKED 0x80000000u  // SphereSeen.left: the world waits for room

GPU_STRUCTS_BEGIN

struct SphereSettingsBlock {
  float time_step;         // s, before it is cut
  uint sub_steps;
  float push_speed;        // d per second
  float margin, recycle, rest_move;  // d
  float restitution_speed; // m/s
  float rest_window;       // s
  uint samples, candidates;  // room in the lists of those
  uint contact_groups;     // that take pairs at once
  float coarse_recycle;    // d: `recycle` on coarse samples
  uint sweeps;             // over all contacts before bodies move, and after; SPHERE_RIGID: 1 after
  uint cold_sweeps;        // the same in the first steps of a world
  float patch_radius;      // d: of what presses at a point or along a line
  uint cut_steps;          // 1: for fast parts
  float probe_slip;        // s of a step that begins without forces, without friction
  float touch_move;        // d: rest_move where bodies sleep by touch
  float tolerance;         // d per second: a contact whose speed a sweep changes by more is not solved yet
  vec4 softness[3];        // by Stiffness: rate (of sub-steps), damping ratio, slop (d), sub-steps in place of one
};

struct SphereWorld {
  uvec4 bodies;   // first, count, words of a row of the neighbour bits, first word; behind the bits: sphere/listed.h
  uvec4 pairs;    // first, capacity; planes: first, count
  uvec4 rows;     // first, capacity; most sweeps while an impact is not shared: z: in a step with an impact, w: else
  vec4 gravity;   // m/s2; w: size of the smallest part
  vec4 ground;    // friction, restitution, height where walls end; w: thickness of the thinnest part
};

// What the steps of a world leave behind; the host reads it every few steps.
struct SphereProgress {
  uint steps_left, steps, overflow, need;    // need: places in the list of pairs or of samples that was too short
  uint page, pairs, free_slots, refresh;     // pair list in use, its length; refresh: contacts of last step are void
  uint fine, stiffness, ordered, rows;       // samples in use, softness in use, manifolds to solve, rows of the step
  float time_step;                           // s, of this step
  uint cuts_left;                            // of a whole step
  uint cold_steps;                           // yet to come, with more sweeps
  float friction_share;                                // share of friction that holds
  uint forgets;                              // the next step begins without the forces of the last one
  uint refinement, effort;                   // sub-steps in place of one; times as many sweeps
  uint listed;                               // entries of the list of pairs that may come near; 0: to be made
  uint sleep;                                // how bodies fall asleep and wake: SPHERE_SLEEP_...
  // Counters, since the host last observed it.
  uint asleep_steps, pairs_culled;
  uint free_steps, pairs_tested, pairs_recycled, pairs_asleep;
  uint clusters_tested, nodes_tested, contacts, dropped;
  uint nodes_possible, nodes_possible_high, colors, coloring_rounds;
  uint need_candidates;  // need of the list of candidates
  uint base_colors, base_waste;  // when all were colored anew: colors, and how long invocations wait for one another
  uint lists_made, colorings;        // counters: lists of pairs that may come near, colorings of all manifolds
  // Read back, states lie behind it: vectors begin at multiples of 16 bytes.
};

// The deepest contact of a world since the host last asked for it: Solver::take_worst_contact().
struct SphereWorst {
  uint a, b;        // bodies, counted in the world; b may be SPHERE_GROUND
  float depth;      // m
  float relative;   // depth / diagonal of the smaller part; 0: there was none
  float ago;        // s since the beginning of its step
  uint unused0, unused1, unused2;
};

// What a world is to do and to be observed for: WatchAsk and WatchRules in solver/world_watch.hpp.
struct SphereAsk {
  uint steps, flags, observation;  // observation: 0 = none, or done
  float seconds;
  uvec4 since;
  vec4 lower;       // m; w: rest_move, diagonals
  vec4 upper;       // m; w: rest_turn, rad
  uint rested, unused0, unused1, unused2;
};

// What the host reads after each stretch of steps: WatchSeen, and what is left to do.
struct SphereSeen {
  uint left;        // steps; and SPHERE_BLOCKED
  uint observation, outside, fast, awake, unrested;
  uint moved01, moved23;  // two counts each, the first one in the lower 16 bits
};

// What the watch keeps of a body. Places (m) are positions with what these are too coarse for.
struct SphereWatched {
  vec4 still, still_rest, still_orientation;  // pose from which rest is judged: RestWatch
  vec4 before, before_rest;  // place at the last observation; w: kinetic energy (J), speed (m/s)
  vec4 least, least_rest;    // place when the energy of all was least; w: kinetic energy, the most since then (J)
  vec4 audited;              // speed of its fastest point at the last observation (m/s); 1 = its energies are known
};

// The worst energies since they began anew: EnergyReport and WorldEnergy. Observations by number, 0 = none.
struct SphereAudit {
  float gain;       // m g d
  uint gainer, gain_observation;
  float ratio;      // of speeds
  uint thrown, beside, ratio_observation;
  float world_gain;  // m g d of those that moved
  uint world_observation;
  uint begins;      // 1: the energy of all begins anew with the next observation
  uint unused0, unused1;
};

struct SphereBody {
  uvec4 ids;        // shape, world
  vec4 material;    // inverse mass (0: fixed), friction, restitution, diagonal of the bounding box (m)
};

struct SphereState {
  vec4 position;     // centre of mass
  vec4 orientation;  // xyzw, body -> world
  vec4 velocity;     // m/s
  vec4 spin;         // rad/s
  vec4 still_position;     // pose from which rest is judged; w: s spent near it
  vec4 still_orientation;
  vec4 position_rest, velocity_rest;  // what position and velocity are too coarse for: add_exactly
  uvec4 flags;       // bits; label of the island; 1: it was put in anew; observation in which it moved last (world_watch.hpp)
};

struct SphereTensor {  // when contacts were found
  vec4 diagonal, mixed;  // inverse inertia, world axes
  vec4 orientation;      // xyzw, body -> world
  vec4 velocity, spin;   // m/s, rad/s
};

struct SpherePlane {
  vec4 plane;        // normal . p >= w outside
  uvec4 wall;        // x: 1 = ends at the world's wall top
};

struct SphereSamples {
  uvec4 nodes;       // first, count; edges: first, count. Behind the nodes lie the ends of creases and the vectors of
                     // normal cones
  uvec4 clusters;    // first, count; z: edges from there on are creases
  uvec4 blocks;      // of edges, behind them: first of the table and of the lists (four words each), blocks along x, and
                     // of a layer along x and y
  vec4 size;         // radius of the nodes, longest edge piece, mean distance between neighbours on faces, and by how
                     // much a curved face may bulge between its nodes (m)
};

struct SphereShape {
  SphereSamples coarse, fine;
  vec4 box_center;   // body axes; w: largest distance of a node from the centre of mass
  vec4 box_half;     // w: size (m)
  vec4 inertia, inertia_mixed;                  // per mass, body axes: xx yy zz, xy xz yz (m2)
  vec4 inverse_inertia, inverse_inertia_mixed;  // 1/m2
  vec4 origin;       // of the field's grid; w: cell
  vec4 field;        // 1 / cell, padding, radius if the part is a ball
  uvec4 grid;        // values along x, y, z; first value
};

struct SphereNode {
  vec3 place;        // body axes; or a vector of a normal cone
  uint cone;         // of a node; of an axis the bits of its spread (rad)
};

struct SphereCluster {
  vec4 ball;         // of the nodes and of the edges that start there
  uvec4 edges;       // first, end (of the part)
};

struct SphereBox {     // that a body's upright box does not leave while the list of pairs that may come near holds
  vec3 center;
  uint first;          // entry of the list whose first body it is
  vec3 half_size;      // negative: it was absent
  uint end;
};

struct SpherePair {
  uint a, b;         // bodies (of all worlds), a < b; b may be SPHERE_GROUND
  uint slot;         // of the manifold, in the world
  uint color;
};

struct SphereManifold {
  uvec4 state;       // contacts, those that press, found, visits of contacts that a sweep is expected to need
  vec3 found_position;     // of b in the frame of a when contacts were found
  uint unused;
  vec4 found_orientation;
};

// Contact k of a manifold lies at k behind SPHERE_MAX_CONTACTS times the place of the manifold.
struct SphereContact {
  vec3 anchor_a;     // on the surface of a, body axes
  uint feature;
  vec3 anchor_b;
  float approach;    // speed at which the two meet if they do in this step (m/s), negative: closing; written by prepare_rows
  vec4 normal;       // from a to b, in the frame of the body whose field gave it
  vec4 force;        // on b (N): normal, friction (world axes)
};

// A manifold that is solved in this step, in order of color; of a color those that need most visits of contacts first.
// Manifold l of a block of `stride` (SPHERE_ROW_BLOCK, less in the last block of a color) has part p of its row k at
// row + (k SPHERE_ROW_PARTS + p) stride, row = l + the block's first. Sweeps solve the contacts that may press
// (shaders/sphere/near.h).
struct SphereOrdered {
  uint bodies;       // a | b << 16, counted in the world; b may be SPHERE_GROUND_BODY
  uint row;          // in the world, counted in vec4
  uint kind;         // flags | contacts << 8 | stride << 12 | a bit for each contact that may press << 24
  float slack;       // gap (m) that all other contacts have at least
  float arm;         // longest lever of a contact (m)
  float friction;    // where it holds
  float yield;       // most by which an impulse at a contact changes the speed at another one (1/kg)
  uint slot;         // of the manifold, in the world
};

// A pair whose contacts are to be found. Its candidates are in no order, and none depends on one.
struct SphereJob {
  uint pair;         // place in the list of pairs
  uint incomplete;   // 1: for some of its samples or candidates there was no room
  uint chains[SPHERE_CHAINS];  // last candidate of each; 0 = none, and empty between steps
};

// A node or edge of one body of a pair that is near the other.
struct SphereSample {
  uint job;
  uint feature;      // SPHERE_SIDE_B: of b
};

struct SphereCandidate {
  vec3 on_a;         // frame of a
  float separation;  // m
  vec3 normal;       // a -> b, frame of a
  float apart;       // m: from the nearest chosen candidate; negative: chosen, or a twin of one
  uint feature, known;  // known: 1 = was a contact in the last step
  uint next;         // of its chain; 0 = none: nothing lies there
  uint unused;
};

struct SphereStatus {  // stands before the list of jobs
  uint jobs, samples, candidates;  // how many, of the last two perhaps more than there is room for
  uint next_job, next_choice, unused0, unused1, unused2;
  uvec4 groups, sample_groups;  // arguments of dispatches over jobs and over samples
};

GPU_STRUCTS_END

#ifdef __cplusplus
namespace bin_scenes::gpu {
static_assert(sizeof(SphereSettingsBlock) == 128 && sizeof(SphereWorld) == 80, "std430");
static_assert(sizeof(SphereProgress) == 160, "std430");
static_assert(sizeof(SphereWorst) == 32 && sizeof(SphereAsk) == 80 && sizeof(SphereSeen) == 32, "std430");
static_assert(sizeof(SphereWatched) == 128 && sizeof(SphereAudit) == 48, "std430");
static_assert(sizeof(SphereBody) == 32 && sizeof(SphereState) == 144 && sizeof(SphereTensor) == 80, "std430");
static_assert(sizeof(SpherePlane) == 32 && sizeof(SphereSamples) == 64 && sizeof(SphereShape) == 272, "std430");
static_assert(sizeof(SphereNode) == 16 && sizeof(SphereBox) == 32, "std430");
static_assert(sizeof(SphereCluster) == 32 && sizeof(SpherePair) == 16 && sizeof(SphereManifold) == 48, "std430");
static_assert(sizeof(SphereContact) == 64 && sizeof(SphereCandidate) == 48, "std430");
static_assert(sizeof(SphereSample) == 8 && sizeof(SphereJob) == 64, "std430");
static_assert(sizeof(SphereOrdered) == 32, "std430");
static_assert(sizeof(SphereStatus) == 64, "std430");
}  // namespace bin_scenes::gpu
#endif
#endif
