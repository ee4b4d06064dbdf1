// Contacts between the rim of a wall of the bin and the field of a part that lies across it. The line of the rim may
// pass between the nodes of the part. One candidate is found at each place along the line where the distance to the
// part has a minimum, and another one at the other end of the face there, if the line passes along a face: with one
// contact at a time, the part would rock from one end to the other. The includer includes slide.h before.

const int RIM_ROUNDS = 8;  // rounds of the search; each removes a third of the interval that contains the nearest point

// Points along the rim near a part. Point i, from first to last, is i times step_size (m) from the start of the line.
struct Rim {
  vec3 start;  // start of the line, relative to the part's centre, bin frame (m)
  vec3 along;  // unit direction of the line, bin frame
  float step_size;
  int first, last;
};

// Finds the points of the rim of a wall near a part whose bounding sphere has its centre at `position` (bin frame).
// Returns false if the sphere is farther away than `margin`. top: height of the rim. All lengths are in m.
INLINE bool find_rim(IN(Plane) plane, float top, IN(vec3) position, float radius, float margin, float face_spacing,
                     INOUT(Rim) rim) {
  vec3 up = vec3(0.0f, 0.0f, 1.0f), normal = normal_of(plane);
  float face = dot(normal, position) - offset_of(plane), above = dot(position, up) - top;
  float reach = radius + margin, near = reach * reach - face * face - above * above;
  if (!is_wall(plane) || near <= 0.0f || face_spacing <= 0.0f) return false;
  rim.along = cross(normal, up);
  rim.start = offset_of(plane) * normal + top * up - position;
  rim.step_size = face_spacing;
  float center = dot(rim.along, position), half_length = sqrt(near);
  rim.first = int(floor((center - half_length) / face_spacing));
  rim.last = int(ceil((center + half_length) / face_spacing));
  return true;
}

// Returns the point (m) at coordinate t (m) along the rim, in the frame of the part. rotation: part to bin frame.
INLINE vec3 on_rim(IN(Rim) rim, IN(mat3) rotation, float t) {
  return turned_back(rotation, rim.start + t * rim.along);
}

INLINE float distance_at(IN(Rim) rim, IN(Field) field, IN(mat3) rotation, int i) {
  return sample_field(field, on_rim(rim, rotation, rim.step_size * float(i)));
}

// Returns whether the rim may touch a part around a point, from the distances (m) there and at both its neighbours.
INLINE bool may_touch_rim(IN(Rim) rim, float before, float here, float after, float margin) {
  // The distance has a minimum at the point, or the point is an end of a piece of the rim that lies along a face.
  bool nearest = here <= before && here <= after && (here < before || here < after);
  return nearest && here - rim.step_size < margin;
}

// Finds the place around point i where the part is nearest to the rim: the coordinate t along the rim (m), and point,
// distance and gradient of the part's field there (part frame). Returns whether the rim can press there.
INLINE bool touch_rim(IN(Rim) rim, IN(Plane) plane, IN(Field) field, IN(mat3) rotation, int i, INOUT(float) t,
                      INOUT(Touch) touch) {
  const float least_out = -0.1f;  // smallest component, along up and along the wall's normal, of a direction out of it
  float lower = rim.step_size * float(i - 1), upper = rim.step_size * float(i + 1);
  for (int turn = 0; turn < RIM_ROUNDS; ++turn) {
    float t0 = lower + (upper - lower) / 3.0f, t1 = upper - (upper - lower) / 3.0f;
    if (sample_field(field, on_rim(rim, rotation, t0)) <= sample_field(field, on_rim(rim, rotation, t1)))
      upper = t1;
    else
      lower = t0;
  }
  t = 0.5f * (lower + upper);
  touch.point = on_rim(rim, rotation, t);
  touch.distance = sample_field(field, touch.point, touch.gradient);
  vec3 exit_direction = -(rotation * touch.gradient);
  return dot(exit_direction, vec3(0.0f, 0.0f, 1.0f)) >= least_out && dot(exit_direction, normal_of(plane)) >= least_out;
}

// The distance (m) from the rim to a face of a part as a function of the way along the rim: where the way is t (m), it
// is `distance`, and it increases by `slope` times the way from there.
struct FaceAlong {
  float t, distance, slope;
};

// Returns whether the face goes on at the given way (m, may be negative) from its t: at its end, the distance
// increases.
INLINE bool goes_on(IN(Rim) rim, IN(Field) field, IN(mat3) rotation, IN(FaceAlong) face, float way) {
  float there = sample_field(field, on_rim(rim, rotation, face.t + way));
  return there < face.distance + face.slope * abs(way) + 0.02f * field.cell;
}

// Moves `touch`, the point of the part that is nearest to the rim at coordinate t (m), along the rim to the other end
// of the face there. Returns false if the rim does not pass along a face, or only for a few cells of the field. On a
// curved face, the end is where the distance departs from the slope of the first cells.
INLINE bool touch_far_end(IN(Rim) rim, IN(Field) field, IN(mat3) rotation, INOUT(float) t, INOUT(Touch) touch) {
  const float steepest = 0.1f;  // slope of a face that may lie on the rim soon: 6 degrees
  float few = 4.0f * field.cell, reach = rim.step_size * float(rim.last - rim.first);
  for (int side = -1; side <= 1 && field.ball <= 0.0f; side += 2) {
    float within = float(side) * few, beyond = 2.0f * within;
    FaceAlong face;
    face.t = t;
    face.distance = touch.distance;
    face.slope = (sample_field(field, on_rim(rim, rotation, t + within)) - touch.distance) / few;
    if (face.slope > steepest) continue;
    while (abs(beyond) < reach && goes_on(rim, field, rotation, face, beyond)) {
      within = beyond;
      beyond = 2.0f * beyond;
    }
    for (int turn = 0; turn < RIM_ROUNDS; ++turn) {
      float middle = 0.5f * (within + beyond);
      if (goes_on(rim, field, rotation, face, middle))
        within = middle;
      else
        beyond = middle;
    }
    // A little before the end, and with the direction of the face from its middle: at the end, the grid tilts it.
    within -= 0.5f * float(side) * field.cell;
    sample_field(field, on_rim(rim, rotation, t + 0.5f * within), touch.gradient);
    t += within;
    touch.point = on_rim(rim, rotation, t);
    touch.distance = face.distance + face.slope * abs(within);
    return true;
  }
  return false;
}

// Returns the feature (SphereContact.feature) of a contact around point i of the rim of plane k, or of one at the far
// end of the face there.
INLINE uint rim_feature(int i, bool far_end, uint k) {
  return SPHERE_SIDE_B | ((uint(i + 0x400000) & 0x7fffffu) + (far_end ? 0x800000u : 0u) + k * SPHERE_PLANE);
}
