layout(location = 0) in vec3 position;  // model frame
layout(location = 1) in vec3 normal;    // of the face, model frame

uniform mat4 model_view;  // model -> optical frame
uniform mat4 projection;  // optical frame -> clip

out vec3 view_position;
flat out vec3 view_normal;

void main() {
  vec4 p = model_view * vec4(position, 1.0);
  view_position = p.xyz;
  view_normal = mat3(model_view) * normal;
  gl_Position = projection * p;
}
