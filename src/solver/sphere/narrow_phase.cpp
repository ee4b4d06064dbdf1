#include "solver/sphere/edge_contact.hpp"
#include "solver/sphere/math.hpp"
#include "solver/sphere/world.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>

namespace bin_scenes::sphere {

namespace {

/// A point where two surfaces are close, before reduction. Everything in the frame of `a`.
struct Candidate {
  Vec3f on_a, on_b;  ///< nearest points
  Vec3f normal;      ///< a -> b
  float separation;
  std::uint32_t feature;
};
using Candidates = std::vector<Candidate>;

constexpr std::size_t pairs_per_task = 16;  ///< fewer = more handing over; more = threads wait for the last one
constexpr std::uint32_t side_b = 1u << 31, edge_bit = 1u << 30;
constexpr float nearly_all = 0.99f;  ///< of an exact way out a cone must leave: 8 degrees

/// A body half way through the step (World::half_way), where its contacts are found.
struct Placement {
  Vec3f x;
  Mat3f rotation;

  Placement(const World& world, const Body& body) : x(body.x), rotation(body.rotation) {
    if (!body.moves()) return;
    x += world.half_way() * body.v;
    rotation = integrated(body.q, body.w, world.half_way()).toRotationMatrix();
  }
};

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
        if (!descend(field, p, q, gradient_p, gradient_q, std::min(distance[ia], distance_q), deepest, normal, depth))
          continue;
        const bool crossed = cross_edges(other, field, p, q, deepest, normal, depth);
        if (depth >= margin) continue;
        if (!crossed || !press(deepest, normal, depth, edge.cone, e | edge_bit))
          offer(deepest, normal, depth, edge.cone, e | edge_bit);
      }
    }
  }
}

/// Samples of both bodies against the other's field.
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

/// Samples of a body against walls and floor.
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
  }
}

/// The few contacts that stand for all: the deepest, then again and again the one farthest from those chosen, in
/// position and normal alike, deep ones preferred; contacts of the last step have a small advantage, so that the
/// choice does not flicker.
void reduce(const Candidates& candidates, const Manifold& old, float size, std::vector<int>& chosen) {
  chosen.clear();
  if (candidates.empty()) return;
  static thread_local std::vector<float> apart, advantage;
  apart.assign(candidates.size(), std::numeric_limits<float>::max());
  advantage.assign(candidates.size(), 0.0f);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    // Depth counts like distance, seen through a long lens: an overlap matters before the spread of the manifold.
    const float separation = candidates[i].separation;
    advantage[i] = 8.0f * std::max(0.0f, -separation) - 20.0f * std::max(0.0f, separation);
    for (const Contact& c : old.contacts)
      if (c.feature == candidates[i].feature) advantage[i] += 0.05f * size;
  }
  int next = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (candidates[i].separation < candidates[next].separation) next = static_cast<int>(i);
  const float least = 1e-3f * size;
  while (static_cast<int>(chosen.size()) < max_contacts) {
    chosen.push_back(next);
    const Candidate& c = candidates[next];
    apart[next] = -1;
    float best = 0;
    int best_i = -1;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (apart[i] < 0) continue;
      const Candidate& p = candidates[i];
      const float way = (p.on_a - c.on_a).norm() + 0.3f * size * (p.normal - c.normal).norm();
      apart[i] = std::min(apart[i], way);
      if (apart[i] < least) {
        apart[i] = -1;  // a twin of a chosen one
        continue;
      }
      const float score = apart[i] + advantage[i];
      if (score > best) {
        best = score;
        best_i = static_cast<int>(i);
      }
    }
    if (best_i < 0) return;
    next = best_i;
  }
}

/// Forces of the last step's contacts: by feature, else from the nearest with a like normal.
void carry_forces(const std::vector<Contact>& old, std::vector<Contact>& fresh, float near) {
  std::array<bool, max_contacts> taken{}, warm{};
  const auto take = [&](std::size_t i, std::size_t k) {
    fresh[i].normal_force = old[k].normal_force;
    fresh[i].friction_force = old[k].friction_force;
    taken[k] = warm[i] = true;
  };
  for (std::size_t i = 0; i < fresh.size(); ++i)
    for (std::size_t k = 0; k < old.size(); ++k)
      if (!taken[k] && !warm[i] && old[k].feature == fresh[i].feature) take(i, k);
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    if (warm[i]) continue;
    std::size_t best = old.size();
    float best_way = near;
    for (std::size_t k = 0; k < old.size(); ++k) {
      const float way = (old[k].anchor_a - fresh[i].anchor_a).norm();
      if (taken[k] || way > best_way || old[k].normal.dot(fresh[i].normal) < 0.9f) continue;
      best = k;
      best_way = way;
    }
    if (best < old.size()) take(i, best);
  }
}

