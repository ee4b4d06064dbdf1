#include "solver/sphere/passes/reduce.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace bin_scenes::sphere {

void reduce(const Candidates& candidates, const Manifold& old, const Approach& approach, float size, float soon,
            std::vector<int>& chosen) {
  chosen.clear();
  if (candidates.empty()) return;
  BIN_SCENES_ASSERT(size > 0 && soon >= 0);
  static thread_local std::vector<float> apart, advantage, worth;
  int next = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (candidates[i].separation < candidates[next].separation) next = static_cast<int>(i);
  const float least = candidates[next].separation;
  apart.assign(candidates.size(), std::numeric_limits<float>::max());
  advantage.assign(candidates.size(), 0.0f);
  worth.assign(candidates.size(), 0.0f);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    const auto same = [&](const Contact& o) { return o.feature == c.feature; };
    const bool known = old.found && std::any_of(old.contacts.begin(), old.contacts.end(), same);
    const float gap = gap_of(approach, c.on_a, c.normal, c.separation, least, size);
    advantage[i] = advantage_of(c.separation, gap, known, size);
    worth[i] = worth_of(gap, soon, size);
  }
  while (static_cast<int>(chosen.size()) < max_contacts) {
    chosen.push_back(next);
    const Candidate& c = candidates[next];
    apart[next] = -1;
    float best = 0;
    int best_i = -1;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (apart[i] < 0) continue;
      const Candidate& p = candidates[i];
      apart[i] = std::min(apart[i], distance_between(p.on_a, p.normal, c.on_a, c.normal, size));
      if (apart[i] < TWIN * size) {
        apart[i] = -1;
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

void carry_forces(const Manifold& last, std::vector<Contact>& fresh, float near) {
  BIN_SCENES_ASSERT(fresh.size() <= max_contacts && last.contacts.size() <= max_contacts && near >= 0);
  const std::vector<Contact>& old = last.contacts;
  std::array<bool, max_contacts> taken{}, warm{};
  const auto take = [&](std::size_t i, std::size_t k) {
    fresh[i].normal_force = old[k].normal_force;
    fresh[i].friction_force = old[k].friction_force;
    taken[k] = warm[i] = true;
  };
  for (std::size_t i = 0; last.found && i < fresh.size(); ++i)
    for (std::size_t k = 0; k < old.size(); ++k)
      if (!taken[k] && !warm[i] && old[k].feature == fresh[i].feature) take(i, k);
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    if (warm[i]) continue;
    std::size_t best = old.size();
    float nearest = near;
    for (std::size_t k = 0; k < old.size(); ++k) {
      const float distance = (old[k].anchor_a - fresh[i].anchor_a).norm();
      if (taken[k] || distance > nearest || old[k].normal.dot(fresh[i].normal) < ALIKE) continue;
      best = k;
      nearest = distance;
    }
    if (best < old.size()) take(i, best);
  }
}

}  // namespace bin_scenes::sphere
