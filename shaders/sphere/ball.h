// Returns whether a body is a ball: its shape is one node with a radius. A closed form of the distance replaces the
// distance field of a ball. Needs the bindings Bodies and Shapes.
bool is_ball(uint body) { return body != SPHERE_GROUND && shapes[bodies[body].ids.x].field.z > 0.0; }