Contact contact_of(const Candidate& c, const Placement& a, const Placement* b) {
  Contact contact;
  contact.anchor_a = c.on_a;
  contact.feature = c.feature;
  contact.normal = a.rotation * c.normal;
  const Vec3f on_b = a.x + a.rotation * c.on_b;
  contact.anchor_b = b ? Vec3f(b->rotation.transpose() * (on_b - b->x)) : on_b;
  // The normal turns with the body whose field it comes from.
  const bool field_of_a = c.feature & side_b;
  contact.local_normal = field_of_a ? c.normal : b ? Vec3f(b->rotation.transpose() * contact.normal) : contact.normal;
  return contact;
}

/// Pose of one body of a pair as the other sees it; of a lone body, as the bin sees it.
struct RelativePose {
  Vec3f x;
  Quatf q;
};

RelativePose relative_pose(const Body& a, const Body* b) {
  if (!b) return {a.x, a.q};
  return {a.rotation.transpose() * (b->x - a.x), a.q.conjugate() * b->q};
}

/// Whether the pair has hardly moved since its contacts were found. The point where a ball touches stays below it,
/// while one that is kept turns with it: the ball would stand on what it has rolled over, which drives it on.
bool recyclable(const World& world, const Manifold& m, const RelativePose& now, float size) {
  if (!m.found) return false;
  if (world.is_ball(world.bodies[m.a]) || (m.b != ground && world.is_ball(world.bodies[m.b]))) return false;
  const float limit = (world.fine ? world.settings.recycle : world.settings.coarse_recycle) * size;
  const float half_turn = (m.found_q.conjugate() * now.q).vec().norm();  // sine of half the angle
  return (now.x - m.found_x).squaredNorm() < limit * limit && half_turn * size < limit;
}

/// Contacts of one pair, found anew or recycled. Touches nothing but the manifold and the counters.
void find_contacts_of(const World& world, Manifold& m, Counters& counters) {
  static thread_local Candidates candidates;
  static thread_local std::vector<int> chosen;
  static thread_local std::vector<Contact> fresh;
  const Body& a = world.bodies[m.a];
  const Body* b = m.b == ground ? nullptr : &world.bodies[m.b];
  if (!a.moves() && !(b && b->moves())) return;
  ++counters.pairs;
  const Shape& sa = *world.shapes[a.shape];
  const float size = b ? std::min(sa.size, world.shapes[b->shape]->size) : sa.size;
  const RelativePose pose = relative_pose(a, b);
  if (recyclable(world, m, pose, size)) {
    ++counters.pairs_recycled;
  } else {
    const float dt = world.settings.time_step;
    const Vec3f v = b ? Vec3f(b->v - a.v) : Vec3f(-a.v);
    const float spin = a.w.norm() * sa.radius + (b ? b->w.norm() * world.shapes[b->shape]->radius : 0.0f);
    const float margin = world.settings.margin * size + (v.norm() + spin + world.gravity.norm() * dt) * dt;
    const Placement there_a(world, a);
    const std::optional<Placement> there_b = b ? std::optional<Placement>({world, *b}) : std::nullopt;
    candidates.clear();
    if (b)
      candidates_of_pair(world, m, there_a, *there_b, margin, counters, candidates);
    else
      candidates_of_ground(world, m, there_a, margin, counters, candidates);
    if (candidates.empty()) ++counters.pairs_culled;
    reduce(candidates, m, size, chosen);
    counters.dropped += candidates.size() - chosen.size();
    fresh.clear();
    for (const int i : chosen) fresh.push_back(contact_of(candidates[i], there_a, there_b ? &*there_b : nullptr));
    carry_forces(m.contacts, fresh, world.samples(a).spacing);
    m.contacts.assign(fresh.begin(), fresh.end());
    m.found = true;
    m.found_x = pose.x;
    m.found_q = pose.q;
  }
  counters.contacts += m.contacts.size();
}

}  // namespace

/// Pairs share nothing but what they read, so that threads cannot change a result.
void find_contacts(World& world) {
  world.counters +=
      tbb::this_task_arena::isolate([&] {  // keeps other worlds' steps out of this thread until all is done
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, world.manifolds.size(), pairs_per_task), Counters{},
            [&](const tbb::blocked_range<std::size_t>& range, Counters counters) {
              for (std::size_t i = range.begin(); i < range.end(); ++i)
                find_contacts_of(world, world.manifolds[i], counters);
              return counters;
            },
            [](Counters a, const Counters& b) { return a += b; });
      });
}

}  // namespace bin_scenes::sphere
