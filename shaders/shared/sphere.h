// Data of the default solver `sphere` as shaders and C++ see it. Lengths are in m and axes are those of the world
// unless stated otherwise. Indices of pairs and manifold slots count within their world, so that all regions of a world
// can be moved together.
#ifndef SHARED_SPHERE_H
#define SHARED_SPHERE_H
#include "shared/sphere/constants.h"
#include "shared/types.h"

// Binding numbers. The same buffer has the same number in every pass.
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
#define BIND_TOUCHES 39

#define SPHERE_JOB_GROUP 64         // invocations of a group that decides about pairs, one pair each
#ifndef SPHERE_PAIR_GROUP
#define SPHERE_PAIR_GROUP 64        // invocations of a group that processes pairs (Capacity::pair_group)
#endif
#ifndef SPHERE_WORLD_GROUP
#define SPHERE_WORLD_GROUP 64       // invocations of a group that processes a world (Capacity::world_group)
#endif
#define SPHERE_PREPARE_GROUP 64     // invocations of a group that prepares rows
#define SPHERE_PREPARE_GROUPS 8u    // number of such groups per world
#define SPHERE_GROUP_JOBS 16        // pairs after which a group ends: llvmpipe lets no invocation make more than 65,535
                                    // iterations in all its loops together, and then silently ends each loop after one
#define SPHERE_MAX_BODIES 384       // bodies of a world that one group can solve: their velocities fill 24 of 32 KiB of
                                    // shared memory
#define SPHERE_RIGID 2u             // index of the softness of rigid contacts, which a probe uses
#define SPHERE_SLEEP_BY_ISLAND 0u  // Phase::Sleep
#define SPHERE_SLEEP_BY_PART 1u
#define SPHERE_SLEEP_BY_TOUCH 2u
#define SPHERE_MAX_CLUSTERS 1024    // largest number of clusters of a part at one resolution
#define SPHERE_CHAINS 8             // a job's candidates form so many linked lists, each of which one invocation reads

#define SPHERE_SAMPLE_KINDS 4u      // kinds of samples that wait apart, so that neighbours do the same work
#define SPHERE_SAMPLE_DESCENDS 0u   // an edge whose deepest point is between its ends
#define SPHERE_SAMPLE_CROSSES 1u    // another edge
#define SPHERE_SAMPLE_SLIDES 2u     // a node of a curved face
#define SPHERE_SAMPLE_RESTS 3u      // another node

#define SPHERE_NO_COLOR 0xffffffffu  // color of a pair without contacts to solve

#define SPHERE_GROUND_BODY SPHERE_MAX_BODIES  // index of the ground of a world, after all bodies

// SphereOrdered.kind.
#define SPHERE_STRIKES 1u    // a contact closes fast enough to bounce
#define SPHERE_BOUNCES 2u    // in addition, the contact has pressed, so that it bounces at the end of the step
#define SPHERE_REFRESHED 4u  // a contact strikes, and neither body is a ball: the contacts are found again in the next
                             // step
#define SPHERE_RESTITUTES 8u // the restitution is above 0

// A row is the data of one contact in three vec4: normal and effective mass along it (kg); lever arm of a and effective
// mass along the tangents; lever arm of b and the gap (m) when the contact was found. The impulses of a contact are
// three vec2 at the same position of a separate buffer, so that rows are not written during sweeps: normal impulse and
// gap (m); friction along x and y; friction along z and the normal impulse with which the sub-step started. The last
// value is negative (-0 for 0) if the contact has pressed in this step.
#define SPHERE_ROW_PARTS 3u
#define SPHERE_ROW_BLOCK 32u  // manifolds whose rows are interleaved part by part, so that the reads of their
                              // invocations are contiguous

