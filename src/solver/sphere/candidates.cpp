#include "solver/sphere/candidates.hpp"

#include "solver/sphere/edge_contact.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::sphere {

namespace {

constexpr float nearly_all = 0.99f;  ///< of an exact way out a cone must leave: 8 degrees
constexpr float leans = 0.02f;       ///< sine of the angle by which a face leans against an edge that dips below it

/// A node of a curved face stands for its surroundings: slides it along its own surface to where it lies deepest. The
/// way follows from the angle between the node's normal and the gradient of `depth(point, gradient)`, and from how fast
/// the normals turn (cone); the part's own field brings the point back to the surface. `point`, `gradient` and
/// `distance` are the node's own in the other frame, and are replaced.
template <class Depth>
void slide(const Samples& samples, const Field& own, const Carry& carry, std::size_t node, const Depth& depth,
           Vec3f& point, Vec3f& gradient, float& distance) {
  constexpr float flat = 0.02f;  // rad: below it the node itself is deep enough
  const Cone& cone = samples.cones[node];
  if (cone.axis.isZero() || cone.spread < flat || own.ball > 0) return;
  float way_per_angle = 2.0f * samples.face_spacing / cone.spread;
  Vec3f x = samples.nodes[node], normal = cone.axis;
  for (int i = 0; i < 6; ++i) {
    const Vec3f down = -(carry.rotation.transpose() * gradient);
    const Vec3f across = down - down.dot(normal) * normal;
    const float angle = across.norm();
    if (angle < flat || down.dot(normal) < 0.5f) return;
    Vec3f there = x + std::min(angle * way_per_angle, samples.face_spacing) / angle * across, normal_there, slope;
    const float off = own.sample(there, normal_there);
    there -= off * normal_there;
    const Vec3f carried = carry(there);
    const float deeper = depth(carried, slope);
    // Past the deepest point, over the rim of the face, or where another node stands.
    if (deeper >= distance || std::abs(own.sample(there)) > 0.1f * own.cell ||
        (there - samples.nodes[node]).norm() > samples.face_spacing) {
      way_per_angle *= 0.5f;
      continue;
    }
    x = there;
    normal = normal_there;
    point = carried;
    gradient = slope;
    distance = deeper;
  }
}

/// The way out of a sample that is inside, or as good as, and whose surface cannot be pressed against the nearest way
/// out: of parts that lie flush (two plates side by side on the floor) that is the face level with it, although it is
/// deeper in behind another. Goes back from `point` through the sample's own body, along the middle of its cone, for at
/// most four cells, until it is outside; `gradient` and `distance` are replaced by those of the face it comes out of.
bool find_way_out(const Field& field, const Vec3f& point, const Vec3f& back, Vec3f& gradient, float& distance) {
  const float reach = 4.0f * field.cell, least = 0.25f * field.cell;
  float t = 0, before = distance;
  bool inside = distance < 0;
  while (t < reach) {
    const float way = std::max(std::abs(before), least);
    t += way;
    const float now = field.sample(point + t * back);
    if (now >= 0 && inside) {
      t -= way * now / (now - before);
      field.sample(point + t * back, gradient);
      distance = -t * back.dot(gradient);
      return distance <= 0;
    }
    inside = inside || now < 0;
    before = now;
  }
  return false;
}

/// Samples against a field, bounding spheres first. `emit(point, gradient, distance, feature)` in the field's frame.
template <class Emit>
void test_samples(const Samples& samples, const Field& own, const Field& field, const Samples& other,
                  const Carry& carry, float margin, Counters& counters, Emit&& emit) {
  const float error = field.ball > 0 ? 0.0f : 0.5f * field.cell;  // of the grid where it bends
  const float slack = margin + samples.radius + samples.sag + error;
  const auto depth_in_field = [&](const Vec3f& p, Vec3f& out) { return field.sample(p, out); };
  Points<group_size> center;
  Points<cluster_size> point;
  float cluster_distance[group_size], distance[cluster_size];
  Vec3f gradient[cluster_size];  // few are needed
  std::uint32_t known;           // which of them are there
  const auto press = [&](const Vec3f& p, const Vec3f& out, float d, const Cone& cone, std::uint32_t feature,
                         float least = Cone::least_left) {
    Vec3f pressed = -(carry.rotation.transpose() * out);  // how the sample is pressed if `out` is the way out for it
    if (!cone.restrict(pressed, least)) return false;
    emit(p, Vec3f(-(carry.rotation * pressed)), d, feature);
    return true;
  };
  // A face that leans against an edge of the sample is not what it presses where that crosses an edge of the face: it
  // presses along the normal of both edges, and two such nodes, one on each, would hold each other like a wedge.
  const auto is_crossed = [&](const Vec3f& p, const Cone& cone, const Vec3f& out) {
    for (int i = 0; i < cone.bounds; ++i) {
      const Vec3f along = carry.rotation * cone.bound[i];
      Vec3f normal;
      if (along.dot(out) > -leans || !passes_edge(other, field, p, along, out, normal)) continue;
      Vec3f pressed = -(carry.rotation.transpose() * normal);
      if (cone.restrict(pressed, nearly_all)) return true;
    }
    return false;
  };
  // Near a sharp edge ways out are exact: what presses against none of them does not press there. Turned into the cone,
  // the way out past an edge held up what leant on it from the side.
  const auto offer_at_edge = [&](const Vec3f& p, const Cone& cone, std::uint32_t feature) {
    if (samples.radius > 0 || cone.all()) return false;  // which of two faces it presses against is not known
    const WaysOut ways = ways_out_at_edge(other, field, p);
    bool out_there = false;
    for (int i = 0; i < ways.count; ++i) {
      const auto& [out, d] = ways.way[i];
      // Half a cell beyond is outside, unless this is a seam between shells that touch.
      if (field.sample(p + (0.5f * field.cell - d) * out) < 0.3f * field.cell) continue;
      out_there = true;
      if (is_crossed(p, cone, out)) continue;
      if (press(p, out, d, cone, feature, nearly_all)) break;
    }
    return out_there;
  };
  const auto offer = [&](const Vec3f& p, Vec3f out, float d, const Cone& cone, std::uint32_t feature) {
    if (offer_at_edge(p, cone, feature) || press(p, out, d, cone, feature)) return;
    if (d < -2.0f * field.cell)  // deep inside any way out is better than none
      emit(p, out, d, feature);
    else if (d < error && find_way_out(field, p, -(carry.rotation * cone.middle()), out, d))
      press(p, out, d, cone, feature);
  };
  counters.nodes_possible += samples.nodes.size();
  for (std::size_t g = 0; g < samples.groups.size(); ++g) {
    ++counters.groups_tested;
    if (field.sample(carry(samples.groups[g].center)) > samples.groups[g].radius + slack) continue;
    const std::size_t first_cluster = g * group_size;
    const std::size_t clusters = std::min(samples.clusters.size() - first_cluster, std::size_t{group_size});
    counters.clusters_tested += clusters;
    sample(field, carry, samples.cluster_points[g], center, cluster_distance);
    for (std::size_t k = 0; k < clusters; ++k) {
      const std::size_t c = first_cluster + k;
      if (cluster_distance[k] > samples.clusters[c].radius + slack) continue;
      const std::size_t first = c * cluster_size, n = std::min(samples.nodes.size() - first, std::size_t{cluster_size});
      counters.nodes_tested += n;
      sample(field, carry, samples.node_points[c], point, distance);
      known = 0;
      const auto gradient_at = [&](std::size_t i) -> const Vec3f& {
        if (!(known >> i & 1u)) field.sample(point[i], gradient[i]);
        known |= 1u << i;
        return gradient[i];
      };
      for (std::size_t i = 0; i < n; ++i) {
        distance[i] -= samples.radius;
        if (distance[i] >= margin + samples.sag) continue;
        Vec3f at = point[i], out = gradient_at(i);
        float d = distance[i];
        slide(samples, own, carry, first + i, depth_in_field, at, out, d);
        if (d < margin) offer(at, out, d, samples.cones[first + i], static_cast<std::uint32_t>(first + i));
      }
      for (std::uint32_t e = samples.first_edge[c]; e < samples.first_edge[c + 1]; ++e) {
        const Edge& edge = samples.edges[e];
        const std::size_t ia = edge.a - first, ib = edge.b - first;
        const Vec3f p = point[ia], q = ib < n ? point[ib] : carry(samples.nodes[edge.b]);
        const float distance_q = ib < n ? distance[ib] : field.sample(q);
        const float at_least = 0.5f * (distance[ia] + distance_q - edge.length);  // it falls by no more than the way
        if (at_least >= margin) continue;
        Vec3f gradient_q, deepest, normal;
        if (ib < n)
          gradient_q = gradient_at(ib);
        else
          field.sample(q, gradient_q);
        const Vec3f gradient_p = gradient_at(ia);
        float depth;
        if (!descend(field, p, q, gradient_p, gradient_q, std::min(distance[ia], distance_q), deepest, normal, depth)) {
          // Where edges are nearly parallel, or end, one dips below the other by less than the grid can tell.
          for (const bool from_p : {true, false}) {
            deepest = from_p ? p : q;
            normal = from_p ? gradient_p : gradient_q;
            depth = from_p ? distance[ia] : distance_q;
            if (!edge.sharp || samples.radius > 0 || std::abs(depth) > field.cell ||
                !cross_edges(other, field, p, q, deepest, normal, depth))
              continue;
            if (depth < margin) press(deepest, normal, depth, edge.cone, e | edge_bit, nearly_all);
            break;
          }
          continue;
        }
        const bool crossed = cross_edges(other, field, p, q, deepest, normal, depth);
        if (depth >= margin) continue;
        if (!crossed || !press(deepest, normal, depth, edge.cone, e | edge_bit))
          offer(deepest, normal, depth, edge.cone, e | edge_bit);
      }
    }
  }
}

/// Distance to the solid beyond a plane, and the direction out of it. A wall ends at the bin's top: it is the corner
/// between its inner face and the rim's level, as thick as it takes.
float plane_distance(const World& world, const Plane& plane, const Vec3f& p, Vec3f& out) {
  const float face = plane.normal.dot(p) - plane.offset;
  out = plane.normal;
  if (!plane.wall) return face;
  const float above = p.z() - world.wall_top;
  if (above <= 0 && face >= 0) return face;
  if (above <= 0) {
    if (face >= above) return face;
    out = Vec3f::UnitZ();
    return above;
  }
  if (face <= 0) {
    out = Vec3f::UnitZ();
    return above;
  }
  const float d = std::sqrt(above * above + face * face);
  out = (above * Vec3f::UnitZ() + face * plane.normal) / d;
  return d;
}

/// The rim of a wall against the field of a part that lies across it: a line passes between the part's nodes. One
/// candidate for each place along it where it is nearest, or deepest.
void candidates_of_rim(const World& world, std::size_t k, const Shape& shape, const Samples& samples,
                       const Placement& a, float margin, Candidates& out) {
  constexpr float least_out = -0.1f;  // the way out of the rim is upwards, off the wall, or between the two
  const Plane& plane = world.planes[k];
  const float face = plane.normal.dot(a.x) - plane.offset, above = a.x.z() - world.wall_top;
  const float reach = shape.radius + margin, near = reach * reach - face * face - above * above;
  if (!plane.wall || near <= 0 || samples.face_spacing <= 0) return;
  const Vec3f along = plane.normal.cross(Vec3f::UnitZ());
  const Vec3f start = plane.offset * plane.normal + world.wall_top * Vec3f::UnitZ();
  const Mat3f back = a.rotation.transpose();
  const auto on_rim = [&](float t) { return Vec3f(back * (start + t * along - a.x)); };
  const float step = samples.face_spacing, middle = along.dot(a.x), half = std::sqrt(near);
  const int first = static_cast<int>(std::floor((middle - half) / step));
  const int last = static_cast<int>(std::ceil((middle + half) / step));
  float before = shape.field.sample(on_rim(step * static_cast<float>(first - 1)));
  float here = shape.field.sample(on_rim(step * static_cast<float>(first)));
  for (int i = first; i <= last; ++i) {
    const float after = shape.field.sample(on_rim(step * static_cast<float>(i + 1)));
    const bool nearest =  // or an end of where it lies along a face
        here <= before && here <= after && (here < before || here < after) && here - step < margin;
    before = here;
    here = after;
    if (!nearest) continue;
    float lower = step * static_cast<float>(i - 1), upper = step * static_cast<float>(i + 1);
    for (int round = 0; round < 8; ++round) {
      const float t0 = lower + (upper - lower) / 3, t1 = upper - (upper - lower) / 3;
      if (shape.field.sample(on_rim(t0)) <= shape.field.sample(on_rim(t1)))
        upper = t1;
      else
        lower = t0;
    }
    const float t = 0.5f * (lower + upper);
    const Vec3f x = on_rim(t), p = start + t * along;
    Vec3f gradient;
    const float d = shape.field.sample(x, gradient);
    const Vec3f way_out = -(a.rotation * gradient);
    const auto within = [&](const Plane& other) { return other.wall && other.normal.dot(p) < other.offset - margin; };
    if (d >= margin || way_out.z() < least_out || way_out.dot(plane.normal) < least_out ||
        std::any_of(world.planes.begin(), world.planes.end(), within))
      continue;
    const auto place = static_cast<std::uint32_t>(i + 0x400000) & 0x7fffffu;
    out.push_back({x - d * gradient, x, gradient, d, side_b | static_cast<std::uint32_t>(place + k * 0x1000000u)});
  }
}

}  // namespace

