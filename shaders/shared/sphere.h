// Data of the default solver `sphere` as shaders and C++ see it. Lengths are in m and axes are those of the world
// unless stated otherwise. Indices of pairs and manifold slots count within their world, so that all regions of a world
// can be moved together. The size of a part is its diagonal, at most 50 times its thickness (sphere::Shape::size).
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

#define SPHERE_JOB_GROUP 64         // number of invocations in a group of list_jobs; each of them processes one pair
#ifndef SPHERE_PAIR_GROUP
#define SPHERE_PAIR_GROUP 64        // number of invocations in a group that processes pairs (Capacity::pair_group)
#endif
#ifndef SPHERE_WORLD_GROUP
#define SPHERE_WORLD_GROUP 64       // number of invocations in a group that processes a world (Capacity::world_group)
#endif
#define SPHERE_PREPARE_GROUP 64     // number of invocations in a group of the pass prepare_rows
#define SPHERE_PREPARE_GROUPS 8u    // number of groups of prepare_rows for each world
#define SPHERE_GROUP_JOBS 16        // number of pairs after which a group ends: on llvmpipe, an invocation has at most
                                    // 65,535 iterations in all loops, and then each loop silently ends after one
#define SPHERE_MAX_BODIES 384       // largest number of bodies of a world, which one group solves: their velocities
                                    // fill 24 of 32 KiB of shared memory
#define SPHERE_RIGID 2u             // index of rigid contacts in SphereSettingsBlock.softness; a probe uses them
#define SPHERE_SOFT 0u              // the same of soft contacts
#define SPHERE_SLEEP_BY_ISLAND 0u  // values of SphereProgress.sleep, as in the enumeration Phase::Sleep
#define SPHERE_SLEEP_BY_PART 1u
#define SPHERE_SLEEP_BY_TOUCH 2u
#define SPHERE_MAX_CLUSTERS 1024    // largest number of clusters of a part at one resolution
#define SPHERE_CHAINS 8             // number of linked lists of the candidates of a job; one invocation reads each list

#define SPHERE_SAMPLE_KINDS 4u      // number of kinds of samples; each has a list, so that a warp does equal work
#define SPHERE_SAMPLE_DESCENDS 0u   // kind of a sample: an edge whose deepest point is between its ends
#define SPHERE_SAMPLE_CROSSES 1u    // kind of a sample: any other edge
#define SPHERE_SAMPLE_SLIDES 2u     // kind of a sample: a node of a curved face
#define SPHERE_SAMPLE_RESTS 3u      // kind of a sample: any other node

#define SPHERE_NO_COLOR 0xffffffffu  // color of a pair without contacts to solve

#define SPHERE_GROUND_BODY SPHERE_MAX_BODIES  // index of the ground among the bodies of a world while it is solved

// Flags of a manifold in SphereOrdered.kind.
#define SPHERE_STRIKES 1u    // a contact of the manifold closes fast enough to bounce
#define SPHERE_BOUNCES 2u    // in addition, the contact has pressed, so that it bounces at the end of the step
#define SPHERE_REFRESHED 4u  // a contact strikes, and neither body is a ball: each sub-step computes the lever arms and
                             // masses of the contacts again at the present poses
#define SPHERE_RESTITUTES 8u // the coefficient of restitution of the manifold is above 0

// A row is the data of one contact in three vec4: normal and effective mass along it (kg); lever arm of a (m) and mass
// along the tangents (kg); lever arm of b (m) and gap (m) at the start of the step. The impulses (N s) of a contact are
// three vec2 at the same position of a separate buffer, so that rows are not written during sweeps: normal impulse and
// gap (m); friction along x and y; friction along z and the normal impulse with which the sub-step started. The last
// value is negative (-0 for 0) if the contact has pressed in this step.
#define SPHERE_ROW_PARTS 3u
#define SPHERE_ROW_BLOCK 32u  // number of manifolds whose rows are interleaved part by part, so that their invocations
                              // read contiguous memory

// Kinds of sweeps of the solve over all manifolds.
#define SWEEP_PUSH 0u
#define SWEEP_RELAX 1u
#define SWEEP_FIRST_PUSH 2u  // this kind and the next ones do more than apply normal and friction impulses
#define SWEEP_FIRST_RELAX 3u
#define SWEEP_WARM_START 4u  // this kind and the next one do not solve for normal and friction impulses
#define SWEEP_BOUNCE 5u