// Sweeps of the solve over all manifolds.
#define SWEEP_PUSH 0u
#define SWEEP_RELAX 1u
#define SWEEP_FIRST_PUSH 2u  // from here on, a sweep does more than pushing contacts apart
#define SWEEP_FIRST_RELAX 3u
#define SWEEP_WARM_START 4u  // from here on, a sweep does not push
#define SWEEP_BOUNCE 5u

// Buffers of the samples of a part that no struct describes; shaders/sphere/samples.h reads them.
// An edge is four words: its two nodes, its normal cone, and its length (m, as the bits of a float; negative if no two
// faces meet at the edge). The edges of a part are followed by the lists of the edges near a point (EdgeGrid).
// A normal cone is one word: (index of its vectors after the nodes << 3) | number of its bounds. 0 bounds means all
// directions; SPHERE_AXIS means one axis.

// SphereState.flags.x
#define SPHERE_PRESENT 1u
#define SPHERE_ASLEEP 2u
#define SPHERE_OUTSIDE 4u  // the body has left the bin, and the host removes it

// SphereProgress.overflow: the world stays in the state before the step until the host has enlarged the buffer.
#define SPHERE_PAIR_OVERFLOW 1u
#define SPHERE_CANDIDATE_OVERFLOW 2u
#define SPHERE_ROW_OVERFLOW 4u
#define SPHERE_SAMPLE_OVERFLOW 8u

// SphereAsk.flags, as in WatchAsk (solver/world_watch.hpp). COUNTED: the host has read the counters of SphereProgress.
#define SPHERE_REST_ANEW 1u
#define SPHERE_ENERGY_ANEW 2u
#define SPHERE_DRIVEN 4u
#define SPHERE_COUNTED 8u

#define SPHERE_BLOCKED 0x80000000u  // SphereSeen.left: the world waits until a buffer is enlarged

GPU_STRUCTS_BEGIN

struct SphereSettingsBlock {
  float time_step;         // s, before it is cut
  uint sub_steps;
  float push_speed;        // diagonals of the part per second
  float margin, recycle, rest_move;  // in diagonals
  float restitution_speed; // m/s
  float rest_window;       // s
  uint samples, candidates;  // capacity of these lists
  uint contact_groups;     // number of groups that process pairs at the same time
  float coarse_recycle;    // in diagonals: `recycle` for coarse samples
  uint sweeps;             // sweeps over all contacts before bodies move, and as many after; with rigid contacts, 1
                           // after
  uint cold_sweeps;        // sweeps in the first steps of a world
  float patch_radius;      // in diagonals: radius of contact at a point or along a line
  uint cut_steps;          // 1: steps are shortened for fast parts
  float probe_slip;        // s without friction at the start of a step that begins without forces
  float touch_move;        // in diagonals: rest_move if bodies sleep by touch
  vec4 softness[3];        // by Stiffness: rate (as a share of the sub-step rate), damping ratio, slop (diagonals),
                           // sub-steps in place of one
};

struct SphereWorld {
  uvec4 bodies;   // first body, number of bodies, words in a row of the neighbour bits, first word; the bits are
                  // followed by sphere/listed.h
  uvec4 pairs;    // first pair and capacity; first plane and number of planes
  uvec4 rows;     // first row and capacity; largest number of sweeps while an impact propagates: z in a step with an
                  // impact, w otherwise
  vec4 gravity;   // m/s2; w: size of the smallest part
  vec4 ground;    // friction, restitution, height of the walls (m); w: thickness of the thinnest part (m)
  vec4 tolerance; // m/s: a contact is solved when a sweep changes its speed by no more than this; x in a step without
                  // an impact, y with one
};

