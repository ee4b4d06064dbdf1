// Provides the samples of one part in the form that the code of shared/sphere reads: nodes, edges and their normal
// cones. Needs sphere/field.h and the bindings Nodes and Edges.
#include "shared/language.h"

#define Samples SphereSamples
#define Plane SpherePlane

float radius_of(Samples samples) { return samples.size.x; }
float face_spacing_of(Samples samples) { return samples.size.z; }
float sag_of(Samples samples) { return samples.size.w; }
vec3 node_at(Samples samples, uint i) { return nodes[samples.nodes.x + i].place; }
uint first_crease(Samples samples) { return samples.clusters.z; }

// A normal cone: index of its first vector in Nodes, and number of its bounds (0: all directions; SPHERE_AXIS: axis).
struct Cone {
  uint at, bounds;
};

Cone cone_of(Samples samples, uint word) { return Cone(samples.nodes.x + (word >> 3), word & 7u); }
Cone cone_at(Samples samples, uint node) { return cone_of(samples, nodes[samples.nodes.x + node].cone); }
uint bounds_of(Cone cone) { return cone.bounds; }
vec3 bound_at(Cone cone, uint i) { return nodes[cone.at + i].place; }
vec3 axis_of(Cone cone) { return nodes[cone.at].place; }
float spread_of(Cone cone) { return uintBitsToFloat(nodes[cone.at].cone); }

struct Edge {
  uint a, b;   // numbers of its nodes
  Cone cone;
  float size;  // length (m)
  uint sharp;  // 1: two faces meet at the edge
};

Edge edge_at(Samples samples, uint e) {
  uvec4 edge = edges[samples.nodes.z + e];
  float size = uintBitsToFloat(edge.w);
  return Edge(edge.x, edge.y, cone_of(samples, edge.z), abs(size), size > 0.0 ? 1u : 0u);
}

float length_of(Edge edge) { return edge.size; }

struct Range {
  uint first, end;
};

uint edge_word(uint first, uint i) { return edges[first + i / 4u][i & 3u]; }
uint listed_edge(Samples samples, uint k) { return edge_word(samples.blocks.y, k); }

// Returns the range of the list of edges near a point (body axes, m); listed_edge() reads its elements.
Range edges_near(Samples samples, Field field, vec3 point) {
  if (field.ball > 0.0) return Range(0u, 0u);
  vec3 g = clamp((point - field.origin) * field.inverse_cell, vec3(0.0), field.most);  // limits NaN as well
  uvec3 block = min(uvec3(g), uvec3(field.most)) / SPHERE_EDGE_BLOCK;
  uint at = block.x + block.y * samples.blocks.z + block.z * samples.blocks.w;
  return Range(edge_word(samples.blocks.x, at), edge_word(samples.blocks.x, at + 1u));
}

vec3 normal_of(Plane plane) { return plane.plane.xyz; }
float offset_of(Plane plane) { return plane.plane.w; }
bool is_wall(Plane plane) { return plane.wall.x != 0u; }

struct Carry {
  mat3 rotation;
  vec3 offset;
};

vec3 carried(Carry carry, vec3 p) { return carry.rotation * p + carry.offset; }

struct Solid {
  bool is_plane;
  Field field;
  Plane plane;
  float top;  // height (m) at which the walls of the bin end
};

Solid solid_of(Field field) { return Solid(false, field, Plane(vec4(0.0), uvec4(0u)), 0.0); }

#include "shared/sphere/cone.h"
#include "shared/sphere/edge.h"
#include "shared/sphere/crease.h"
#include "shared/sphere/slide.h"
