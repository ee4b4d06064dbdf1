// Whether a body is a ball, one node of its own radius. Needs the bindings Bodies and Shapes.
bool is_ball(uint body) { return body != SPHERE_GROUND && shapes[bodies[body].ids.x].field.z > 0.0; }