// The state of a world between steps. The host reads it every few steps.
struct SphereProgress {
  uint steps_left, steps, overflow, need;    // need: required capacity of the list that overflowed
  uint page, pairs, free_slots, refresh;     // pair list in use and its length; refresh: contacts of the last step are
                                             // invalid
  uint fine, stiffness, ordered, rows;       // samples in use, softness in use, number of manifolds to solve, number of
                                             // rows of the step
  float time_step;                           // s, of this step
  uint cuts_left;                            // shortened steps that are left of a whole step
  uint cold_steps;                           // number of remaining steps with more sweeps (see cold_sweeps)
  float friction_share;                                // factor of all coefficients of friction
  uint forgets;                              // the next step begins without the forces of the last one
  uint refinement, effort;                   // sub-steps in place of one; factor of the number of sweeps
  uint listed;                               // entries of the list of pairs that may come near; 0: the list must be
                                             // made
  uint sleep;                                // how bodies fall asleep and wake: SPHERE_SLEEP_...
  // Counters, since the host last observed it.
  uint asleep_steps, pairs_culled;
  uint free_steps, pairs_tested, pairs_recycled, pairs_asleep;
  uint clusters_tested, nodes_tested, contacts, dropped;
  uint nodes_possible, nodes_possible_high, colors, coloring_rounds;
  uint need_candidates;  // required capacity of the list of candidates
  uint base_colors, base_waste;  // when all manifolds were last colored: number of colors, and how long invocations
                                 // wait for each other
  uint lists_made, colorings;        // counters: lists of pairs that may come near, and colorings of all manifolds
  // When it is read back, the states follow it, so that its size is a multiple of 16 bytes.
};

// The deepest contact of a world since the host last asked for it, and impacts: Solver::take_worst_contact().
struct SphereWorst {
  uint a, b;        // bodies of the world; b may be SPHERE_GROUND
  float depth;      // m
  float relative;   // depth / diagonal of the smaller part; 0: no contact
  float ago;        // s since the start of the step with that contact
  uint unresolved;  // sub-steps whose sweeps ended before an impact was solved
  uint unused0, unused1;
};

// The tasks of a world: steps to simulate, and what to observe (WatchAsk and WatchRules in solver/world_watch.hpp).
struct SphereAsk {
  uint steps, flags, observation;  // observation: number of the requested observation; 0: none
  float seconds;
  uvec4 since;
  vec4 lower;       // m; w: rest_move, diagonals
  vec4 upper;       // m; w: rest_turn, rad
  uint rested, unused0, unused1, unused2;
};

// The results that the host reads after each begin(): WatchSeen, and the remaining steps.
struct SphereSeen {
  uint left;        // remaining steps, and SPHERE_BLOCKED
  uint observation, outside, fast, awake, unrested;
  uint moved01, moved23;  // two counts each, the first one in the lower 16 bits
};

// Data that the observer stores for a body. A position (m) has a second vector with the part that single precision
// loses.
struct SphereWatched {
  vec4 still, still_rest, still_orientation;  // pose to which rest is compared (RestWatch)
  vec4 before, before_rest;  // position at the last observation; w: kinetic energy (J), and speed (m/s)
  vec4 least, least_rest;    // position when the energy of all bodies was lowest; w: kinetic energy then, and the
                             // largest since then (J)
  vec4 audited;              // speed of the body's fastest point at the last observation (m/s); second value: 1 if its
                             // energies are known
};

// The largest gains of energy since their observation started (EnergyReport and WorldEnergy). Observations are
// counted from 1; 0 means that there is no observation.
struct SphereAudit {
  float gain;       // in units of m g d (mass, gravity, diagonal)
  uint gainer, gain_observation;
  float ratio;      // ratio of speeds
  uint thrown, beside, ratio_observation;
  float world_gain;  // in units of m g d summed over the bodies that moved
  uint world_observation;
  uint begins;      // 1: the observation of the total energy starts again with the next observation
  uint unused0, unused1;
};

struct SphereBody {
  uvec4 ids;        // shape, world
  vec4 material;    // inverse mass (0: fixed), friction, restitution, diagonal of the bounding box (m)
};

