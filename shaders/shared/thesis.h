// Data of the solver `thesis` as shaders and C++ see it. Lengths are in m, in world axes. Data that never changes
// (Body, Shape, Sphere), data that the solver changes (State) and data that a step leaves behind (the rest) are
// separate, so that saving a step means copying State only.
#ifndef SHARED_THESIS_H
#define SHARED_THESIS_H
#include "shared/types.h"

// Binding numbers; the same buffer has the same number in every pass.
#define BIND_SETTINGS 0
#define BIND_WORLDS 1
#define BIND_SHEETS 2
#define BIND_BODIES 3
#define BIND_STATES 4
#define BIND_INERTIAS 5
#define BIND_SHAPES 6
#define BIND_SPHERES 7
#define BIND_CENTERS 8
#define BIND_SPHERE_CELLS 9
#define BIND_CELL_COUNTS 10
#define BIND_CELL_STARTS 11
#define BIND_MEMBERS 12
#define BIND_SORTED 13
#define BIND_CONTACT_RANGES 14
#define BIND_CONTACTS 15
#define BIND_NEIGHBOURS 16
#define BIND_NEIGHBOUR_COUNTS 17
#define BIND_TOUCHING_SPHERES 18
#define BIND_TOUCHING_BODIES 19
#define BIND_PUSHES 20
#define BIND_STATUS 21
#define BIND_NEEDS 22

#define THESIS_GROUP 64           // invocations of the passes over spheres or bodies
#define THESIS_BODY_GROUP 32      // invocations that gather one body's impulses

#define THESIS_NO_KEY 0xffffffffu  // empty slot of the neighbour table
#define THESIS_NODE 0x80000000u    // marks a lattice node of a sheet instead of a stored sphere

// Bits of Status.overflow, one per stage.
#define THESIS_CONTACT_OVERFLOW 1u
#define THESIS_NEIGHBOUR_OVERFLOW 2u
#define THESIS_SLOT_OVERFLOW 4u

GPU_STRUCTS_BEGIN

struct ThesisSettingsBlock {
  float time_step;        // s, of one step
  float bias;             // beta / time_step (1/s)
  float slop;             // depth left alone / radius of the smaller sphere
  uint modified_normals;  // 0 or 1
  uint bodies;
  uint spheres;           // all; the first moving_spheres of them belong to bodies that move
  uint moving_spheres;
  uint cells;
  uint capacity;          // contacts kept per sphere
  uint neighbour_slots;   // per body, power of two
  uint slots;             // for the contacts of all spheres together
  uint iterations;        // impulse and velocity passes per step
};

struct ThesisWorld {
  vec4 gravity;  // m/s2; w: normal speed below which restitution is 0
  vec4 origin;   // corner of cell 0; w: 1 / cell edge
  uvec4 grid;    // cells along x, y, z; first cell of this world
  uvec4 sheets;  // first, count
};

// A plane of the bin made of equal static spheres on a square lattice. The nodes are computed where a sphere comes
// near instead of being stored: an endless floor costs nothing.
struct ThesisSheet {
  vec4 origin;   // of the lattice, on the plane of the sphere centres; w: sphere radius
  vec4 normal;   // unit, into the bin; w: lattice pitch
  vec4 u;        // unit, lattice axis; w: half extent along it
  vec4 v;
  vec4 surface;  // friction, restitution, depth below the plane up to which spheres are pushed back
};

struct ThesisBody {
  vec4 inverse_inertia;  // principal moments (1/(kg m2)); w: inverse mass, 0 = fixed
  vec4 surface;          // friction, restitution
  uvec4 range;           // first sphere, spheres, world
};

struct ThesisState {
  vec4 position;     // centre of mass
  vec4 orientation;  // xyzw, principal axes -> world
  vec4 velocity;     // m/s
  vec4 spin;         // rad/s
};

struct ThesisInertia {  // inverse inertia tensor in world axes
  vec4 diagonal;        // xx yy zz
  vec4 mixed;           // xy xz yz
};

struct ThesisShape {  // one sphere of a part's collision shape
  vec4 center;        // principal axes, from the centre of mass; w: radius
  vec4 normal;        // true surface's, principal axes; w: 1 on a face, 0 on edges and corners
};

struct ThesisSphere {
  uint body, shape;
};

struct ThesisSorted {
  vec4 center;   // w: radius
  uvec4 owner;   // sphere, body
};

struct ThesisRange {  // the contacts of a sphere
  uint first, count;
};

struct ThesisContact {
  vec4 normal;   // unit, from the other towards this sphere; w: depth
  vec4 arm;      // contact point from this body's centre of mass; w: friction of the pair
  uvec4 other;   // x: the other sphere or node; y: key of its body or sheet; z: number of contacts of the two bodies
  vec4 impulse;  // kg m/s on this body, of this iteration
  vec4 total;    // of all iterations; w: speed of separation to reach (m/s)
};

struct ThesisPush {  // sum over a sphere's contacts
  vec4 linear;
  vec4 angular;      // about the body's centre of mass
};

struct ThesisNeighbour {
  uint key;    // body, or THESIS_NODE | sheet
  uint count;  // number of contacts minus one, so that filling the table with ones empties it
};

struct ThesisStatus {
  uint touching_spheres, touching_bodies, slots;  // of this step
  uint overflow;         // bits, kept until the host has seen them
  uint contacts;         // summed over steps
  uint most_slots;       // most slots that a step needed, counted up to the first step that had too few
  uint unused_a, unused_b;
  uvec4 sphere_groups;   // arguments of the dispatches over touching spheres ...
  uvec4 body_groups;     // ... and touching bodies
};

// Per world, so that what is reported of a world does not depend on the others of its batch.
struct ThesisNeed {
  uint contacts;    // most contacts any sphere had
  uint neighbours;  // most neighbours any body had; more than the table has slots means at least
};

GPU_STRUCTS_END

#ifdef __cplusplus
namespace bin_scenes::gpu {
static_assert(sizeof(ThesisSettingsBlock) == 48 && sizeof(ThesisWorld) == 64 && sizeof(ThesisSheet) == 80, "std430");
static_assert(sizeof(ThesisBody) == 48 && sizeof(ThesisState) == 64 && sizeof(ThesisInertia) == 32, "std430");
static_assert(sizeof(ThesisShape) == 32 && sizeof(ThesisSphere) == 8 && sizeof(ThesisSorted) == 32, "std430");
static_assert(sizeof(ThesisContact) == 80 && sizeof(ThesisPush) == 32 && sizeof(ThesisNeighbour) == 8, "std430");
static_assert(sizeof(ThesisStatus) == 64 && sizeof(ThesisNeed) == 8 && sizeof(ThesisRange) == 8, "std430");
}  // namespace bin_scenes::gpu
#endif
#endif
