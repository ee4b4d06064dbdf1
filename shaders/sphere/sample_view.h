// The samples of one body of a pair in the frame of the other body's distance field, as shared/sphere/touch.h needs
// them. Needs the bindings Settings, Worlds, Progress, Bodies, States, Shapes, Nodes, Edges, Fields, Jobs, Candidates.
#include "sphere/step_of_pair.h"
#include "sphere/field.h"
#include "sphere/samples.h"
#include "sphere/emit.h"

// The input of shared/sphere/touch.h, which explains each member: the samples of one body and the field of the other.
struct View {
  Samples samples, other;
  Field own, field;
  Carry to_field, to_a;
  uint side;
  vec3 drift, twist;
  float margin, slop;
  bool way_back;
};

// Predicted motion of a body relative to another one until the step ends, in the frame of the other one (m, rad). It is
// without gravity: the body may be held up.
struct Drift {
  vec3 drift, twist;
};

Drift drift_of(uint points, Placement at, uint over, Placement frame) {
  float rest = time_step - plan.contact_time + plan.sub_step;  // the last sweeps look ahead by another sub-step
  vec3 v = vec3(0.0), w = vec3(0.0), frame_v = vec3(0.0), frame_w = vec3(0.0);
  if (moves(points)) {
    v = states[points].velocity.xyz;
    w = states[points].spin.xyz;
  }
  if (moves(over)) {
    frame_v = states[over].velocity.xyz;
    frame_w = states[over].spin.xyz;
  }
  return Drift(rest * ((v - frame_v + cross(w, frame.position - at.position)) * frame.rotation),
               rest * ((w - frame_w) * frame.rotation));
}

// Returns the samples of a (of_a) or b with the field of the other body, at the poses of the contact time. margin: m.
View view_of(SpherePair pair, Placement a, Placement b, bool of_a, float margin) {
  Placement at = b, frame = a;
  mat3 b_to_a = transpose(a.rotation) * b.rotation, a_to_b = transpose(b_to_a);
  vec3 b_in_a = (b.position - a.position) * a.rotation;
  Carry to_a = Carry(b_to_a, b_in_a), to_field = to_a;
  uint own = pair.b, other = pair.a;
  if (of_a) {
    to_field = Carry(a_to_b, -(a_to_b * b_in_a));
    at = a;
    frame = b;
    own = pair.a;
    other = pair.b;
  }
  Drift goes = drift_of(own, at, other, frame);
  return View(samples_of(own), samples_of(other), field_of(bodies[own].ids.x), field_of(bodies[other].ids.x),
              to_field, to_a, of_a ? 0u : SPHERE_SIDE_B, goes.drift, goes.twist, margin,
              settings.softness[0].z * worlds[world_index].gravity.w, true);
}

void emit(View view, vec3 on_a, vec3 normal, float separation, uint feature) {
  emit(on_a, normal, separation, feature);
}

#include "shared/sphere/touch.h"

Touch touch_of(View view, uint node) {
  Touch touch;
  touch.point = carried(view.to_field, node_at(view.samples, node));
  touch.distance = sample_field(view.field, touch.point, touch.gradient) - radius_of(view.samples);
  return touch;
}

// Computes the touches of a node (a = b) or of both ends of an edge; in a loop, because compilers inline each call.
void touches_of(View view, uint a, uint b, out Touch p, out Touch q) {
  p = q = Touch(vec3(0.0), vec3(0.0), 0.0);
  for (uint end = 0u; end < (a == b ? 1u : 2u); ++end) {
    p = q;
    q = touch_of(view, end == 0u ? a : b);
  }
}
