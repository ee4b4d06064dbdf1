// Contacts between the nodes of a sharp edge (Macklin et al. 2020, "Local optimization for robust signed distance field
// collision"). Needs sphere/field.h and the bindings Nodes, Edges, Clusters.

// Deepest point of the field along an edge whose ends both rise away from its inside. Regula falsi on the slope along
// the edge, which is monotonic where the other surface is convex.
bool descend(Field field, vec3 p, vec3 q, float radius, out vec3 point, out vec3 gradient, out float distance) {
  vec3 along = q - p, gradient_q;
  float lowest = sample_field(field, p, gradient);
  lowest = min(lowest, sample_field(field, q, gradient_q));
  float s0 = dot(gradient, along), s1 = dot(gradient_q, along), t0 = 0.0, t1 = 1.0;
  for (int i = 0; i < 6; ++i) {
    // Halving every other time keeps the bracket shrinking where the slope jumps (the other part's sharp edge).
    float t = (i & 1) == 1 ? 0.5 * (t0 + t1) : t0 + (t1 - t0) * s0 / (s0 - s1);
    point = p + t * along;
    distance = sample_field(field, point, gradient);
    float slope = dot(gradient, along);
    if (slope < 0.0) {
      t0 = t;
      s0 = slope;
    } else {
      t1 = t;
      s1 = slope;
    }
    if (t1 - t0 < 0.02) break;
  }
  return distance < lowest - radius;
}

// Where two sharp edges cross, the grid rounds the edge off and its inner distance is that to a face, not to the edge.
// The nearest edge of the field's body, if there is one that crosses, gives depth and direction exactly: along the
// common normal of both edges. `point`, `gradient`, `distance` are the field's answer and are replaced.
void cross_edges(SphereSamples other, float reach, vec3 p, vec3 q, inout vec3 point, inout vec3 gradient,
                 inout float distance) {
  vec3 u = q - p, from = point, out_of = gradient;
  float uu = dot(u, u), nearest = reach;
  for (uint c = 0u; c < other.clusters.y; ++c) {
    SphereCluster cluster = clusters[other.clusters.x + c];
    float far = cluster.ball.w + nearest;
    vec3 way = cluster.ball.xyz - from;
    if (dot(way, way) > far * far) continue;
    for (uint e = cluster.edges.x; e < cluster.edges.y; ++e) {
      uvec4 ends = edges[other.nodes.z + e];
      vec3 r = nodes[other.nodes.x + ends.x].xyz, v = nodes[other.nodes.x + ends.y].xyz - r, w = p - r;
      float uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w), det = uu * vv - uv * uv;
      if (det < 0.03 * uu * vv) continue;  // within 10 degrees of parallel: nodes stand for these
      float s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
      if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) continue;
      vec3 on_u = p + s * u, between = on_u - (r + t * v);
      if (length(between) >= nearest) continue;
      vec3 normal = normalize(cross(u, v));
      if (dot(normal, out_of) < 0.0) normal = -normal;
      if (dot(normal, out_of) < 0.7) continue;  // not the way out here
      nearest = length(between);
      point = on_u;
      gradient = normal;
      distance = dot(between, normal);
    }
  }
}