// Layout of the buffers of edges and normal cones, for which there is no struct; shaders/sphere/samples.h reads them.
// An edge is four words: its two nodes, its normal cone, and its length (m, as the bits of a float; negative if no two
// faces meet at the edge). The edges of a part are followed by the lists of the edges near a point (EdgeGrid).
// A normal cone is one word: (index of its first vector in the list of nodes << 3) | number of its bounding planes. The
// number 0 stands for a cone of all directions, and SPHERE_AXIS for a circular cone with an axis.

// Bits of SphereState.flags.x.
#define SPHERE_PRESENT 1u
#define SPHERE_ASLEEP 2u
#define SPHERE_OUTSIDE 4u  // the body has left the bin, and the host removes it

// Bits of SphereProgress.overflow: the world stays in the state before the step until the host has enlarged the list.
#define SPHERE_PAIR_OVERFLOW 1u
#define SPHERE_CANDIDATE_OVERFLOW 2u
#define SPHERE_ROW_OVERFLOW 4u
#define SPHERE_SAMPLE_OVERFLOW 8u

// Bits of SphereAsk.flags, as in WatchAsk (solver/world_watch.hpp); COUNTED: counters of SphereProgress restart at 0.
#define SPHERE_REST_ANEW 1u
#define SPHERE_ENERGY_ANEW 2u
#define SPHERE_DRIVEN 4u
#define SPHERE_COUNTED 8u

#define SPHERE_BLOCKED 0x80000000u  // SphereSeen.left: the world waits until a buffer is enlarged

GPU_STRUCTS_BEGIN

struct SphereSettingsBlock {
  float time_step;         // s: length of a step that is not shortened for fast parts
  uint sub_steps;          // number of sub-steps in a step, before SphereProgress.refinement multiplies it
  float push_speed;        // largest speed at which overlap is removed (sizes of the smallest part per second)
  float margin, recycle, rest_move;  // in sizes: search distance of contacts, move that ends recycling, move at rest
  float restitution_speed; // m/s: a slower impact does not bounce
  float rest_window;       // s: a body that stays at rest for this time may fall asleep
  uint samples, candidates;  // capacities of the list of samples and of the list of candidates
  uint contact_groups;     // number of groups that process pairs at the same time
  float coarse_recycle;    // value that replaces `recycle` while coarse samples are used (sizes of the smaller part)
  uint sweeps;             // number of sweeps in a sub-step before bodies move, and as many after; with rigid
                           // contacts, 1 sweep after
  uint cold_sweeps;        // value that replaces `sweeps` in the first steps of a world
  float patch_radius;      // radius of the friction patch of a point or line contact (sizes of the smallest part)
  uint cut_steps;          // 1: steps are shortened for fast parts
  float probe_slip;        // s: time without friction at the start of a probe, which has no remembered forces
  float pressed_recycle;   // value that replaces `recycle` on stiff and rigid contacts (sizes of the smaller part)
  float touch_move;        // value that replaces `rest_move` if bodies sleep by touch (sizes of the part)
  vec4 softness[3];        // by Stiffness: frequency of the contact spring x length of a sub-step, damping ratio, slop
                           // (overlap that remains, in sizes of the smallest part), factor on the number of sub-steps
};

struct SphereWorld {
  uvec4 bodies;   // index of the first body, number of bodies; in the buffer Near: number of words in a row of the
                  // neighbour bits, and index of their first word. The list of pairs follows them (sphere/listed.h)
  uvec4 pairs;    // index of the first pair, and number of pairs for which there is room; first plane, number of planes
  uvec4 rows;     // index of the first row, number of rows for which there is room; largest number of sweeps in a
                  // sub-step until all contacts are solved: z in a step with an impact, w otherwise
  vec4 gravity;   // acceleration of gravity (m/s2); w: size of the smallest part (m)
  vec4 ground;    // friction and restitution of the bin, height of its walls (m), thickness of the thinnest part (m)
  vec4 tolerance; // m/s: a contact is solved when a sweep changes its speed by no more than this; x in a step without
                  // an impact, y with one; z: 1 if impacts are solved exactly, so that they count in the next step too
};

