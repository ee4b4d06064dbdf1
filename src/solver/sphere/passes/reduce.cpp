#include "solver/sphere/passes/reduce.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace bin_scenes::sphere {

void reduce(const Candidates& candidates, const Manifold& old, float size, float soon, std::vector<int>& chosen) {
  chosen.clear();
  if (candidates.empty()) return;
  static thread_local std::vector<float> apart, advantage, worth;
  int next = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (candidates[i].separation < candidates[next].separation) next = static_cast<int>(i);
  const float least_gap = std::max(0.0f, candidates[next].separation);
  apart.assign(candidates.size(), std::numeric_limits<float>::max());
  advantage.assign(candidates.size(), 0.0f);
  worth.assign(candidates.size(), 0.0f);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    // Depth counts like distance, seen through a long lens: an overlap matters before the spread of the manifold. A
    // gap counts by what it is wider than the least: of faces that are about to meet, all is as far away.
    const float separation = candidates[i].separation, gap = std::max(0.0f, separation - least_gap);
    advantage[i] = 8.0f * std::max(0.0f, -separation) - 20.0f * gap;
    // What is farther off gets the places that are left: for a wall beside it, the edge that a wheel comes down on next
    // would not be seen before it has sunk in.
    worth[i] = 1.0f / (1.0f + std::max(0.0f, gap - soon) / (1e-4f * size));
    for (const Contact& c : old.contacts)
      if (c.feature == candidates[i].feature) advantage[i] += 0.05f * size;
  }
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
      const float score = worth[i] * (apart[i] + advantage[i]);
      if (score > best) {
        best = score;
        best_i = static_cast<int>(i);
      }
    }
    if (best_i < 0) return;
    next = best_i;
  }
}

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

}  // namespace bin_scenes::sphere
