// The rim of a wall against the field of a part that lies across it: a line passes between the part's nodes. One
// candidate for each place along it where it is nearest, or deepest. Needs sphere/field.h, the binding Planes, emit().
// Twin: candidates_of_rim().

const int RIM_ROUNDS = 8;  // each takes a third off where the nearest place may be

struct Rim {
  Field field;
  mat3 rotation;  // of the part
  vec3 start;     // of the line, from the part's centre, bin frame
  vec3 along;
};

vec3 on_rim(Rim rim, float t) { return (rim.start + t * rim.along) * rim.rotation; }

bool within_walls(SphereWorld world, vec3 p, float margin) {
  for (uint k = 0u; k < world.pairs.w; ++k) {
    SpherePlane other = planes[world.pairs.z + k];
    if (other.wall.x != 0u && dot(other.plane.xyz, p) < other.plane.w - margin) return true;
  }
  return false;
}

// All invocations, each some places along the rim of plane k.
void test_rim(SphereWorld world, uint k, float radius, SphereSamples samples, Field field, mat3 rotation, vec3 position,
              float margin) {
  const float least_out = -0.1;  // the way out of the rim is upwards, off the wall, or between the two
  const vec3 up = vec3(0.0, 0.0, 1.0);
  SpherePlane plane = planes[world.pairs.z + k];
  float top = world.ground.z, face = dot(plane.plane.xyz, position) - plane.plane.w, above = position.z - top;
  float reach = radius + margin, near = reach * reach - face * face - above * above, step_size = samples.size.z;
  if (plane.wall.x == 0u || near <= 0.0 || step_size <= 0.0) return;
  vec3 along = cross(plane.plane.xyz, up), start = plane.plane.w * plane.plane.xyz + top * up;
  Rim rim = Rim(field, rotation, start - position, along);
  float middle = dot(along, position), half_length = sqrt(near);
  int first = int(floor((middle - half_length) / step_size)), last = int(ceil((middle + half_length) / step_size));
  for (int i = first + int(gl_LocalInvocationIndex); i <= last; i += SPHERE_GROUP) {
    float here = sample_field(field, on_rim(rim, step_size * float(i)));
    float before = sample_field(field, on_rim(rim, step_size * float(i - 1)));
    float after = sample_field(field, on_rim(rim, step_size * float(i + 1)));
    // Or an end of where it lies along a face.
    bool nearest = here <= before && here <= after && (here < before || here < after);
    if (!nearest || here - step_size >= margin) continue;
    float lower = step_size * float(i - 1), upper = step_size * float(i + 1);
    for (int turn = 0; turn < RIM_ROUNDS; ++turn) {
      float t0 = lower + (upper - lower) / 3.0, t1 = upper - (upper - lower) / 3.0;
      if (sample_field(field, on_rim(rim, t0)) <= sample_field(field, on_rim(rim, t1)))
        upper = t1;
      else
        lower = t0;
    }
    float t = 0.5 * (lower + upper);
    vec3 x = on_rim(rim, t), gradient;
    float distance = sample_field(field, x, gradient);
    vec3 way_out = -(rotation * gradient);
    if (distance >= margin || way_out.z < least_out || dot(way_out, plane.plane.xyz) < least_out ||
        within_walls(world, start + t * along, margin))
      continue;
    uint place = uint(i + 0x400000) & 0x7fffffu;
    emit(x - distance * gradient, gradient, distance, SPHERE_SIDE_B | place + k * SPHERE_PLANE);
  }
}