// The state of a world between steps. The host reads it every few steps.
struct SphereProgress {
  uint steps_left, steps, overflow, need;    // steps to do; steps done; full lists; required capacity of the full list
  uint page, pairs, free_slots, refresh;     // pair list in use (0 or 1), its length, unused manifold slots; refresh: 1
                                             // if the contacts of the last step are invalid
  uint fine, stiffness, ordered, rows;       // 1 if the fine samples are used; index of the softness; number of
                                             // manifolds to solve; number of rows that the step needs
  float time_step;                           // s: length of this step
  uint cuts_left;                            // number of shortened steps that remain of a whole step
  uint cold_steps;                           // number of remaining steps with more sweeps (see cold_sweeps)
  float friction_share;                                // factor of all coefficients of friction
  uint forgets;                              // 1: the next step begins without the contact forces of the last one
  uint refinement, effort;                   // factor of the number of sub-steps; factor of the number of sweeps
  uint listed;                               // number of entries in the list of pairs that may come near each other; 0:
                                             // the list must be made
  uint sleep;                                // how bodies fall asleep and wake: SPHERE_SLEEP_...
  // Counters of the work since the host last read this struct.
  uint asleep_steps, pairs_culled;
  uint free_steps, pairs_tested, pairs_recycled, pairs_asleep;
  uint clusters_tested, nodes_tested, contacts, dropped;
  uint nodes_possible, nodes_possible_high, colors, coloring_rounds;
  uint need_candidates;  // required capacity of the list of candidates
  uint base_colors, base_waste;  // when all manifolds were last colored: number of colors, and 1024 x sum over blocks
                                 // of the visits of the longest manifold / number of all visits
  uint lists_made, colorings;        // numbers of lists of near pairs made, and of colorings of all manifolds
  uint struck;  // 1 if the last step had an impact, in a world that solves impacts exactly
  uint unused0, unused1, unused2;
  // The states of bodies follow this struct when it is read back. Its size is therefore a multiple of 16 bytes.
};

// The deepest contact of a world since the host last asked for it (Solver::take_worst_contact()), and unsolved impacts.
struct SphereWorst {
  uint a, b;        // indices of the two bodies in the world; b may be SPHERE_GROUND
  float depth;      // depth of the overlap (m)
  float relative;   // depth / diagonal of the smaller part; 0: no contact
  float ago;        // simulated time since the start of the step with that contact (s)
  uint unresolved;  // number of sub-steps whose sweeps ended before an impact was solved
  uint unused0, unused1;
};

// The tasks of a world: steps to simulate, and what to observe (WatchAsk and WatchRules in solver/world_watch.hpp).
struct SphereAsk {
  uint steps, flags, observation;  // number of steps, SPHERE_REST_ANEW etc., number of the observation (0: none)
  float seconds;    // s since the last observation
  uvec4 since;      // numbers of four observations (WatchAsk::since)
  vec4 lower;       // lower bounds of the bin (m); w: a body that moves farther is not at rest (diagonals of the part)
  vec4 upper;       // upper bounds of the bin (m); w: a body that turns further is not at rest (rad)
  uint rested, unused0, unused1, unused2;  // rested: WatchAsk::rested
};

// The results that the host reads after each begin(): WatchSeen, and the remaining steps.
struct SphereSeen {
  uint left;        // number of dispatches that the remaining steps need if no body becomes faster (24 bits), 0 if none
                    // remain | number of shortened steps of the last whole step << 24 (7 bits) | SPHERE_BLOCKED
  uint observation, outside, fast, awake, unrested;  // members of the same names in WatchSeen
  uint moved01, moved23;  // WatchSeen::moved: two counts in each word, the first one in the lower 16 bits
};

// Data that the observer stores for a body. A position (m) has a second vector with the part that single precision
// loses.
struct SphereWatched {
  vec4 still, still_rest, still_orientation;  // pose near which the body has stayed since it last moved (RestWatch)
  vec4 before, before_rest;  // position at the last observation; before.w: kinetic energy (J); _rest.w: speed (m/s)
  vec4 least, least_rest;    // position when the energy of all bodies was lowest (m); least.w: kinetic energy of the
                             // body at that time (J); least_rest.w: its largest kinetic energy since then (J)
  vec4 audited;              // x: speed of the body's fastest point at the last observation (m/s); y: 1 if the members
                             // above have values
};

// The largest gains of energy since their observation started (EnergyReport and WorldEnergy). Observations are
// counted from 1; 0 means that there is no observation.
struct SphereAudit {
  float gain;       // largest gain of one body, in units of m g d (mass x gravity x diagonal)
  uint gainer, gain_observation;  // index of that body in the world, and number of the observation
  float ratio;      // speed of the body that was thrown / highest earlier speed of the bodies near it
  uint thrown, beside, ratio_observation;  // that body, the body nearest to it, and number of the observation
  float world_gain;  // largest gain of all bodies together, in units of m g d summed over the bodies that moved
  uint world_observation;  // number of the observation with that gain
  uint begins;      // 1: the observation of the total energy starts again with the next observation
  uint unused0, unused1;
};