struct SphereState {
  vec4 position;     // centre of mass (m)
  vec4 orientation;  // x, y, z, w; from body to world axes
  vec4 velocity;     // m/s
  vec4 spin;         // rad/s
  vec4 still_position;     // pose to which rest is compared; w: s spent near it
  vec4 still_orientation;
  vec4 position_rest, velocity_rest;  // the parts of position and velocity that single precision loses: add_exactly
  uvec4 flags;       // bits; label of the island; 1: it was inserted again; last observation in which it moved
                     // (world_watch.hpp)
};

struct SphereTensor {  // values at the time when contacts were found
  vec4 diagonal, mixed;  // inverse inertia, world axes
  vec4 orientation;      // xyzw, body -> world
  vec4 velocity, spin;   // m/s, rad/s
};

struct SpherePlane {
  vec4 plane;        // normal . p >= w outside the solid
  uvec4 wall;        // x: 1 if the plane ends at the height of the walls
};

struct SphereSamples {
  uvec4 nodes;       // first node and count; first edge and count. The nodes are followed by the ends of creases and
                     // the vectors of normal cones
  uvec4 clusters;    // first cluster and count; z: edges from this index on are creases
  uvec4 blocks;      // lists of the edges near a point: first word of the table and of the lists (four words each),
                     // blocks along x, and blocks of a layer along x and y
  vec4 size;         // radius of the nodes, longest piece of an edge, mean distance between neighbours on faces, and
                     // largest height by which a curved face may bulge between its nodes (m)
};

struct SphereShape {
  SphereSamples coarse, fine;
  vec4 box_center;   // body axes; w: largest distance of a node from the centre of mass (m)
  vec4 box_half;     // w: size (m)
  vec4 inertia, inertia_mixed;                  // per mass, body axes: xx yy zz, xy xz yz (m2)
  vec4 inverse_inertia, inverse_inertia_mixed;  // 1/m2
  vec4 origin;       // origin of the field's grid; w: edge length of a cell (m)
  vec4 field;        // 1 / cell, padding, and the radius if the part is a ball
  uvec4 grid;        // numbers of values along x, y, z; index of the first element of its grid in Fields (shape_table.cpp)
};

struct SphereNode {
  vec3 place;        // position in body axes, or a vector of a normal cone
  uint cone;         // normal cone of a node; for an axis, the bits of its spread (rad)
};

struct SphereCluster {
  vec4 ball;         // bounding sphere of the nodes and of the edges that start at them
  uvec4 edges;       // first edge, and end; counted within the part
};

struct SphereBox {     // the upright box that a body does not leave while the list of pairs that may come near is valid
  vec3 center;
  uint first;          // first entry of the list with this body as its first one
  vec3 half_size;      // negative if the body was absent
  uint end;
};

struct SpherePair {
  uint a, b;         // indices among the bodies of all worlds, a < b; b may be SPHERE_GROUND
  uint slot;         // slot of the manifold within the world
  uint color;
};

struct SphereManifold {
  uvec4 state;       // number of contacts, number of pressing contacts, whether they were found, and the expected
                     // number of contact visits of a sweep
  vec3 found_position;     // position of b in the frame of a when contacts were found
  uint unused;
  vec4 found_orientation;
};

// Contact k of a manifold is at index SPHERE_MAX_CONTACTS * (index of the manifold) + k.
struct SphereContact {
  vec3 anchor_a;     // on the surface of a, body axes
  uint feature;
  vec3 anchor_b;
  float approach;    // m/s, negative: the speed with which the surfaces meet if they do so in this step; prepare_rows
                     // writes it
  vec4 normal;       // from a to b, in the frame of the body whose field determined it
  vec4 force;        // N, on b: normal force, and friction in world axes
};

