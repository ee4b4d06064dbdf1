// Turns a sample of one part that is near another part into a candidate for a contact. docs/develop/contacts.md
// contains the drawing and the derivation.
//
// The includer defines before: crease.h, slide.h, radius_of(samples), emit(view, on_a, normal, separation, feature)
// with all vectors in the frame of a, and View with these members: samples; other (samples of the field's body); own
// (field of the samples' body); field; to_field and to_a (Carry: from the samples' frame to the frame of the field, and
// from there to the frame of the pair's first body, which is the same if side is SPHERE_SIDE_B); drift and twist (m,
// rad: the predicted motion of the samples' body relative to the field's body until the step ends); ahead (m, initially
// 0); margin (m, the largest distance of a candidate); way_back.

const float NEARLY_ALL = 0.99f;  // of an exit a cone must leave: 8 degrees
const float FLUSH = 0.99998f;    // cosine of 0.36 degrees: faces that lie on each other
const float LEANS = 0.02f;       // sine of the angle by which a face leans against an edge that dips below it

// Of the grid where it bends (m).
INLINE float error_of(IN(Field) field) {
  return field.ball > 0.0f ? 0.0f : 0.5f * field.cell;
}

// How far (m) a sample at `point`, where the field is `distance`, is from being outside along a unit direction, having
// been inside; negative if it is not, for as long as `reach`.
INLINE float way_out(IN(Field) field, IN(vec3) point, IN(vec3) along, float distance, float reach) {
  float least = 0.25f * field.cell, t = 0.0f, before = distance;
  bool inside = distance < 0.0f;
  while (t < reach) {
    float stride = max(abs(before), least);
    t += stride;
    float now = sample_field(field, point + t * along);
    if (now >= 0.0f && inside) return t - stride * now / (now - before);
    inside = inside || now < 0.0f;
    before = now;
  }
  return -1.0f;
}

// `point` may be that where a sample will be, view.ahead of where it is: what it will stand before is decided as it
// lies to the sample now, and does not press before it is there.
//
// A normal that was `turned` is that of the sample's surface: it goes on with that body, and the point with the other.
INLINE void emit_from(IN(View) view, IN(vec3) place, IN(vec3) away, bool turned, float distance_there, uint number) {
  float nearer = dot(away, view.ahead), distance = distance_there;
  vec3 point = place - view.ahead;
  if (dot(view.ahead, view.ahead) > 0.0f) distance = max(distance - nearer, max(nearer, 0.0f));
  vec3 surface = point - radius_of(view.samples) * away;
  uint feature = number | (turned ? SPHERE_TURNED | (view.side ^ SPHERE_SIDE_B) : view.side);
  if (view.side == 0u)
    emit(view, view.to_a.rotation * surface + view.to_a.offset, -(view.to_a.rotation * away), distance, feature);
  else
    emit(view, surface - distance * away, away, distance, feature);
}

// Whether the sample's own surface can be pressed against an exit, of which `least` must be left; `turned` into its
// cone.
INLINE bool turn(IN(View) view, IN(Cone) cone, IN(vec3) away, float least, OUT(vec3) turned) {
  vec3 pressed = -turned_back(view.to_field.rotation, away);
  if (!turn_into_cone(cone, pressed, least)) return false;
  turned = -(view.to_field.rotation * pressed);
  return true;
}

INLINE bool leans(IN(View) view, IN(vec3) point, IN(Exit) exit) {
  if (exit.kind != BY_THE_FIELD) return exit.kind == TO_AN_EDGE;
  return is_on_edge(view.other, view.field, point - exit.distance * exit.away);
}

// Whether the sample was inside already when the step began, by more than the grid can resolve.
INLINE bool is_stuck(IN(View) view, IN(vec3) point, IN(Exit) exit) {
  float deep = -2.0f * view.field.cell;
  if (exit.kind != BY_THE_FIELD || exit.distance >= deep) return false;
  return exit.distance + max(-dot(exit.away, view.drift + cross(view.twist, point)), 0.0f) < deep;
}

// A candidate, if the sample's own surface can be pressed against the exit. A face presses along its normal,
// whatever is pressed against it: turned into the cone of an edge that is not what touches, the normal threw parts
// sideways by up to a quarter of the speed at which they fell onto a plate. An exit to an edge or a corner is turned
// into the cone: else parts whose edges lie flush would press each other sideways. So is that of what is stuck inside,
// where the nearest face says little: it must come out somehow.
INLINE bool press(IN(View) view, IN(vec3) point, IN(Exit) exit, IN(Cone) cone, uint feature) {
  const float level = 0.999999f;  // cosine: 0.08 degrees
  bool stuck = is_stuck(view, point, exit);
  vec3 turned;
  if (!turn(view, cone, exit.away, stuck ? LEAST_LEFT : NEARLY_ALL, turned)) return false;
  float left = dot(turned, exit.away);
  bool turns = left < level && (stuck || leans(view, point, exit));
  if (!turns && left < FLUSH && bounds_of(cone) == SPHERE_AXIS) return false;
  emit_from(view, point, turns ? turned : exit.away, turns, exit.distance, feature + exit.number * SPHERE_PLANE);
  return true;
}

