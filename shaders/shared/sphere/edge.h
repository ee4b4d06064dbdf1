// Contacts at sharp edges (Macklin et al. 2020, "Local optimization for robust signed distance field collision"). The
// grid of a distance field rounds edges off: within one cell of an edge, its gradient is tilted by up to half the angle
// between the faces, and its depth belongs to neither face. Where an edge of one part meets an edge or a corner of the
// other, depth and normal are therefore computed from the edges themselves.
//
// The includer defines before: field.h, cone.h, Samples, node_at(samples, i), cone_at(samples, i), Edge (a, b: nodes;
// cone; length in m; sharp: two faces meet there, into which the first two bounds of the cone point), edge_at(samples,
// e), and edges_near(samples, field, point): a Range of listed_edge(samples, k) in ascending order. Edges from
// first_crease(samples) on fold inwards: crease.h.

INLINE bool is_crease(IN(Samples) samples, uint e) {
  return e >= first_crease(samples);
}

// The position of a sample in the frame of the field (m), with distance (m) and unit gradient of the field there.
struct Touch {
  vec3 point, gradient;
  float distance;
};

// Finds the deepest point of the field along the edge from p to q. Returns false if the depth does not increase from
// both ends, or if the point is no deeper than an end, so that it needs no contact of its own.
INLINE bool descend(IN(Field) field, IN(Touch) p, IN(Touch) q, INOUT(Touch) touch) {
  // Regula falsi on the slope along the edge, which is monotonic where the other surface is convex.
  vec3 along = q.point - p.point;
  float s0 = dot(p.gradient, along), s1 = dot(q.gradient, along), t0 = 0.0f, t1 = 1.0f;
  if (s0 >= 0.0f || s1 <= 0.0f) return false;
  for (int i = 0; i < 6; ++i) {
    // Halving every other time keeps the bracket shrinking where the slope jumps (the other part's sharp edge).
    float t = (i & 1) == 1 ? 0.5f * (t0 + t1) : t0 + (t1 - t0) * s0 / (s0 - s1);
    touch.point = p.point + t * along;
    touch.distance = sample_field(field, touch.point, touch.gradient);
    float slope = dot(touch.gradient, along);
    if (slope < 0.0f) {
      t0 = t;
      s0 = slope;
    } else {
      t1 = t;
      s1 = slope;
    }
    if (t1 - t0 < 0.02f) break;
  }
  return touch.distance < min(p.distance, q.distance);
}

// Finds the nearest points of the lines p + s u and r + t v, with w = p - r. Returns false if the lines are parallel to
// within a degree: such edges are represented by their nodes. `uu`: squared length of u.
INLINE bool nearest_points(IN(vec3) u, float uu, IN(vec3) v, IN(vec3) w, OUT(float) s, OUT(float) t) {
  const float as_parallel = 3e-4f;  // squared sine of the angle below which lines count as parallel
  float uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w), det = uu * vv - uv * uv;
  s = (uv * vw - vv * uw) / det;
  t = (uu * vw - uv * uw) / det;
  return det >= as_parallel * uu * vv;
}

// Returns whether a contact may press on an edge along a normal. `away`: unit direction roughly out of the edge's part.
INLINE bool presses_between(IN(Edge) edge, IN(vec3) normal, IN(vec3) away) {
  const float least_along = 0.3f;  // smallest component of the normal along `away`: the normal may be tilted, but not
                                   // to the other side
  const float most_beyond = 0.1f;  // largest component of the normal along a bound of the edge's cone: 6 degrees
  if (dot(normal, away) < least_along) return false;
  return bounds_of(edge.cone) == 0u ||
         max(dot(normal, bound_at(edge.cone, 0u)), dot(normal, bound_at(edge.cone, 1u))) <= most_beyond;
}

// Returns the unit vector that is perpendicular to u and v and has a positive component along `away`.
INLINE vec3 common_normal(IN(vec3) u, IN(vec3) v, IN(vec3) away) {
  vec3 normal = unit(cross(u, v));
  if (dot(normal, away) < 0.0f) normal = -normal;
  return normal;
}