struct SphereBody {
  uvec4 ids;        // x: index of the shape; y: index of the world
  vec4 material;    // inverse mass (1/kg; 0: fixed), friction, restitution, diagonal of the bounding box (m)
};

struct SphereState {
  vec4 position;     // centre of mass (m)
  vec4 orientation;  // x, y, z, w; from body to world axes
  vec4 velocity;     // velocity of the centre of mass (m/s)
  vec4 spin;         // angular velocity (rad/s)
  vec4 still_position;     // position near which the body has stayed since it last moved (m); w: time spent there (s)
  vec4 still_orientation;  // orientation of the body at that position
  vec4 position_rest, velocity_rest;  // remainders of position and velocity that single precision loses: add_exactly
  uvec4 flags;       // x: SPHERE_PRESENT etc.; y: label of the island + 1, 0: none; z: 1 if the body was inserted again;
                     // w: number of the last observation in which it had moved (world_watch.hpp)
};

struct SphereTensor {  // values of a body at the time when contacts were found
  vec4 diagonal, mixed;  // inverse inertia tensor in world axes (1/(kg m2)): xx, yy, zz, and xy, xz, yz
  vec4 orientation;      // quaternion x, y, z, w from body to world axes
  vec4 velocity, spin;   // velocity of the centre of mass (m/s), angular velocity (rad/s)
};

struct SpherePlane {
  vec4 plane;        // xyz: unit normal, w: offset (m); a point p outside the solid has normal . p >= offset
  uvec4 wall;        // x: 1 if the plane ends at the height of the walls
};

struct SphereSamples {
  uvec4 nodes;       // index of the first node, number of nodes; index of the first edge, number of edges. In the list
                     // of nodes, the ends of creases and the vectors of normal cones follow the nodes
  uvec4 clusters;    // index of the first cluster, number of clusters; z: edges from this number on are creases
  uvec4 blocks;      // lists of the edges near a point: first element of the table and of the lists (four words each),
                     // number of blocks along x, and number of blocks in a layer along x and y
  vec4 size;         // radius of the nodes, longest piece of an edge, mean distance between neighbours on faces, and
                     // largest height by which a curved face may bulge between its nodes (m)
};

struct SphereShape {
  SphereSamples coarse, fine;
  vec4 box_center;   // centre of the bounding box, body axes (m); w: largest distance of a node from the centre of mass
  vec4 box_half;     // half extents of the bounding box (m); w: sphere::Shape::size (m)
  vec4 inertia, inertia_mixed;                  // inertia tensor / mass, body axes: xx yy zz, xy xz yz (m2)
  vec4 inverse_inertia, inverse_inertia_mixed;  // inverse of that tensor, same order (1/m2)
  vec4 origin;       // first point of the field's grid, body axes (m); w: edge length of a cell (m)
  vec4 field;        // 1 / edge length of a cell (1/m), padding of the grid (m), radius of a ball (m; 0: no ball)
  uvec4 grid;        // number of values along x, y, z; index of the first element of the grid in the buffer Fields
};

struct SphereNode {
  vec3 place;        // position in body axes (m), or a unit vector of a normal cone
  uint cone;         // normal cone of a node (see above); for the axis of a cone, its half angle (rad, bits of a float)
};

struct SphereCluster {
  vec4 ball;         // bounding sphere of its nodes and of the edges that start at them: centre (body axes), radius (m)
  uvec4 edges;       // x: number of the first edge that starts at its nodes, y: end of these edges; within the part
};

struct SphereBox {     // the axis-aligned box that a body must not leave while the list of near pairs is valid
  vec3 center;         // m
  uint first;          // index of the first entry of that list with this body as the first one of the pair
  vec3 half_size;      // half extents (m), negative if the body was absent
  uint end;            // end of the entries that begin at `first`
};

struct SpherePair {
  uint a, b;         // indices among the bodies of all worlds, a < b; b may be SPHERE_GROUND
  uint slot;         // slot of the manifold within the world
  uint color;        // color of the manifold, or SPHERE_NO_COLOR
};

struct SphereManifold {
  uvec4 state;       // number of contacts, number of pressing contacts, 1 if contacts were found at the pose below, and
                     // number of visits of contacts that a sweep is expected to need
  vec3 found_position;     // position of b in the frame of a when contacts were found (m); ground: a in the bin frame
  uint unused;
  vec4 found_orientation;  // orientation (x, y, z, w) of b relative to a at that time
};