// A manifold that is solved in this step. Manifolds are in order of color; within a color, those that need most contact
// visits come first. Part p of row k of manifold l in a block of `stride` manifolds (SPHERE_ROW_BLOCK, or fewer in the
// last block of a color) is at row + (k SPHERE_ROW_PARTS + p) stride, where row = l + the first row of the block.
// Sweeps solve the contacts that may press (shaders/sphere/near.h).
struct SphereOrdered {
  uint bodies;       // a | b << 16, counted within the world; b may be SPHERE_GROUND_BODY
  uint row;          // index within the world, in vec4
  uint kind;         // flags | contacts << 8 | stride << 12 | a bit for each contact that may press << 24
  float slack;       // m, lower bound of the gaps of all other contacts
  float arm;         // m, longest lever arm of a contact
  float friction;    // coefficient of friction, including the share of the phase
  float yield;       // 1/kg, largest change of the speed at one contact by an impulse at another one
  uint slot;         // of the manifold, in the world
};

// A pair whose contacts are to be found. Its candidates have no order, and no result depends on one.
struct SphereJob {
  uint pair;         // index in the list of pairs
  uint incomplete;   // 1: there was no room for some of its samples or candidates
  uint chains[SPHERE_CHAINS];  // last candidate of each chain; 0: none, as in all chains between steps
};

// A node or an edge of one body of a pair that is near the other body.
struct SphereSample {
  uint job;
  uint feature;      // SPHERE_SIDE_B: it belongs to b
};

// Where such a sample, or its edge, is deepest.
struct SphereTouch {
  uint job;
  uint feature;
  float distance;    // m
  uint unused;
  vec4 point;        // frame of the field
  vec4 gradient;
};

struct SphereCandidate {
  vec3 on_a;         // m, point on the surface of a, in the frame of a
  float separation;  // m
  vec3 normal;       // unit normal from a to b, in the frame of a
  float apart;       // m, distance from the nearest selected candidate; negative: selected, or a duplicate of a
                     // selected one
  uint feature, known;  // known: 1 if it was a contact in the last step
  uint next;         // next candidate of its chain; 0: none
  uint unused;
};

struct SphereStatus {  // stored before the list of jobs
  uint jobs, samples, candidates;  // counts; those of samples and candidates may exceed the capacity
  uint next_job, next_choice, touches;
  uint sample_blocks, unused;        // sample_blocks: groups that test samples of one kind each
  uint sample_kinds[SPHERE_SAMPLE_KINDS];  // counts of each kind (sphere/sample_kinds.h)
  uvec4 groups, sample_groups, touch_groups;  // arguments of indirect dispatches over jobs, samples and touches
};

GPU_STRUCTS_END

#ifdef __cplusplus
namespace bin_scenes::gpu {
static_assert(sizeof(SphereSettingsBlock) == 128 && sizeof(SphereWorld) == 96, "std430");
static_assert(sizeof(SphereProgress) == 160, "std430");
static_assert(sizeof(SphereWorst) == 32 && sizeof(SphereAsk) == 80 && sizeof(SphereSeen) == 32, "std430");
static_assert(sizeof(SphereWatched) == 128 && sizeof(SphereAudit) == 48, "std430");
static_assert(sizeof(SphereBody) == 32 && sizeof(SphereState) == 144 && sizeof(SphereTensor) == 80, "std430");
static_assert(sizeof(SpherePlane) == 32 && sizeof(SphereSamples) == 64 && sizeof(SphereShape) == 272, "std430");
static_assert(sizeof(SphereNode) == 16 && sizeof(SphereBox) == 32, "std430");
static_assert(sizeof(SphereCluster) == 32 && sizeof(SpherePair) == 16 && sizeof(SphereManifold) == 48, "std430");
static_assert(sizeof(SphereContact) == 64 && sizeof(SphereCandidate) == 48, "std430");
static_assert(sizeof(SphereSample) == 8 && sizeof(SphereTouch) == 48 && sizeof(SphereJob) == 40, "std430");
static_assert(sizeof(SphereOrdered) == 32, "std430");
static_assert(sizeof(SphereStatus) == 96, "std430");
}  // namespace bin_scenes::gpu
#endif
#endif
