// Determines whether a body is a ball: its shape is one node with a radius. A ball is tested by a closed form instead
// of by samples. Needs the bindings Bodies and Shapes.
bool is_ball(uint body) { return body != SPHERE_GROUND && shapes[bodies[body].ids.x].field.z > 0.0; }