// Returns whether a point is beside an edge and not past one of its ends (`flush`: tolerance, m). `along`: vector from
// end a to end b of the edge (m); `off`: vector from the line of the edge to the point (m).
INLINE bool is_beside(IN(Samples) samples, IN(Edge) edge, IN(vec3) point, float flush, OUT(vec3) along, OUT(vec3) off) {
  IN(vec3) a = node_at(samples, edge.a);
  along = node_at(samples, edge.b) - a;
  vec3 from_end = point - a;
  float t = dot(from_end, along) / dot(along, along);
  off = from_end - t * along;
  return t * length_of(edge) >= -flush && (t - 1.0f) * length_of(edge) <= flush;
}

// Outward unit normals of the two faces that meet at a sharp edge.
struct Faces {
  vec3 normal_1, normal_2;
};
INLINE Faces faces_at(IN(Cone) cone, IN(vec3) along) {
  vec3 into_1 = bound_at(cone, 0u), into_2 = bound_at(cone, 1u);
  Faces faces;
  faces.normal_1 = common_normal(along, into_1, -into_2);
  faces.normal_2 = common_normal(along, into_2, -into_1);
  return faces;
}

// Returns the tolerance (m) within which a point counts as level with a face; rounding is below it. With a larger
// tolerance, a point that has passed an edge would still be supported by the face behind the edge.
INLINE float flush_in(IN(Field) field) {
  return 0.002f * field.cell;
}

// Returns whether a point is outside a face of `other` that ends at a sharp edge within one cell. The distance field
// cannot decide this in a tip that is thinner than its cells.
INLINE bool is_outside(IN(Samples) other, IN(Field) field, IN(vec3) point) {
  float flush = flush_in(field);
  Range list = edges_near(other, field, point);
  for (uint k = list.first; k < list.end && !is_crease(other, listed_edge(other, k)); ++k) {
    IN(Edge) edge = edge_at(other, listed_edge(other, k));
    vec3 along, off;
    if (edge.sharp == 0u || !is_beside(other, edge, point, flush, along, off) || length(off) >= field.cell) continue;
    Faces faces = faces_at(edge.cone, along);
    if (max(dot(off, faces.normal_1), dot(off, faces.normal_2)) > flush) return true;
  }
  return false;
}

// Returns whether an edge ends at a saddle, a vertex where a concave edge ends as well: at end a, or otherwise at end
// b. The normal cone of a convex corner is bounded by its edges, that of a saddle by their faces (sample_draft.cpp).
INLINE bool ends_at_saddle(IN(Samples) samples, IN(Edge) edge, bool at_a) {
  const float parallel = 0.999f;  // cosine of 2.6 degrees
  vec3 along = node_at(samples, edge.b) - node_at(samples, edge.a);
  if (!at_a) along = -along;
  Cone cone = cone_at(samples, at_a ? edge.a : edge.b);
  uint bounds = bounds_of(cone);
  if (bounds == SPHERE_AXIS || bounds == 0u) return false;
  for (uint i = 0u; i < bounds; ++i)
    if (dot(bound_at(cone, i), along) > parallel * length_of(edge)) return false;
  return true;
}

// Returns whether a crossing at the share `s` of the line of an edge counts as one with the edge: between its ends, or
// nearer than `beyond` (m) to an end at a saddle. There, another edge may lie on one face of the concave edge and meet
// the edge of the other face: it crosses that edge at its very end, or just beyond it, since contacts are found before
// the first face has stopped the other edge.
INLINE bool meets_edge(IN(Samples) samples, IN(Edge) edge, float s, float beyond) {
  float past = max(-s, s - 1.0f);
  if (past <= 0.0f) return true;
  return edge.sharp != 0u && past * length_of(edge) < beyond && ends_at_saddle(samples, edge, s < 0.0f);
}

const uint NO_EDGE = 0xffffffffu;

