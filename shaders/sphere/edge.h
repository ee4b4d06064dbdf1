// Contacts at sharp edges (Macklin et al. 2020, "Local optimization for robust signed distance field collision"), and
// what the grid of a field rounds off there. Needs sphere/field.h and the bindings Nodes, Edges. Twin:
// edge_contact.cpp.

uint edge_word(uint first, uint i) {
  return edges[first + i / 4u][i & 3u];
}

// First and end of the list of edges that lie near a point: behind both, in words of the buffer of edges.
uvec2 edges_near(SphereSamples other, Field field, vec3 point) {
  if (field.ball > 0.0) return uvec2(0u);
  vec3 g = clamp((point - field.origin) * field.inverse_cell, vec3(0.0), field.most);  // also of NaN
  uvec3 block = min(uvec3(g), uvec3(field.most)) / SPHERE_EDGE_BLOCK;
  uint at = block.x + block.y * other.blocks.z + block.z * other.blocks.w;
  return uvec2(edge_word(other.blocks.x, at), edge_word(other.blocks.x, at + 1u));
}

// Deepest point of the field along an edge; false unless both its ends rise away from the inside. Regula falsi on the
// slope along the edge, which is monotonic where the other surface is convex.
bool descend(Field field, vec3 p, vec3 q, float radius, out vec3 point, out vec3 gradient, out float distance) {
  vec3 along = q - p, gradient_q;
  float lowest = sample_field(field, p, gradient);
  lowest = min(lowest, sample_field(field, q, gradient_q));
  float s0 = dot(gradient, along), s1 = dot(gradient_q, along), t0 = 0.0, t1 = 1.0;
  point = p;
  distance = lowest;
  if (s0 >= 0.0 || s1 <= 0.0) return false;
  for (int i = 0; i < 6; ++i) {
    // Halving every other time keeps the bracket shrinking where the slope jumps (the other part's sharp edge).
    float t = (i & 1) == 1 ? 0.5 * (t0 + t1) : t0 + (t1 - t0) * s0 / (s0 - s1);
    point = p + t * along;
    distance = sample_field(field, point, gradient);
    float slope = dot(gradient, along);
    if (slope < 0.0) {
      t0 = t;
      s0 = slope;
    } else {
      t1 = t;
      s1 = slope;
    }
    if (t1 - t0 < 0.02) break;
  }
  return distance < lowest - radius;
}

// The k-th bound of an edge's normal cone.
vec3 bound_of(SphereSamples other, uvec4 edge, uint k) {
  return nodes[other.nodes.x + (edge.z >> 3) + k].place;
}

// Where the lines p + s u and r + t v are nearest, w = p - r; false where they are parallel to within a degree: nodes
// stand for such edges. `uu`: square of u's length.
bool nearest_points(vec3 u, float uu, vec3 v, vec3 w, out float s, out float t) {
  const float as_parallel = 3e-4;  // square of the sine
  float uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w), det = uu * vv - uv * uv;
  s = (uv * vw - vv * uw) / det;
  t = (uu * vw - uv * uw) / det;
  return det >= as_parallel * uu * vv;
}

// Whether an edge can be pressed along a normal, where `away` is the way out of its part, roughly.
bool presses_between(SphereSamples other, uvec4 edge, vec3 normal, vec3 away) {
  const float least_along = 0.3;  // of the normal along `away`, which may lean, but not to the other side
  const float most_beyond = 0.1;  // of the normal beyond the faces of the edge: 6 degrees
  if (dot(normal, away) < least_along) return false;
  return (edge.z & 7u) == 0u ||
         max(dot(normal, bound_of(other, edge, 0u)), dot(normal, bound_of(other, edge, 1u))) <= most_beyond;
}

// Where the edge from p to q crosses one of the other part: depth and direction are those of the nearest such edge,
// along the common normal of both, if both can be pressed along it. `point`, `gradient`, `distance` are the field's
// answer, and are replaced.
bool cross_edges(SphereSamples other, Field field, vec3 p, vec3 q, inout vec3 point, inout vec3 gradient,
                 inout float distance) {
  vec3 u = q - p, from = point, out_of = gradient;
  float uu = dot(u, u), nearest = min(2.0 * field.cell + abs(distance), SPHERE_EDGE_REACH * field.cell);
  bool found = false;
  uvec2 list = edges_near(other, field, from);
  for (uint k = list.x; k < list.y; ++k) {
    uvec4 edge = edges[other.nodes.z + edge_word(other.blocks.y, k)];
    vec3 r = nodes[other.nodes.x + edge.x].place, v = nodes[other.nodes.x + edge.y].place - r;
    float s, t;
    if (!nearest_points(u, uu, v, p - r, s, t) || s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) continue;
    vec3 on_u = p + s * u, between = on_u - (r + t * v);
    if (length(between) >= nearest) continue;
    vec3 normal = normalize(cross(u, v));
    if (dot(normal, out_of) < 0.0) normal = -normal;
    if (!presses_between(other, edge, normal, out_of)) continue;
    nearest = length(between);
    point = on_u;
    gradient = normal;
    distance = dot(between, normal);
    found = true;
  }
  return found;
}

