in vec3 view_position;
flat in vec3 view_normal;

uniform uint label;

layout(location = 0) out float depth;  // along the optical axis, not the z-buffer's
layout(location = 1) out uint part;
layout(location = 2) out vec4 normal;  // towards the camera; w = cosine of incidence

void main() {
  vec3 ray = normalize(view_position);
  vec3 n = faceforward(view_normal, ray, view_normal);
  depth = view_position.z;
  part = label;
  normal = vec4(n, -dot(n, ray));
}