// Finds the nearest edge of the other part that an own edge crosses, and on which a contact may press along the common
// normal of both edges. `p`, `q`: ends a and b of the own edge, frame of the field. `touch` contains the point and the
// gradient of the field, and gets point, normal and distance of the crossing. Returns the number of the other edge.
// Returns NO_EDGE, and leaves `touch` unchanged, if there is no such edge.
INLINE uint cross_edges(IN(Samples) own, IN(Edge) own_edge, IN(Samples) other, IN(Field) field, IN(vec3) p, IN(vec3) q,
                        INOUT(Touch) touch) {
  vec3 u = q - p, from = touch.point, out_of = touch.gradient;
  float uu = dot(u, u), beyond = 2.0f * field.cell;
  float nearest = min(beyond + abs(touch.distance), SPHERE_EDGE_REACH * field.cell);
  uint crossed = NO_EDGE;
  Range list = edges_near(other, field, from);
  for (uint k = list.first; k < list.end && !is_crease(other, listed_edge(other, k)); ++k) {
    IN(Edge) edge = edge_at(other, listed_edge(other, k));
    vec3 r = node_at(other, edge.a), v = node_at(other, edge.b) - r;
    float s, t;
    if (!nearest_points(u, uu, v, p - r, s, t)) continue;
    if (!meets_edge(own, own_edge, s, beyond) || !meets_edge(other, edge, t, beyond)) continue;
    vec3 on_u = p + s * u, between = on_u - (r + t * v);
    float apart = length(between);
    if (apart >= nearest) continue;
    vec3 normal = common_normal(u, v, out_of);
    if (!presses_between(edge, normal, out_of)) continue;
    // For a tip beside another tip, the far edges would push it back through the other tip.
    if (dot(between, normal) < -flush_in(field) && is_outside(other, field, on_u)) continue;
    nearest = apart;
    touch.point = on_u;
    touch.gradient = normal;
    touch.distance = dot(between, normal);
    crossed = listed_edge(other, k);
  }
  return crossed;
}

// Returns whether a line through a point along a unit direction crosses a sharp edge of the other part within one cell,
// and a contact may press there along the common normal, which it stores. `away` points roughly out of the other part.
INLINE bool passes_edge(IN(Samples) other, IN(Field) field, IN(vec3) point, IN(vec3) direction, IN(vec3) away,
                        INOUT(vec3) normal) {
  float nearest = field.cell;
  bool found = false;
  Range list = edges_near(other, field, point);
  for (uint k = list.first; k < list.end && !is_crease(other, listed_edge(other, k)); ++k) {
    IN(Edge) edge = edge_at(other, listed_edge(other, k));
    if (edge.sharp == 0u) continue;
    vec3 r = node_at(other, edge.a), v = node_at(other, edge.b) - r, w = point - r;
    float s, t;
    if (!nearest_points(direction, 1.0f, v, w, s, t) || abs(s) > field.cell || t < 0.0f || t > 1.0f) continue;
    float apart = length(w + s * direction - t * v);
    if (apart >= nearest) continue;
    vec3 across = common_normal(direction, v, away);
    if (!presses_between(edge, across, away)) continue;
    nearest = apart;
    normal = across;
    found = true;
  }
  return found;
}

// Returns whether a point of the surface of `other` is within half a cell of a sharp edge or of a corner where such
// edges end.
INLINE bool is_on_edge(IN(Samples) other, IN(Field) field, IN(vec3) point) {
  float near = 0.5f * field.cell;
  Range list = edges_near(other, field, point);
  for (uint k = list.first; k < list.end && !is_crease(other, listed_edge(other, k)); ++k) {
    IN(Edge) edge = edge_at(other, listed_edge(other, k));
    if (edge.sharp == 0u) continue;
    vec3 r = node_at(other, edge.a), v = node_at(other, edge.b) - r, w = point - r;
    vec3 off = w - min(max(dot(w, v) / dot(v, v), 0.0f), 1.0f) * v;
    if (dot(off, off) < near * near) return true;
  }
  return false;
}

const uint OF_A_FACE = 0u, TO_AN_EDGE = 1u, BY_THE_FIELD = 2u;

