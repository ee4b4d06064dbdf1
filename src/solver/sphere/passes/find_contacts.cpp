/// Samples of each body of a pair against the other's field; of all that touch, the few that stand for the rest. GPU
/// form: collect_samples, test_samples and choose_contacts in shaders/sphere; what both compute is in
/// shaders/shared/sphere.
#include "bin_scenes/core/cancel.hpp"
#include "solver/sphere/invariants.hpp"
#include "solver/sphere/math.hpp"
#include "solver/sphere/passes/candidates.hpp"
#include "solver/sphere/passes/contact_gap.hpp"
#include "solver/sphere/passes/reduce.hpp"
#include "solver/sphere/world.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace bin_scenes::sphere {

namespace {

constexpr std::size_t pairs_per_task = 16;  ///< fewer = more handing over; more = threads wait for the last one

Contact contact_of(const Candidate& c, const Placement& a, const Placement* b) {
  Contact contact;
  contact.anchor_a = c.on_a;
  contact.feature = c.feature;
  contact.normal = a.rotation * c.normal;
  const Vec3f on_b = a.x + a.rotation * c.on_b;
  contact.anchor_b = b ? Vec3f(b->rotation.transpose() * (on_b - b->x)) : on_b;
  // The normal turns with the body whose field it comes from.
  const bool field_of_a = c.feature & SPHERE_SIDE_B;
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

/// Whether the pair has hardly moved since its contacts were found. What strikes is found anew: beside an edge the
/// plane that it will meet turns with every bit of displacement. The point where a ball touches stays below it, while
/// one that is kept turns with it: the ball would stand on what it has rolled over, which drives it on.
bool recyclable(const World& world, const Manifold& m, const RelativePose& now, float size) {
  if (!m.found) return false;
  if (world.is_ball(world.bodies[m.a]) || (m.b != ground && world.is_ball(world.bodies[m.b]))) return false;
  const float limit = world.recycle() * size;
  const float half_turn = (m.found_q.conjugate() * now.q).vec().norm();  // sine of half the angle
  const float moved = std::max((now.x - m.found_x).norm(), half_turn * size), fresh = STRIKE * limit;
  const float seconds =
      world.settings.time_step + world.plan().sub_step;  // the last sweeps look into the next sub-step
  return moved < limit && (moved <= fresh || !strikes(world, m, seconds, fresh));
}

/// Returns the motion of b, or of the ground if there is no b, relative to a in this step. Gravity is left out: it
/// does not move parts that rest on each other, and of two parts in free fall it moves both.
Approach approach_of(const World& world, const Body& a, const Body* b, const Placement& at_a, const Placement* at_b) {
  const Mat3f back = world.settings.time_step * at_a.rotation.transpose();
  Vec3f v = Vec3f::Zero(), w = Vec3f::Zero();
  if (a.moves()) {
    v = -a.v;
    w = -a.w;
  }
  if (b && b->moves()) {
    v += b->v + b->w.cross(at_a.x - at_b->x);
    w += b->w;
  }
  return {back * v, back * w};
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
  const float dt = world.settings.time_step;
  const Vec3f v = b ? Vec3f(b->v - a.v) : Vec3f(-a.v);
  const float spin = a.w.norm() * sa.radius + (b ? b->w.norm() * world.shapes[b->shape]->radius : 0.0f);
  const float distance = (v.norm() + spin + world.gravity.norm() * dt) * dt;
  if (recyclable(world, m, pose, size)) {
    ++counters.pairs_recycled;
  } else {
    const float margin = world.settings.margin * size + (world.settings.speculation ? distance : 0.0f);
    const Placement there_a(world, a);
    const std::optional<Placement> there_b = b ? std::optional<Placement>({world, *b}) : std::nullopt;
    candidates.clear();
    if (b)
      candidates_of_pair(world, m, there_a, *there_b, margin, counters, candidates);
    else
      candidates_of_ground(world, m, there_a, margin, counters, candidates);
    if (candidates.empty()) ++counters.pairs_culled;
    // What is fast may meet all within the distance that it moves.
    const float soon = world.settings.soonest_first
                           ? SOON * size + std::max(0.0f, distance - world.settings.margin * size)
                           : std::numeric_limits<float>::infinity();
    const Placement* at_b = there_b ? &*there_b : nullptr;
    reduce(candidates, m, approach_of(world, a, b, there_a, at_b), size, soon, chosen);
    counters.dropped += candidates.size() - chosen.size();
    fresh.clear();
    for (const int i : chosen) fresh.push_back(contact_of(candidates[i], there_a, at_b));
    carry_forces(m, fresh, world.samples(a).spacing);
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
            [&, flag = cancel_flag()](const tbb::blocked_range<std::size_t>& range, Counters counters) {
              const CancelScope scope(flag);
              for (std::size_t i = range.begin(); i < range.end(); ++i) {
                stop_if_cancelled();
                const Manifold& m = world.manifolds[i];
                const AssertionScope place({world.scene, static_cast<std::int64_t>(world.counters.steps), m.a,
                                            m.b == ground ? -1 : static_cast<std::int64_t>(m.b)});
                find_contacts_of(world, world.manifolds[i], counters);
              }
              return counters;
            },
            [](Counters a, const Counters& b) { return a += b; });
      });
  BIN_SCENES_ASSERT(contacts_have_room(world));
  BIN_SCENES_ASSERT(normals_are_unit(world));
}

}  // namespace bin_scenes::sphere
