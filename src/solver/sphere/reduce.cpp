#include "solver/sphere/reduce.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bin_scenes::sphere {

namespace {

constexpr float farthest = std::numeric_limits<float>::max();

/// The candidate with the highest score, ties by feature.
struct Best {
  float score = -farthest;
  int number = -1;

  void offer(const std::vector<Candidate>& candidates, int i, float value) {
    const bool tie = number >= 0 && value == score && candidates[i].feature < candidates[number].feature;
    if (value > score || tie) score = value, number = i;
  }
};

/// How far apart two candidates are (m), in position and normal alike.
float way_between(const Candidate& c, const Candidate& other, float size) {
  return (c.on_a - other.on_a).norm() + 0.3f * size * (c.normal - other.normal).norm();
}

/// Number k of `count` directions in the plane of a face, evenly all around.
Vec3f direction_in(const Vec3f& normal, int k, int count) {
  const Vec3f first = normal.cross(std::abs(normal.x()) < 0.7f ? Vec3f::UnitX() : Vec3f::UnitY()).normalized();
  const float angle = 2.0f * static_cast<float>(M_PI) * (static_cast<float>(k) + 0.5f) / static_cast<float>(count);
  return std::cos(angle) * first + std::sin(angle) * normal.cross(first);
}

/// Chooses the deepest of each face; `face` becomes that of each candidate.
void choose_faces(const std::vector<Candidate>& candidates, int most, std::vector<int>& face,
                  std::vector<int>& chosen) {
  static thread_local std::vector<float> likeness;  // to the face that a candidate belongs to
  const int n = static_cast<int>(candidates.size());
  likeness.assign(candidates.size(), -farthest);
  face.assign(candidates.size(), 0);
  while (static_cast<int>(chosen.size()) < most) {
    Best deepest;
    for (int i = 0; i < n; ++i)
      if (likeness[i] < like) deepest.offer(candidates, i, -candidates[i].separation);
    if (deepest.number < 0) return;
    const Vec3f& normal = candidates[deepest.number].normal;
    for (int i = 0; i < n; ++i) {
      const float now = candidates[i].normal.dot(normal);
      if (now <= likeness[i]) continue;
      likeness[i] = now;
      face[i] = static_cast<int>(chosen.size());
    }
    chosen.push_back(deepest.number);
  }
}

/// Chooses those of each face that are met first when the bodies tilt on it.
void choose_outermost(const std::vector<Candidate>& candidates, const std::vector<int>& face, float size, float tilt,
                      int most, std::vector<int>& chosen) {
  const int faces = static_cast<int>(chosen.size());
  const int count = std::min(max_directions, (most - faces) / faces);
  std::array<std::array<Vec3f, max_directions>, max_faces> directions;
  std::array<std::array<Best, max_directions>, max_faces> outermost;
  for (int f = 0; f < faces; ++f)
    for (int k = 0; k < count; ++k) directions[f][k] = direction_in(candidates[chosen[f]].normal, k, count);
  for (int i = 0; i < static_cast<int>(candidates.size()); ++i) {
    const float height = candidates[i].separation / tilt;
    for (int k = 0; k < count; ++k)
      outermost[face[i]][k].offer(candidates, i, directions[face[i]][k].dot(candidates[i].on_a) - height);
  }
  const auto is_twin = [&](int i) {
    return std::any_of(chosen.begin(), chosen.end(), [&](int other) {
      return way_between(candidates[i], candidates[other], size) < 1e-3f * size;
    });
  };
  for (int f = 0; f < faces; ++f)
    for (int k = 0; k < count; ++k)
      if (const int i = outermost[f][k].number; !is_twin(i)) chosen.push_back(i);
}

/// Chooses those farthest from the ones chosen.
void choose_far(const std::vector<Candidate>& candidates, float size, int most, std::vector<int>& chosen) {
  static thread_local std::vector<float> apart;  // from the nearest chosen one
  apart.assign(candidates.size(), farthest);
  std::size_t seen = 0;  // of the chosen
  while (static_cast<int>(chosen.size()) < most) {
    Best best;
    for (int i = 0; i < static_cast<int>(candidates.size()); ++i) {
      const Candidate& c = candidates[i];
      for (std::size_t k = seen; k < chosen.size(); ++k)
        apart[i] = std::min(apart[i], way_between(c, candidates[chosen[k]], size));
      if (apart[i] < 1e-3f * size) continue;
      // Depth counts like distance, seen through a long lens: an overlap matters before the spread of the manifold.
      const float depth = c.separation < 0 ? -8.0f * c.separation : -2.0f * c.separation;
      const float score = apart[i] + depth + (c.known ? 0.05f * size : 0.0f);
      if (score > 0) best.offer(candidates, i, score);
    }
    if (best.number < 0) return;
    seen = chosen.size();
    chosen.push_back(best.number);
  }
}

}  // namespace

void reduce(const std::vector<Candidate>& candidates, float size, float tilt, int most, std::vector<int>& chosen) {
  static thread_local std::vector<int> face;
  chosen.clear();
  choose_faces(candidates, std::min(max_faces, most), face, chosen);
  if (chosen.empty()) return;
  choose_outermost(candidates, face, size, tilt, most, chosen);
  choose_far(candidates, size, std::min(enough_contacts, most), chosen);
}

}  // namespace bin_scenes::sphere