// A face that leans against an edge of the sample is not what it presses where that crosses an edge of the face: it
// presses along the normal of both edges, and two such nodes, one on each, would hold each other like a wedge.
INLINE bool is_crossed(IN(View) view, IN(vec3) point, IN(Cone) cone, IN(vec3) away) {
  uint bounds = bounds_of(cone);
  if (bounds == SPHERE_AXIS) return false;
  for (uint i = 0u; i < bounds; ++i) {
    vec3 along = view.to_field.rotation * bound_at(cone, i), normal, turned;
    if (dot(along, away) > -LEANS || !passes_edge(view.other, view.field, point, along, away, normal)) continue;
    if (turn(view, cone, normal, NEARLY_ALL, turned)) return true;
  }
  return false;
}

// Of the walls of a crease each presses that is near, but for those out of which another face leads sooner: that of a
// sharp edge beside them.
INLINE Exits exits_in_crease(IN(View) view, IN(Walls) walls, IN(Cone) cone) {
  float flush = 0.002f * view.field.cell, soonest = -view.field.cell;
  Exits exits;
  exits.count = 0u;
  Exit exit = exit_of(OF_A_FACE, vec3(0.0f, 0.0f, 0.0f), 0.0f);
  bool found = false, leaves = false;
  for (uint i = 0u; i < walls.count; ++i) {
    Wall wall = WALL(walls, i);
    vec3 turned;
    if (wall.creased || !wall.faced || wall.distance > flush || wall.distance <= soonest) continue;
    if (!turn(view, cone, wall.away, NEARLY_ALL, turned)) continue;
    soonest = wall.distance;
    exit = exit_of(OF_A_FACE, wall.away, wall.distance);
    exit.number = i;
    found = true;
  }
  for (uint i = 0u; i < walls.count; ++i) {
    Wall wall = WALL(walls, i);
    if (!wall.faced || wall.distance >= view.margin || (!wall.creased && wall.distance <= flush)) continue;
    if (found && wall.distance < min(soonest, 0.0f)) {
      leaves = true;
      continue;
    }
    if (exits.count == SPHERE_MAX_EXITS) break;
    EXIT(exits, exits.count) = exit_of(OF_A_FACE, wall.away, wall.distance);
    EXIT(exits, exits.count).number = i;
    ++exits.count;
  }
  if (leaves && exits.count < SPHERE_MAX_EXITS) {
    EXIT(exits, exits.count) = exit;
    ++exits.count;
  }
  return exits;
}

// For a sample that is inside, or as good as, and whose surface cannot be pressed against the nearest exit: of parts
// that lie flush (two plates side by side on the floor) that is the face level with it, although it is deeper in behind
// another. It goes back through its own body, along the axis of its cone, to the face it comes out of: for at most
// four cells, or, deep inside, unless it would be out sooner in the other direction, for then it did not come in
// through that face. False if there is no such exit.
INLINE bool finds_exit_back(IN(View) view, IN(Touch) at, IN(Cone) cone, OUT(Exit) exit) {
  float cell = view.field.cell, behind = 0.0f, reach = 4.0f * cell;
  if (!view.way_back || at.distance >= error_of(view.field)) return false;
  bool deep = at.distance < -2.0f * cell;
  if (deep) reach = span_of(view.field);
  vec3 back = -(view.to_field.rotation * middle_of(cone)), away;
  for (int turn = 0; turn < (deep ? 2 : 1); ++turn) {
    float found = way_out(view.field, at.point, (turn == 0 ? 1.0f : -1.0f) * back, at.distance, reach);
    if (turn == 0 ? found < 0.0f : found >= 0.0f && found < behind) return false;
    if (turn == 0) behind = reach = found;
  }
  sample_field(view.field, at.point + behind * back, away);
  exit = exit_of(BY_THE_FIELD, away, -behind * dot(back, away));
  return exit.distance <= 0.0f;
}

// Makes a contact of the first exit that fits; in a crease, of each wall that does. Near a sharp edge the exits
// are exact, so that a sample whose normal cone fits none of them does not press there. (An exit past an edge, turned
// into the cone, held up parts that leant against the edge from the side.) Where none of them ends outside, the exit is
// the field's, or else the one back. In one loop: compilers put all that is called in place.
INLINE void offer_exits(IN(View) view, IN(Touch) at, IN(Exits) exits, bool creased, IN(Cone) cone, uint feature) {
  bool out_there = creased;
  for (uint i = 0u; i < exits.count + 2u; ++i) {
    bool exact = i < exits.count;
    if (!exact && out_there) return;
    Exit exit = exit_of(BY_THE_FIELD, at.gradient, at.distance);
    if (exact) {
      exit = EXIT(exits, i);
      // Half a cell beyond is outside, unless this is a seam between shells that touch. A crease is none, but narrow.
      vec3 beyond = at.point + (0.5f * view.field.cell - exit.distance) * exit.away;
      if (!creased && sample_field(view.field, beyond) < 0.3f * view.field.cell) continue;
      out_there = true;
      if (is_crossed(view, at.point, cone, exit.away)) continue;
    } else if (i > exits.count && !finds_exit_back(view, at, cone, exit)) {
      return;
    }
    if (press(view, at.point, exit, cone, feature) && !(exact && creased)) return;
  }
}