// An exit: a unit direction in which a point leaves a part, and its distance from the surface (m, negative inside).
struct Exit {
  vec3 away;
  float distance;
  uint number;  // index of the wall of a crease, so that the contacts of a point have different features; otherwise 0
  uint kind;    // origin of the direction: OF_A_FACE (normal of a face), TO_AN_EDGE (direction to an edge, which may
                // deviate from the normals of its faces), BY_THE_FIELD (gradient of the field: face or edge)
};

INLINE Exit exit_of(uint kind, IN(vec3) away, float distance) {
  Exit exit;
  exit.away = away;
  exit.distance = distance;
  exit.number = 0u;
  exit.kind = kind;
  return exit;
}

// A list of exits, the shortest first. An invocation has only one such list at a time, because its memory is shared.
struct Exits {
  uint count;
  MEMBER_LIST(Exit, exit, SPHERE_MAX_EXITS)
};
LANE_LIST(Exit, exit_lists, SPHERE_MAX_EXITS)
#define EXIT(exits, i) LISTED(exits.exit, exit_lists, i)

// Data that exits_at_edge() collects from the sharp edges beside a point.
struct EdgesBeside {
  Exits faces;                                   // one exit for each face that meets an edge
  MEMBER_LIST(float, to_edge, SPHERE_MAX_EXITS)  // distance (m) of the point from the edge where each face was found
  Exit outside;                                  // exit at the nearest edge, which is used if the point is outside
  float nearest;                                 // m, distance from the point to the nearest edge
};
LANE_LIST(float, to_edge_lists, SPHERE_MAX_EXITS)
#define TO_EDGE(found, i) LISTED(found.to_edge, to_edge_lists, i)

// Adds the exit through a face. It replaces an exit through the same face that was found at a more distant edge.
INLINE void add_face(INOUT(EdgesBeside) found, IN(Exit) face, float to_edge) {
  const float like = 0.95f;  // cosine between normals that count as those of one face
  uint i = 0u;
  while (i < found.faces.count && dot(EXIT(found.faces, i).away, face.away) < like) ++i;
  if (i < found.faces.count && TO_EDGE(found, i) <= to_edge) return;
  if (i == SPHERE_MAX_EXITS) {
    i = 0u;
    for (uint k = 1u; k < SPHERE_MAX_EXITS; ++k)
      if (EXIT(found.faces, k).distance < EXIT(found.faces, i).distance) i = k;
    if (EXIT(found.faces, i).distance >= face.distance) return;
  }
  EXIT(found.faces, i) = face;
  TO_EDGE(found, i) = to_edge;
  found.faces.count = max(found.faces.count, i + 1u);
}

// Adds the exits of a point through both faces of an edge. `off`: vector from the edge to the point (m).
INLINE void add_edge(INOUT(EdgesBeside) found, IN(Cone) cone, IN(vec3) along, IN(vec3) off) {
  float to_edge = length(off);
  vec3 into_1 = bound_at(cone, 0u), into_2 = bound_at(cone, 1u);
  Faces faces = faces_at(cone, along);
  Exit face_1 = exit_of(OF_A_FACE, faces.normal_1, dot(off, faces.normal_1));
  Exit face_2 = exit_of(OF_A_FACE, faces.normal_2, dot(off, faces.normal_2));
  for (int f = 0; f < 2; ++f) add_face(found, f == 0 ? face_1 : face_2, to_edge);
  if (to_edge >= found.nearest) return;
  found.nearest = to_edge;
  if (face_1.distance >= face_2.distance && dot(off, into_1) >= 0.0f)  // above a face
    found.outside = face_1;
  else if (face_2.distance >= face_1.distance && dot(off, into_2) >= 0.0f)
    found.outside = face_2;
  else
    found.outside = exit_of(TO_AN_EDGE, to_edge <= 0.0f ? unit(faces.normal_1 + faces.normal_2) : unit(off), to_edge);
}

INLINE void sort_by_length(INOUT(Exits) exits) {
  for (uint i = 1u; i < exits.count; ++i)
    for (uint k = i; k > 0u && EXIT(exits, k).distance > EXIT(exits, k - 1u).distance; --k) {
      Exit longer = EXIT(exits, k - 1u);
      EXIT(exits, k - 1u) = EXIT(exits, k);
      EXIT(exits, k) = longer;
    }
}