// Whether a line through a point along a unit direction crosses a sharp edge of the other part within a cell, which can
// be pressed along the `normal` of both. `away`: the way out of the other part, roughly.
bool passes_edge(SphereSamples other, Field field, vec3 point, vec3 direction, vec3 away, out vec3 normal) {
  float nearest = field.cell;
  bool found = false;
  uvec2 list = edges_near(other, field, point);
  for (uint k = list.x; k < list.y; ++k) {
    uvec4 edge = edges[other.nodes.z + edge_word(other.blocks.y, k)];
    if (uintBitsToFloat(edge.w) <= 0.0) continue;  // not sharp
    vec3 r = nodes[other.nodes.x + edge.x].place, v = nodes[other.nodes.x + edge.y].place - r, w = point - r;
    float s, t;
    if (!nearest_points(direction, 1.0, v, w, s, t) || abs(s) > field.cell || t < 0.0 || t > 1.0) continue;
    float way = length(w + s * direction - t * v);
    if (way >= nearest) continue;
    vec3 across = normalize(cross(direction, v));
    if (dot(across, away) < 0.0) across = -across;
    if (!presses_between(other, edge, across, away)) continue;
    nearest = way;
    normal = across;
    found = true;
  }
  return found;
}

// The ways out of a point within a cell of sharp edges, by the planes of the faces that meet there, the shortest first:
// inside all of them each is one, outside there is one, that to the nearest edge or above its face. Returns how many;
// xyz: unit direction, w: m to the surface (negative inside).
uint ways_out_at_edge(SphereSamples other, Field field, vec3 point, out vec4 ways[SPHERE_MAX_WAYS]) {
  const float like = 0.95;  // cosine of normals that count as of one face
  // What stands out past a face by rounding is level with it. More, and what has passed an edge would still stand on
  // the face behind it.
  float flush = 0.002 * field.cell;
  float way_of[SPHERE_MAX_WAYS];  // to the edge that each is of
  float nearest = field.cell;
  vec4 outside = vec4(0.0);
  uint count = 0u;
  uvec2 list = edges_near(other, field, point);
  for (uint k = list.x; k < list.y; ++k) {
    uvec4 edge = edges[other.nodes.z + edge_word(other.blocks.y, k)];
    float size = uintBitsToFloat(edge.w);
    if (size <= 0.0) continue;  // not sharp
    vec3 r = nodes[other.nodes.x + edge.x].place, v = nodes[other.nodes.x + edge.y].place - r, w = point - r;
    float t = dot(w, v) / dot(v, v);
    if (t * size < -flush || (t - 1.0) * size > flush) continue;  // another edge's, or a corner's that is not convex
    vec3 off = w - t * v;
    float way = length(off);
    if (way >= field.cell) continue;
    vec3 into_1 = bound_of(other, edge, 0u), into_2 = bound_of(other, edge, 1u);
    vec3 n1 = normalize(cross(v, into_1)), n2 = normalize(cross(v, into_2));
    if (dot(n1, into_2) > 0.0) n1 = -n1;
    if (dot(n2, into_1) > 0.0) n2 = -n2;
    vec4 faces[2] = vec4[2](vec4(n1, dot(off, n1)), vec4(n2, dot(off, n2)));
    for (uint f = 0u; f < 2u; ++f) {
      uint i = 0u;
      while (i < count && dot(ways[i].xyz, faces[f].xyz) < like) ++i;
      if (i == SPHERE_MAX_WAYS || i < count && way_of[i] <= way) continue;
      ways[i] = faces[f];
      way_of[i] = way;
      count = max(count, i + 1u);
    }
    if (way >= nearest) continue;
    nearest = way;
    if (faces[0].w >= faces[1].w && dot(off, into_1) >= 0.0)  // above a face
      outside = faces[0];
    else if (faces[1].w >= faces[0].w && dot(off, into_2) >= 0.0)
      outside = faces[1];
    else
      outside = way > 0.0 ? vec4(off / way, way) : vec4(normalize(n1 + n2), way);
  }
  bool inside = true;
  for (uint i = 0u; i < count; ++i) inside = inside && ways[i].w <= flush;
  if (!inside) {
    ways[0] = outside;
    return 1u;
  }
  for (uint i = 1u; i < count; ++i)
    for (uint k = i; k > 0u && ways[k].w > ways[k - 1u].w; --k) {
      vec4 longer = ways[k - 1u];
      ways[k - 1u] = ways[k];
      ways[k] = longer;
    }
  return count;
}