// The nearest of the exits that are exact, where there are such, or that of the field.
INLINE Exit nearest_exit(IN(Walls) walls, IN(Exits) exits, IN(vec3) away, float distance) {
  Exit least = exit_of(BY_THE_FIELD, away, distance);
  if (exits.count > 0u) least = EXIT(exits, 0);
  bool none = true;
  for (uint i = 0u; i < walls.count; ++i) {
    if (!WALL(walls, i).creased || (!none && WALL(walls, i).distance >= least.distance)) continue;
    least.away = WALL(walls, i).away;
    least.distance = WALL(walls, i).distance;
    none = false;
  }
  return least;
}

// What comes by an edge until the step ends is held by the face that it will stand before, and not where it is: the
// plane across the edge would stop it there, a peg above the mouth of its hole. What meets something on its path is
// held by that as it lies now.
INLINE void offer(IN(View) given, IN(Touch) touch, IN(Cone) cone, uint feature) {
  const int most_advances = 18;
  View view = given;
  Touch at = touch;
  vec3 drift = view.drift + cross(view.twist, touch.point);
  float size = length(drift), least = 0.25f * view.field.cell, error = error_of(view.field), done = 0.0f;
  bool advances = abs(touch.distance) <= error || (touch.distance > 0.0f && touch.distance - error < size);
  Walls walls;
  Exits exits;
  walls.count = exits.count = 0u;
  for (int i = 0; i < most_advances && radius_of(view.samples) <= 0.0f; ++i) {
    walls = walls_at_crease(view.other, view.field, at.point);
    exits.count = 0u;
    if (walls.count == 0u && (advances || bounds_of(cone) != 0u))
      exits = exits_at_edge(view.other, view.field, at.point);
    if (!advances) break;
    Exit near = nearest_exit(walls, exits, at.gradient, at.distance);
    bool meets = near.distance <= 0.0f;
    if (i == 0 && (meets || near.distance + dot(near.away, drift) >= 0.0f)) break;
    if (!meets && done >= size) {
      if (at.distance >= view.margin) return;
      view.ahead = drift;
      break;
    }
    advances = !meets && i + 2 < most_advances;
    done = advances ? min(done + max(near.distance, least), size) : 0.0f;
    at.point = touch.point + (done > 0.0f ? done / size : 0.0f) * drift;
    at.distance = sample_field(view.field, at.point, at.gradient);
  }
  bool creased = walls.count > 0u;
  if (creased) exits = exits_in_crease(view, walls, cone);
  // Which of the faces of an edge what has no cone presses against is not known.
  if (bounds_of(cone) == 0u && !creased) exits.count = 0u;
  offer_exits(view, at, exits, creased, cone, feature);
}

// Whether a node that the field is `distance` from may touch.
INLINE bool node_may_touch(IN(View) view, float distance) {
  return distance < view.margin + sag_of(view.samples);
}

// Slides the node to where it is deepest; returns whether it is to be offered.
INLINE bool touches_with_node(IN(View) view, uint node, INOUT(Touch) touch) {
  slide(view.samples, view.own, view.to_field, node, solid_of(view.field), touch);
  return touch.distance < view.margin;
}

// By the distances of its ends: it falls by no more than its length.
INLINE bool edge_may_touch(IN(View) view, IN(Edge) edge, float distance_p, float distance_q) {
  return 0.5f * (distance_p + distance_q - length_of(edge)) < view.margin;
}

// Where edges are nearly parallel, or end, one dips below the other by less than the grid can resolve.
INLINE bool may_cross(IN(View) view, IN(Edge) edge, float distance) {
  return edge.sharp != 0u && radius_of(view.samples) <= 0.0f && abs(distance) <= view.field.cell;
}

// An edge e between two ends. Presses where it crosses an edge of the other part; returns whether `touch` is to be
// offered.
INLINE bool touches_with_edge(IN(View) view, uint e, IN(Touch) p, IN(Touch) q, INOUT(Touch) touch) {
  IN(Edge) edge = edge_at(view.samples, e);
  bool lowest = descend(view.field, p, q, touch);
  for (int end = 0; end < 2; ++end) {
    if (!lowest) {
      touch = p;
      if (end == 1) touch = q;
      if (!may_cross(view, edge, touch.distance)) continue;
    }
    bool crossed = cross_edges(view.other, view.field, p.point, q.point, touch);
    if (!lowest && !crossed) continue;
    if (touch.distance >= view.margin) return false;
    bool presses = crossed && press(view, touch.point, exit_of(OF_A_FACE, touch.gradient, touch.distance), edge.cone,
                                    e | SPHERE_EDGE);
    return lowest && !presses;
  }
  return false;
}