// Returns whether an edge ends at a corner, within the distance `same` (m).
INLINE bool ends_at(IN(Samples) samples, IN(Edge) edge, IN(vec3) corner, float same) {
  vec3 from_a = node_at(samples, edge.a) - corner, from_b = node_at(samples, edge.b) - corner;
  return min(dot(from_a, from_a), dot(from_b, from_b)) < same * same;
}

// Returns whether the nearest point of the surface is a convex corner, for a point that is past the ends of sharp edges
// but beside none of them, and whose distance from the corner is `away` (m). If fewer than three sharp edges end at the
// corner, it is not convex all around; if a crease ends there as well, the point may be in front of another face.
INLINE bool is_at_corner(IN(Samples) other, IN(Field) field, IN(Range) list, IN(vec3) corner, float away) {
  float same = 0.01f * field.cell;
  if (away >= field.cell || away <= flush_in(field)) return false;
  uint count = 0u;
  for (uint k = list.first; k < list.end; ++k) {
    IN(Edge) edge = edge_at(other, listed_edge(other, k));
    if (edge.sharp == 0u || !ends_at(other, edge, corner, same)) continue;
    if (is_crease(other, listed_edge(other, k))) return false;
    ++count;
  }
  return count > 2u;
}

// Returns the distance (m) from a sharp edge up to which the grid cannot tell its two faces apart, and the exits are
// those of the edge: one cell for a right angle, and more for a wedge, whose faces are nearer to its plane of symmetry,
// where the field has a crease that the grid smooths. With one cell for all edges, points on the side of a wedge were
// held by its tip.
INLINE float exact_within(IN(Field) field, IN(Cone) cone) {
  float sharpness = max(dot(bound_at(cone, 0u), bound_at(cone, 1u)), 0.0f);  // cosine of the angle of the edge
  return min(field.cell / sqrt(max(1.0f - sharpness, 1e-6f)), SPHERE_EDGE_REACH * field.cell);
}

// Returns the exits from `other` of a point near sharp edges (exact_within()), computed from the planes of the faces
// that meet there. Inside all faces, each face is an exit. Outside, there is one exit: to the nearest edge, or along
// the normal of its face. The list is empty if no edge is near. `list`: the edges near the point.
INLINE Exits exits_at_edge(IN(Samples) other, IN(Field) field, IN(Range) list, IN(vec3) point) {
  float flush = flush_in(field);
  EdgesBeside found;
  found.faces.count = 0u;
  found.nearest = SPHERE_EDGE_REACH * field.cell;
  found.outside = exit_of(OF_A_FACE, vec3(0.0f, 0.0f, 0.0f), 0.0f);
  vec3 corner = point;  // nearest corner of edges that the point lies beyond the ends of
  float to_corner = field.cell;
  for (uint k = list.first; k < list.end && !is_crease(other, listed_edge(other, k)); ++k) {
    IN(Edge) edge = edge_at(other, listed_edge(other, k));
    vec3 along, off;
    if (edge.sharp == 0u) continue;
    if (!is_beside(other, edge, point, flush, along, off)) {
      IN(vec3) a = node_at(other, edge.a);
      vec3 end = dot(point - a, along) < 0.0f ? a : node_at(other, edge.b);
      float to_end = length(point - end);
      if (to_end < to_corner) {
        corner = end;
        to_corner = to_end;
      }
      continue;
    }
    if (length(off) < exact_within(field, edge.cone)) add_edge(found, edge.cone, along, off);
  }
  if (found.faces.count == 0u && is_at_corner(other, field, list, corner, to_corner)) {
    EXIT(found.faces, 0) = exit_of(TO_AN_EDGE, (point - corner) / to_corner, to_corner);
    found.faces.count = 1u;
    return found.faces;
  }
  bool inside = true;
  for (uint i = 0u; i < found.faces.count; ++i) inside = inside && EXIT(found.faces, i).distance <= flush;
  if (!inside) {
    EXIT(found.faces, 0) = found.outside;
    found.faces.count = 1u;
  }
  sort_by_length(found.faces);
  return found.faces;
}