void candidates_of_pair(const World& world, const Manifold& m, const Placement& a, const Placement& b, float margin,
                        Counters& counters, Candidates& out) {
  const Body &body_a = world.bodies[m.a], &body_b = world.bodies[m.b];
  const Shape &sa = *world.shapes[body_a.shape], &sb = *world.shapes[body_b.shape];
  const Samples &samples_a = world.samples(body_a), &samples_b = world.samples(body_b);
  const Carry b_to_a{a.rotation.transpose() * b.rotation, a.rotation.transpose() * (b.x - a.x)};
  const Carry a_to_b{b_to_a.rotation.transpose(), -(b_to_a.rotation.transpose() * b_to_a.offset)};
  test_samples(samples_a, sa.field, sb.field, samples_b, a_to_b, margin, counters,
               [&](const Vec3f& p, const Vec3f& g, float d, std::uint32_t feature) {
                 const Vec3f surface = p - samples_a.radius * g;
                 out.push_back({b_to_a(surface), b_to_a(surface - d * g), -(b_to_a.rotation * g), d, feature});
               });
  test_samples(samples_b, sb.field, sa.field, samples_a, b_to_a, margin, counters,
               [&](const Vec3f& p, const Vec3f& g, float d, std::uint32_t feature) {
                 const Vec3f surface = p - samples_b.radius * g;
                 out.push_back({surface - d * g, surface, g, d, feature | side_b});
               });
}

