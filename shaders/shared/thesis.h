// Data of the solver `thesis` as shaders and C++ see it. Lengths are in m, in world axes. Data that never changes
// (Body, Shape, Sphere), data that the solver changes (State) and results of a step (the rest) are separate, so that
// saving a step means copying State only.
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

#define THESIS_GROUP 64           // number of invocations in a work group of the passes over spheres or bodies
#define THESIS_BODY_GROUP 32      // number of invocations that add up the impulses of one body

#define THESIS_NO_KEY 0xffffffffu  // key of an empty slot of a neighbour table
#define THESIS_NODE 0x80000000u    // bit of a sphere index or key: it denotes a lattice node of a sheet, or the sheet

// Bits of ThesisStatus.overflow: the list that was too short.
#define THESIS_CONTACT_OVERFLOW 1u
#define THESIS_NEIGHBOUR_OVERFLOW 2u
#define THESIS_SLOT_OVERFLOW 4u

GPU_STRUCTS_BEGIN

struct ThesisSettingsBlock {
  float time_step;        // length of one step (s)
  float bias;             // factor beta of the bias velocity / time_step (1/s)
  float slop;             // depth of overlap that is not removed / radius of the smaller sphere
  uint modified_normals;  // 1: contacts use the normals of the true surface; 0: the lines between centres
  uint bodies;            // number of bodies
  uint spheres;           // number of all spheres; the first moving_spheres of them belong to bodies that move
  uint moving_spheres;
  uint cells;             // number of cells of the collision grids of all worlds
  uint capacity;          // largest number of contacts that are kept for one sphere
  uint neighbour_slots;   // number of slots in the neighbour table of a body, a power of two
  uint slots;             // number of contacts for which there is room, of all spheres together
  uint iterations;        // number of times that the impulse and velocity passes run in a step
};

struct ThesisWorld {
  vec4 gravity;  // acceleration of gravity (m/s2); w: approach speed (m/s) up to which a contact does not bounce
  vec4 origin;   // corner of cell 0; w: 1 / edge length of a cell (1/m)
  uvec4 grid;    // number of cells along x, y, z; w: index of the first cell of this world
  uvec4 sheets;  // x: index of the first sheet, y: number of sheets
};

// A plane of the bin that consists of equal static spheres on a square lattice. The positions of these spheres (nodes)
// are computed near other spheres only and are not stored. An endless floor therefore needs no memory.
struct ThesisSheet {
  vec4 origin;   // origin of the lattice, in the plane of the sphere centres; w: radius of the spheres
  vec4 normal;   // unit normal of the plane, into the bin; w: distance between neighbouring nodes
  vec4 u;        // unit vector of the first lattice axis; w: half extent of the lattice along it
  vec4 v;        // the same for the second lattice axis
  vec4 surface;  // friction, restitution, depth below the plane up to which spheres are pushed back
};

struct ThesisBody {
  vec4 inverse_inertia;  // 1 / principal moments of inertia (1/(kg m2)); w: inverse mass (1/kg), 0 if the body is fixed
  vec4 surface;          // coefficients of friction and restitution
  uvec4 range;           // index of the first sphere of the body, number of its spheres, index of its world
};

struct ThesisState {
  vec4 position;     // position of the centre of mass
  vec4 orientation;  // quaternion x, y, z, w from principal axes to world axes
  vec4 velocity;     // velocity of the centre of mass (m/s)
  vec4 spin;         // angular velocity (rad/s)
};

struct ThesisInertia {  // inverse inertia tensor of a body in world axes (1/(kg m2))
  vec4 diagonal;        // elements xx, yy, zz
  vec4 mixed;           // elements xy, xz, yz
};

struct ThesisShape {  // one sphere of the collision shape of a part
  vec4 center;        // centre relative to the centre of mass, in principal axes; w: radius
  vec4 normal;        // unit normal of the true surface there, in principal axes; w: 1 on a face, 0 at edges, corners
};

struct ThesisSphere {
  uint body, shape;   // index of the body that it belongs to, and index of its ThesisShape
};

struct ThesisSorted {  // a sphere, in the order of the cells of the grid
  vec4 center;   // centre in world axes; w: radius
  uvec4 owner;   // x: index of the sphere, y: index of its body
};

struct ThesisRange {  // the contacts of a sphere
  uint first, count;  // index of the first contact, number of contacts
};

struct ThesisContact {
  vec4 normal;   // unit normal from the other sphere towards this one; w: depth of the overlap
  vec4 arm;      // vector from the centre of mass of this body to the contact point; w: friction of the pair
  uvec4 other;   // x: the other sphere or node; y: key of its body or sheet; z: number of contacts of the two bodies
  vec4 impulse;  // impulse on this body in this iteration (N s)
  vec4 total;    // sum of the impulses of all iterations of the step (N s); w: speed of separation to reach (m/s)
};

struct ThesisPush {  // sum of the impulses at all contacts of a sphere
  vec4 linear;       // N s
  vec4 angular;      // angular impulse about the centre of mass of the body (N m s)
};

struct ThesisNeighbour {  // one slot of the table of a body (shaders/thesis/neighbours.h)
  uint key;    // index of the neighbour, or THESIS_NODE | index of the sheet
  uint count;  // number of contacts with it, minus one, so that a table of words 0xffffffff is empty
};

struct ThesisStatus {
  uint touching_spheres, touching_bodies, slots;  // numbers of spheres and bodies with contacts, and of contacts
  uint overflow;         // THESIS_..._OVERFLOW bits of all steps since the host has reset them
  uint contacts;         // number of contacts, summed over steps
  uint most_slots;       // largest number of contacts that a step needed, up to the first step that had too little room
  uint unused_a, unused_b;
  uvec4 sphere_groups;   // arguments of indirect dispatches over the spheres with contacts
  uvec4 body_groups;     // arguments of indirect dispatches over the bodies with contacts
};

// Room that one world needs. It is counted per world, so that it does not depend on the other worlds of the batch.
struct ThesisNeed {
  uint contacts;    // largest number of contacts of a sphere
  uint neighbours;  // largest number of neighbours of a body; above neighbour_slots, it is a lower bound
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
