// Turns a sample of one part that is near another part into a candidate for a contact. docs/develop/contacts.md
// contains the drawing and the derivation.
//
// The includer defines before: crease.h, slide.h, radius_of(samples), emit(view, on_a, normal, separation, feature)
// with all vectors in the frame of a, and View with these members: samples; other (samples of the field's body); own
// (field of the samples' body); field; to_field and to_a (Carry: from the samples' frame to the frame of the field, and
// from there to the frame of the pair's first body, which is the same if side is SPHERE_SIDE_B); drift and twist (m,
// rad: the predicted motion of the samples' body relative to the field's body until the step ends); margin (m, the
// largest distance of a candidate); slop (m, the overlap that contacts leave); way_back.

const float NEARLY_ALL = 0.99f;  // smallest cosine between an exit and its rotation into a cone: 8 degrees
const float FLUSH = 0.99998f;    // cosine of 0.36 degrees: within this angle, two faces count as lying on each other
const float END = 1e-4f;    // share of an edge's length: a crossing that is nearer to an end is left to the node there
const float LEANS = 0.02f;  // sine of the smallest angle at which an edge of the sample dips below the face
const float LEVEL = 2.0f;   // slops: a sample within this distance of a face is level with it; a part that rests is one
                            // slop deep, and deeper where more than its share of the weight presses
const float ALONG = 0.1f;   // sine of the largest angle to a face at which a corner moves along it: 6 degrees

// Returns the largest error of the field (m) near an edge of the surface.
INLINE float error_of(IN(Field) field) {
  return field.ball > 0.0f ? 0.0f : 0.5f * field.cell;
}

INLINE float level_of(IN(View) view) {
  return LEVEL * view.slop;
}