void candidates_of_ground(const World& world, const Manifold& m, const Placement& a, float margin, Counters& counters,
                          Candidates& out) {
  const Body& body = world.bodies[m.a];
  const Samples& samples = world.samples(body);
  const Mat3f back = a.rotation.transpose();
  const Carry carry{a.rotation, a.x};
  counters.nodes_possible += samples.nodes.size();
  for (std::size_t k = 0; k < world.planes.size(); ++k) {
    const Plane& plane = world.planes[k];
    const auto depth = [&](const Vec3f& p, Vec3f& out) { return plane_distance(world, plane, p, out); };
    for (std::size_t c = 0; c < samples.clusters.size(); ++c) {
      ++counters.clusters_tested;
      const Vec3f center = a.x + a.rotation * samples.clusters[c].center;
      if (plane.normal.dot(center) - plane.offset > samples.clusters[c].radius + samples.radius + samples.sag + margin)
        continue;
      const std::size_t last = std::min(samples.nodes.size(), (c + 1) * cluster_size);
      counters.nodes_tested += last - c * cluster_size;
      for (std::size_t i = c * cluster_size; i < last; ++i) {
        Vec3f p = carry(samples.nodes[i]), up;
        float d = plane_distance(world, plane, p, up) - samples.radius;
        if (d > margin + samples.sag) continue;
        slide(samples, world.shapes[body.shape]->field, carry, i, depth, p, up, d);
        if (d > margin) continue;
        const Vec3f surface = p - samples.radius * up;
        out.push_back({back * (surface - a.x), back * (surface - d * up - a.x), -(back * up), d,
                       static_cast<std::uint32_t>(i + k * 0x1000000u)});
      }
    }
    candidates_of_rim(world, k, *world.shapes[body.shape], samples, a, margin, out);
  }
}

}  // namespace bin_scenes::sphere