// Contact k of a manifold is at index SPHERE_MAX_CONTACTS * (index of the manifold) + k.
struct SphereContact {
  vec3 anchor_a;     // contact point on the surface of a, in the frame of a (m)
  uint feature;      // number of the sample, with the bits SPHERE_SIDE_B, SPHERE_EDGE and SPHERE_TURNED
  vec3 anchor_b;     // contact point on the surface of b, in the frame of b (m)
  float approach;    // normal speed with which the surfaces meet if they meet in this step (m/s, negative if they
                     // approach each other); prepare_rows computes it
  vec4 normal;       // unit normal from a to b, in the frame of the body whose field determined it
  vec4 force;        // force on b (N): x: normal force; yzw: friction force in world axes
};

// A manifold that is solved in this step. Manifolds are in order of color; within a color, those that need most contact
// visits come first. Part p of row k of manifold l in a block of `stride` manifolds (SPHERE_ROW_BLOCK, or fewer in the
// last block of a color) is at row + (k SPHERE_ROW_PARTS + p) stride, where row = l + the first row of the block.
// Sweeps solve only the contacts that may press in the present sub-step (shaders/sphere/near.h).
struct SphereOrdered {
  uint bodies;       // a | b << 16, counted within the world; b may be SPHERE_GROUND_BODY
  uint row;          // index of the first row of the manifold within the rows of the world, counted in vec4
  uint kind;         // flags | number of contacts << 8 | stride << 12 | a bit for each contact that may press << 24
  float slack;       // m, lower bound of the gaps of the contacts that cannot press
  float arm;         // m, longest lever arm of a contact of the manifold
  float friction;    // coefficient of friction of the pair, without SphereProgress.friction_share
  float yield;       // 1/kg, largest change of the speed at one contact per unit of impulse at another one
  uint slot;         // slot of the manifold within the world
};

// A pair of bodies whose contacts are found anew in this step. The order of its candidates influences no result.
struct SphereJob {
  uint pair;         // index in the list of pairs
  uint incomplete;   // 1: there was no room for some of the samples or candidates of the pair
  uint chains[SPHERE_CHAINS];  // index of the last candidate of each chain; 0: none, as in all chains between steps
};

// A node or an edge of one body of a pair that is near the other body.
struct SphereSample {
  uint job;          // index of the pair in the list of jobs
  uint feature;      // number of the node or edge | SPHERE_SIDE_B if it belongs to b | SPHERE_EDGE if it is an edge
};

// The point of such a sample, or of its edge, that is deepest in the other body.
struct SphereTouch {
  uint job;          // index of the pair in the list of jobs
  uint feature;      // number of the node or edge, with the bits SPHERE_SIDE_B and SPHERE_EDGE as in SphereSample
  float distance;    // distance of the point from the surface of the other body (m); negative inside
  uint unused;
  vec4 point;        // position in the frame of the other body (m)
  vec4 gradient;     // unit gradient of the distance field of the other body at the point, in its frame
};

struct SphereCandidate {
  vec3 on_a;         // m, point on the surface of a, in the frame of a
  float separation;  // distance of the two surfaces along the normal (m); negative: depth of the overlap
  vec3 normal;       // unit normal from a to b, in the frame of a
  float apart;       // m, distance from the nearest selected candidate; negative: selected, or a duplicate of a
                     // selected one
  uint feature, known;  // as in SphereContact; known: 1 if the last step had a contact with this feature
  uint next;         // index of the next candidate of its chain; 0: none
  uint unused;
};

struct SphereStatus {  // lengths of the lists of a step over all worlds; stored before the list of jobs
  uint jobs, samples, candidates;  // lengths; those of samples and candidates may exceed the capacity
  uint next_job, next_choice, touches;  // next job of collect_samples and of choose_contacts; number of touches
  uint sample_blocks, unused;        // sample_blocks: number of groups of test_samples; each tests samples of one kind
  uint sample_kinds[SPHERE_SAMPLE_KINDS];  // number of samples of each kind (sphere/sample_kinds.h)
  uvec4 groups, sample_groups, touch_groups;  // arguments of indirect dispatches over jobs, samples and touches
};

GPU_STRUCTS_END

#ifdef __cplusplus
namespace bin_scenes::gpu {
static_assert(sizeof(SphereSettingsBlock) == 128 && sizeof(SphereWorld) == 96, "std430");
static_assert(sizeof(SphereProgress) == 176, "std430");
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
