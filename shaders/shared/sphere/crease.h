// Contacts in creases, which are sharp edges where a surface folds inwards, such as those of a pit or a slot. The true
// distance there is the smaller one of the distances to the two walls. The grid of a field rounds it over two cells: a
// part that fits into the crease was held off its walls by up to a third of a cell, and a peg did not enter its hole.
// With these functions, a point in a crease gets one contact for each of the two walls, at its true distance from each.
//
// The includer includes edge.h before.

const float CREASE_REACH = 2.0f;  // cells: within this distance of a crease, the distances of the grid are inaccurate
const float CREASE_DEPTH = 0.5f;  // cells: a point that is deeper in a wall may have come from behind the wall

// A wall of a crease, or a face of a sharp edge beside it. `away`: unit normal out of the part.
struct Wall {
  vec3 away;
  float distance;  // m, from the wall to the point; negative behind the wall
  bool creased;    // whether the wall ends at a crease
  bool faced;      // whether the point is in front of the wall, and not beyond one of its sharp edges
};

// List of the walls at a point. An invocation has only one such list at a time, because its memory is shared.
struct Walls {
  uint count;
  MEMBER_LIST(Wall, wall, SPHERE_MAX_WALLS)
};
LANE_LIST(Wall, wall_lists, SPHERE_MAX_WALLS)
#define WALL(walls, i) LISTED(walls.wall, wall_lists, i)

// Adds a wall unless it is in the list (`same`: tolerance, m). Returns its number, or SPHERE_MAX_WALLS if it is full.
INLINE uint add_wall(INOUT(Walls) walls, IN(Wall) wall, float same) {
  const float like = 0.999f;  // cosine of the angle up to which two walls count as one
  uint i = 0u;
  while (i < walls.count &&
         (dot(WALL(walls, i).away, wall.away) < like || abs(WALL(walls, i).distance - wall.distance) > same))
    ++i;
  if (i == SPHERE_MAX_WALLS) return i;
  if (i == walls.count) {
    WALL(walls, i) = wall;
    ++walls.count;
    return i;
  }
  WALL(walls, i).creased = WALL(walls, i).creased || wall.creased;
  WALL(walls, i).faced = WALL(walls, i).faced && wall.faced;
  return i;
}

// Returns the walls of `other` at a point. There are none if no crease is near, or if the point is deep in a wall.
// `list`: the edges near the point.
INLINE Walls walls_at_crease(IN(Samples) other, IN(Field) field, IN(Range) list, IN(vec3) point) {
  Walls walls;
  walls.count = 0u;
  if (list.end == list.first || !is_crease(other, listed_edge(other, list.end - 1u))) return walls;
  float reach = CREASE_REACH * field.cell, flush = 0.002f * field.cell, same = 0.05f * field.cell;
  bool near = false;
  for (uint k = list.end; k > list.first; --k) {  // creases are at the end of the list
    uint e = listed_edge(other, k - 1u);
    bool crease = is_crease(other, e);
    if (!crease && !near) break;
    IN(Edge) edge = edge_at(other, e);
    vec3 along, off;
    if (edge.sharp == 0u || !is_beside(other, edge, point, flush, along, off) || length(off) >= reach) continue;
    vec3 into_1 = bound_at(edge.cone, 0u), into_2 = bound_at(edge.cone, 1u);
    for (uint f = 0u; f < 2u; ++f) {
      vec3 into = into_1, opposite = into_2;
      if (f == 1u) {
        into = into_2;
        opposite = into_1;
      }
      vec3 out_of = opposite;
      if (!crease) out_of = -opposite;
      Wall wall;
      wall.away = common_normal(along, into, out_of);
      wall.distance = dot(off, wall.away);
      wall.creased = crease;
      wall.faced = crease || dot(off, into) >= -flush;
      add_wall(walls, wall, same);
      if (crease && wall.distance < -CREASE_DEPTH * field.cell) {
        walls.count = 0u;
        return walls;
      }
    }
    near = near || crease;
  }
  if (!near) walls.count = 0u;
  return walls;
}