// Returns how far (m) a sample at `point`, where the field is `distance`, must move along a unit direction until it
// leaves the part, having been inside. Returns a negative value if it does not leave within `reach`.
INLINE float exit_distance(IN(Field) field, IN(vec3) point, IN(vec3) along, float distance, float reach) {
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

// Emits the candidate of a sample. `place` (m, frame of the field) is its present position, or the predicted position,
// which differs by `ahead` (m). In the latter case the contact is with the surface that the sample will face. Its gap
// is measured from the present position, so that it does not press before the sample has arrived.
//
// `away` is the unit normal out of the field's part, `number` the feature without bits. If the normal was `turned`, it
// is that of the sample's surface: it moves with the sample's body, and the point moves with the other body.
INLINE void emit_from(IN(View) view, IN(vec3) ahead, IN(vec3) place, IN(vec3) away, bool turned, float distance_there,
                      uint number) {
  float nearer = dot(away, ahead), distance = distance_there;
  vec3 point = place - ahead;
  if (dot(ahead, ahead) > 0.0f) distance = max(distance - nearer, max(nearer, 0.0f));
  vec3 surface = point - radius_of(view.samples) * away;
  uint feature = number | (turned ? SPHERE_TURNED | (view.side ^ SPHERE_SIDE_B) : view.side);
  if (view.side == 0u)
    emit(view, view.to_a.rotation * surface + view.to_a.offset, -(view.to_a.rotation * away), distance, feature);
  else
    emit(view, surface - distance * away, away, distance, feature);
}

// Rotates the direction `away` of an exit into the normal cone of the sample, which gives `turned`. Returns whether a
// contact may press on the sample along it: the cosine of this rotation must be at least `least`.
INLINE bool turn(IN(View) view, IN(Cone) cone, IN(vec3) away, float least, OUT(vec3) turned) {
  vec3 pressed = -turned_back(view.to_field.rotation, away);
  if (!turn_into_cone(cone, pressed, least)) return false;
  turned = -(view.to_field.rotation * pressed);
  return true;
}

/// Returns whether an exit of the sample at `point` leads to an edge or a corner, so that its direction may be tilted.
INLINE bool leans(IN(View) view, IN(vec3) point, IN(Exit) exit) {
  if (exit.kind != BY_THE_FIELD) return exit.kind == TO_AN_EDGE;
  return is_on_edge(view.other, view.field, point - exit.distance * exit.away);
}

// Returns whether the sample was deeper than two cells inside the other part already when the step began.
INLINE bool is_stuck(IN(View) view, IN(vec3) point, IN(Exit) exit) {
  float deep = -2.0f * view.field.cell;
  if (exit.kind != BY_THE_FIELD || exit.distance >= deep) return false;
  return exit.distance + max(-dot(exit.away, view.drift + cross(view.twist, point)), 0.0f) < deep;
}

// Emits a candidate if a contact may press on the sample's own surface along the exit, and returns whether it did. A
// face presses along its own normal: when this normal was rotated into the cone of an edge that did not touch, parts
// were thrown sideways with up to a quarter of the speed at which they fell onto a plate. An exit to an edge or corner
// is rotated into the sample's cone; otherwise, parts with flush edges would push each other sideways. The exit of a
// sample that is stuck deep inside is rotated as well: its nearest face is not significant, and the sample must leave
// the part in some direction.
INLINE bool press(IN(View) view, IN(vec3) ahead, IN(vec3) point, IN(Exit) exit, IN(Cone) cone, uint feature) {
  const float level = 0.999999f;  // cosine of 0.08 degrees, within which no rotation is needed
  bool stuck = is_stuck(view, point, exit);
  vec3 turned;
  if (!turn(view, cone, exit.away, stuck ? LEAST_LEFT : NEARLY_ALL, turned)) return false;
  float left = dot(turned, exit.away);
  bool turns = left < level && (stuck || leans(view, point, exit));
  if (!turns && left < FLUSH && bounds_of(cone) == SPHERE_AXIS) return false;
  emit_from(view, ahead, point, turns ? turned : exit.away, turns, exit.distance, feature + exit.number * SPHERE_PLANE);
  return true;
}

// Returns whether an edge of the sample crosses an edge of the face near an exit. The contact then presses along the
// common normal of both edges, and the exit through the face is not used: otherwise, two nodes, one on each side, would
// hold each other like a wedge.
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

// Returns the exits of a sample in a crease: each near wall is an exit, except walls that are deeper than the face of a
// sharp edge beside them; that face is then the exit.
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

// Finds another exit for a sample that is inside, or nearly so, and on whose surface no contact may press along the
// nearest exit. For example, for two plates that are side by side on the floor, the nearest exit is the face that is
// level with the sample, although the sample is deeper behind another face. The search goes back through the sample's
// own body, along the axis of its cone, to the face where it comes out: for at most four cells or, if the sample is
// deep inside, unless the opposite direction leaves the part sooner, because the sample did not enter through this face
// then. Returns false if there is no such exit.
INLINE bool finds_exit_back(IN(View) view, IN(Touch) at, IN(Cone) cone, OUT(Exit) exit) {
  float cell = view.field.cell, behind = 0.0f, reach = 4.0f * cell;
  if (!view.way_back || at.distance >= error_of(view.field)) return false;
  bool deep = at.distance < -2.0f * cell;
  if (deep) reach = span_of(view.field);
  vec3 back = -(view.to_field.rotation * axis_direction(cone)), away;
  for (int turn = 0; turn < (deep ? 2 : 1); ++turn) {
    float found = exit_distance(view.field, at.point, (turn == 0 ? 1.0f : -1.0f) * back, at.distance, reach);
    if (turn == 0 ? found < 0.0f : found >= 0.0f && found < behind) return false;
    if (turn == 0) behind = reach = found;
  }
  sample_field(view.field, at.point + behind * back, away);
  exit = exit_of(BY_THE_FIELD, away, -behind * dot(back, away));
  return exit.distance <= 0.0f;
}

// Emits a contact for the first exit that fits; in a crease, for each wall that fits. Near a sharp edge the exits are
// exact, so that a sample whose normal cone fits none of them does not press there. (When such directions
// were rotated into the cone, an edge held up parts that leant against it sideways.) If no exact exit ends outside, the
// exit of the field is used, or otherwise the one that finds_exit_back() returns. All of this is one loop, because
// shader compilers expand every call in place.
INLINE void offer_exits(IN(View) view, IN(vec3) ahead, IN(Touch) at, IN(Exits) exits, bool creased, IN(Cone) cone,
                        uint feature) {
  bool out_there = creased;
  for (uint i = 0u; i < exits.count + 2u; ++i) {
    bool exact = i < exits.count;
    if (!exact && out_there) return;
    Exit exit = exit_of(BY_THE_FIELD, at.gradient, at.distance);
    if (exact) {
      exit = EXIT(exits, i);
      // The point half a cell beyond an exit is outside, unless the exit is on a seam between shells that touch. A
      // crease is no seam, but it may be narrow.
      vec3 beyond = at.point + (0.5f * view.field.cell - exit.distance) * exit.away;
      if (!creased && sample_field(view.field, beyond) < 0.3f * view.field.cell) continue;
      out_there = true;
      if (is_crossed(view, at.point, cone, exit.away)) continue;
    } else if (i > exits.count && !finds_exit_back(view, at, cone, exit)) {
      return;
    }
    if (press(view, ahead, at.point, exit, cone, feature) && !(exact && creased)) return;
  }
}

// Returns the nearest of the exact exits, if there are any, or otherwise the exit of the field.
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

// Decides by which face a sample is held that is inside all faces at a sharp edge, after a share of its drift. The path
// alone does not tell: a part that slides from one level tile onto the next one rests a little deeper than the top of
// the next tile, so that its path enters through the side. Of the faces that may press, the sample is held by the one
// that would move it least at the end of the step, provided that the sample was already as low as this face, and is
// level with it. Returns false if this is not so; the sample is then held where it enters.
INLINE bool glides(IN(View) view, IN(Exits) exits, IN(Cone) cone, IN(vec3) drift, float share, OUT(Exit) onto) {
  float highest = 0.0f;
  bool found = false, level = false;
  onto = EXIT(exits, 0);
  for (uint i = 0u; i < exits.count; ++i) {
    Exit exit = EXIT(exits, i);
    vec3 turned;
    if (!turn(view, cone, exit.away, NEARLY_ALL, turned)) continue;
    float present = exit.distance - share * dot(exit.away, drift);
    float end = exit.distance + max(1.0f - share, 0.0f) * dot(exit.away, drift);
    if (found && end <= highest) continue;
    found = true;
    highest = end;
    level = present < level_of(view) && exit.distance > -level_of(view);
    onto = exit;
  }
  return level;
}

// Finds the face by which a sample enters a wedge, an edge of less than a right angle, where it is inside both faces
// after a share of its drift: the face that it passes last. From its present place in front of the edge, the sample
// would be held along the line to the edge, although it moves past the edge along the side of the wedge. Returns false
// if the edge is no wedge, or if no face may press.
INLINE bool enters_wedge(IN(View) view, IN(Exits) exits, IN(Cone) cone, IN(vec3) drift, float share, OUT(Exit) onto) {
  const float right = -0.05f;  // cosine between the normals of an edge of 87 degrees
  float last = 0.0f;
  bool found = false;
  onto = EXIT(exits, 0);
  if (dot(EXIT(exits, 0).away, EXIT(exits, 1).away) > right) return false;
  for (uint i = 0u; i < 2u; ++i) {
    Exit exit = EXIT(exits, i);
    vec3 turned;
    float nears = -dot(exit.away, drift), present = exit.distance + share * nears;
    if (nears <= 0.0f || present <= last * nears || !turn(view, cone, exit.away, NEARLY_ALL, turned)) continue;
    last = present / nears;
    onto = exit;
    found = true;
  }
  return found;
}

// Emits the contacts of a sample. A sample that passes an edge before the step ends is held by the face that it will
// face then, and not by the surface at its present position. Otherwise, the plane across the edge would stop it there,
// for example a peg above the mouth of its hole. A sample that meets a surface on its path is held by that surface, as
// seen from its present position, or, if it is farther away than a cell, from the last place of its path in front of
// the surface: far from an edge, it is not seen on which part of the surface the sample will press. This place is less
// than a cell in front, where distances at edges are exact: with those of the grid, two faces that meet would touch at
// some of their contacts first and turn, by 0.01 % of the speed of the impact and more.
INLINE void offer(IN(View) view, IN(Touch) touch, IN(Cone) cone, uint feature) {
  const int most_advances = 18;
  Touch at = touch;
  vec3 drift = view.drift + cross(view.twist, touch.point), ahead = vec3(0.0f, 0.0f, 0.0f);
  float size = length(drift), least = 0.25f * view.field.cell, error = error_of(view.field), done = 0.0f, clear = 0.0f;
  bool far = touch.distance > view.field.cell;
  bool advances = abs(touch.distance) <= error || (touch.distance > 0.0f && touch.distance - error < size);
  Walls walls;
  Exits exits;
  walls.count = exits.count = 0u;
  for (int i = 0; i < most_advances && radius_of(view.samples) <= 0.0f; ++i) {
    Range list = edges_near(view.other, view.field, at.point);
    walls = walls_at_crease(view.other, view.field, list, at.point);
    exits.count = 0u;
    if (walls.count == 0u && (advances || bounds_of(cone) != 0u))
      exits = exits_at_edge(view.other, view.field, list, at.point);
    if (!advances) break;
    Exit near = nearest_exit(walls, exits, at.gradient, at.distance);
    bool meets = near.distance <= 0.0f;
    if (exits.count > 1u && (meets || i > 0) && bounds_of(cone) != 0u) {
      float share = done > 0.0f ? done / size : 0.0f;
      if (meets && i > 0) {  // a little farther, because all faces that may hold the sample are seen from inside only
        share += least / size;
        vec3 within = touch.point + share * drift;
        exits = exits_at_edge(view.other, view.field, edges_near(view.other, view.field, within), within);
      }
      bool several = exits.count > 1u && (i > 0 || EXIT(exits, 1).distance > -level_of(view));
      Exit onto;
      bool held = several && glides(view, exits, cone, drift, share, onto);
      if (held || (meets && i > 0 && exits.count > 1u && enters_wedge(view, exits, cone, drift, share, onto))) {
        EXIT(exits, 0) = onto;
        exits.count = 1u;
        ahead = share * drift;
        at.point = touch.point + ahead;
        at.distance = sample_field(view.field, at.point, at.gradient);
        break;
      }
    }
    if (i == 0 && (meets || near.distance + dot(near.away, drift) >= 0.0f)) break;
    if (!meets && done >= size) {
      if (at.distance >= view.margin) return;
      ahead = drift;
      break;
    }
    advances = !meets && i + 2 < most_advances;
    if (!meets) clear = done;
    float stride = near.distance > view.field.cell ? near.distance - 0.5f * view.field.cell : max(near.distance, least);
    done = advances ? min(done + stride, size) : far ? clear : 0.0f;
    vec3 moved = (done > 0.0f ? done / size : 0.0f) * drift;
    if (!advances) ahead = moved;
    at.point = touch.point + moved;
    at.distance = sample_field(view.field, at.point, at.gradient);
  }
  bool creased = walls.count > 0u;
  if (creased) exits = exits_in_crease(view, walls, cone);
  // For a sample without a cone, it is not known against which face of an edge it presses.
  if (bounds_of(cone) == 0u && !creased) exits.count = 0u;
  offer_exits(view, ahead, at, exits, creased, cone, feature);
}

// Returns whether a node at the given distance (m) from the other part may have a contact after slide().
INLINE bool node_may_touch(IN(View) view, float distance) {
  return distance < view.margin + sag_of(view.samples);
}

// Moves a node of a curved face to its deepest point (slide()). Returns whether a contact is found there.
INLINE bool touches_with_node(IN(View) view, uint node, INOUT(Touch) touch) {
  slide(view.samples, view.own, view.to_field, node, solid_of(view.field), touch);
  return touch.distance < view.margin;
}

// Returns whether an edge may have a contact, by the distances (m) at its ends p and q: along the edge, the distance
// decreases by no more than the length.
INLINE bool edge_may_touch(IN(View) view, IN(Edge) edge, float distance_p, float distance_q) {
  return 0.5f * (distance_p + distance_q - length_of(edge)) < view.margin;
}

// Returns whether an edge may cross an edge of the other part although its deepest point is an end. Where edges
// are nearly parallel or end, one of them dips below the other by less than the resolution of the grid.
INLINE bool may_cross(IN(View) view, IN(Edge) edge, float distance) {
  return edge.sharp != 0u && radius_of(view.samples) <= 0.0f && abs(distance) <= view.field.cell;
}

// Returns whether an edge whose ends are farther away (m) than a cell may come as near as that in this step.
// `movement`: largest predicted movement of its points (m).
INLINE bool may_arrive(IN(View) view, IN(Edge) edge, float distance_p, float distance_q, float movement) {
  float cell = view.field.cell;
  return min(distance_p, distance_q) > cell && 0.5f * (distance_p + distance_q - length_of(edge)) - cell < movement;
}

INLINE Touch touch_at(IN(View) view, IN(vec3) point) {
  Touch touch;
  touch.point = point;
  touch.distance = sample_field(view.field, point, touch.gradient);
  return touch;
}

// Finds the deepest point of the edge from p to q, as descend() does. If the edge is farther away than a cell, it is
// first moved along its predicted motion, until it is within a cell of the other part. (Beyond the grid, the field is a
// lower bound, and its gradient is that of a face beside the place where the edges will meet; the lists of edges end
// there as well.) No movement is longer than the distance, so that the edge does not pass through a surface. `lowest`:
// result of descend(). Returns whether the edge was moved; p and q are then its ends at its new place.
INLINE bool arrive(IN(View) view, IN(Edge) edge, INOUT(Touch) p, INOUT(Touch) q, INOUT(Touch) touch, OUT(bool) lowest) {
  const int most_advances = 8;
  vec3 from_p = p.point, drift_p = view.drift + cross(view.twist, from_p);
  vec3 from_q = q.point, drift_q = view.drift + cross(view.twist, from_q);
  float size = max(length(drift_p), length(drift_q)), near = view.field.cell, done = 0.0f;
  for (int i = 0; i < most_advances; ++i) {
    if (done > 0.0f) {
      p = touch_at(view, from_p + done * drift_p);
      q = touch_at(view, from_q + done * drift_q);
    }
    lowest = descend(view.field, p, q, touch);
    if (!may_arrive(view, edge, p.distance, q.distance, (1.0f - done) * size)) break;
    float gap = (lowest ? touch.distance : min(p.distance, q.distance)) - near;
    if (gap <= 0.0f || gap >= (1.0f - done) * size) break;
    done = min(done + max(gap, 0.25f * near) / size, 1.0f);
  }
  return done > 0.0f;
}

// Returns whether the crossing of two edges is left to a corner where one of them ends: the edges approach each other
// or overlap, they meet no farther from the corner than a level sample lies from a face, and the corner lies on a face
// of the other edge and moves along it. For example, the vertical edges of a box that slides over level tiles cross the
// edges of the tiles. An edge that ends at a saddle is in the way of the other one, and is not left to its end. The
// edge of the sample is between p and q at present; `normal` and `gap` (m) are those of the crossing.
INLINE bool slips_past(IN(View) view, IN(Edge) edge, IN(Edge) other, IN(vec3) p, IN(vec3) q, IN(vec3) normal,
                       float gap) {
  vec3 drift = view.drift + cross(view.twist, p);
  float level = level_of(view), nears = -dot(normal, drift), s, t;
  if ((nears < flush_in(view.field) && gap > -level) || edge.sharp == 0u || other.sharp == 0u) return false;
  vec3 u = q - p, r = node_at(view.other, other.a), v = node_at(view.other, other.b) - r;
  vec3 met = p + (gap > 0.0f && nears > 0.0f ? min(gap / nears, 1.0f) : 0.0f) * drift;
  if (!nearest_points(u, dot(u, u), v, met - r, s, t)) return false;
  for (uint i = 0u; i < 8u; ++i) {
    bool own = i < 4u, at_a = (i & 2u) == 0u, first = (i & 1u) == 0u;  // whose corner, at which end, on which face
    float along = own ? s : t, from_end = at_a ? along : along - 1.0f;
    if (abs(from_end) * (own ? length_of(edge) : length_of(other)) >= level) continue;
    if (own ? ends_at_saddle(view.samples, edge, at_a) : ends_at_saddle(view.other, other, at_a)) continue;
    Faces faces = own ? faces_at(other.cone, v) : faces_at(edge.cone, turned_back(view.to_field.rotation, u));
    vec3 away = faces.normal_1, corner = p, face_at = r;
    if (!first) away = faces.normal_2;
    if (own) {
      if (!at_a) corner = q;
    } else {
      away = view.to_field.rotation * away;
      corner = r;
      if (!at_a) corner = r + v;
      face_at = p;
    }
    if (abs(dot(corner - face_at, away)) >= level) continue;
    if (gap > -level && abs(dot(drift, away)) >= ALONG * nears) continue;
    vec3 pressed = -away;
    if (own) {
      pressed = turned_back(view.to_field.rotation, pressed);
      if (turn_into_cone(cone_at(view.samples, at_a ? edge.a : edge.b), pressed, NEARLY_ALL)) return true;
    } else if (turn_into_cone(cone_at(view.other, at_a ? other.a : other.b), pressed, NEARLY_ALL)) {
      return true;
    }
  }
  return false;
}

// Tests edge e between its ends `first` and `second`, and emits a candidate where it crosses an edge of the other part.
// Returns whether offer() must be called for `touch`, the point of the edge that is, or will be, the deepest.
INLINE bool touches_with_edge(IN(View) view, uint e, IN(Touch) first, IN(Touch) second, INOUT(Touch) touch) {
  IN(Edge) edge = edge_at(view.samples, e);
  Touch p = first, q = second;
  bool lowest;
  bool moved = arrive(view, edge, p, q, touch, lowest);
  for (int end = 0; end < 2; ++end) {
    if (!lowest) {
      touch = p;
      if (end == 1) touch = q;
      if (!may_cross(view, edge, touch.distance)) continue;
    }
    Touch deepest = touch;
    uint other = cross_edges(view.samples, edge, view.other, view.field, p.point, q.point, touch);
    bool crossed = other != NO_EDGE;
    if (!crossed) other = 0u;  // an index that exists, where a compiler loads the edge before it is asked for
    vec3 along = q.point - p.point;
    float t = dot(touch.point - p.point, along) / dot(along, along);
    bool inside = t > END && t < 1.0f - END;
    crossed = crossed && (!moved || inside || ends_at_saddle(view.samples, edge, t < 0.5f));
    vec3 present = touch.point;
    if (moved) present = first.point + t * (second.point - first.point);
    crossed = crossed && !slips_past(view, edge, edge_at(view.other, other), first.point, second.point, touch.gradient,
                                     touch.distance - dot(touch.gradient, touch.point - present));
    if (!crossed) touch = deepest;
    if (!lowest && !crossed) continue;
    if (!moved && touch.distance >= view.margin) return false;
    bool presses = crossed && press(view, touch.point - present, touch.point,
                                    exit_of(OF_A_FACE, touch.gradient, touch.distance), edge.cone, e | SPHERE_EDGE);
    if (!lowest || presses) return false;
    touch = deepest;
    if (moved) touch = touch_at(view, present);
    return touch.distance < view.margin;
  }
  return false;
}
