#include "orientation.hpp"

#include "edge_uses.hpp"
#include "shells.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace bin_scenes::repair {

namespace {

void turn(Triangle& t) {
  std::swap(t[1], t[2]);
}

}  // namespace

Agreement agree_winding(Mesh& mesh) {
  struct Link {
    std::uint32_t triangle;
    bool agrees;
  };
  std::vector<std::array<Link, 3>> links(mesh.triangles.size());
  std::vector<std::uint8_t> degree(mesh.triangles.size(), 0);
  bool agreed = true;
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 2) return;
    const std::uint32_t a = first->triangle, b = first[1].triangle;
    const bool agrees = first->forward != first[1].forward;
    BIN_SCENES_ASSERT(degree[a] < 3 && degree[b] < 3);
    agreed = agreed && agrees;
    links[a][degree[a]++] = {b, agrees};
    links[b][degree[b]++] = {a, agrees};
  });
  Agreement result;
  if (agreed) return result;
  constexpr char unseen = 0, kept = 1, turned = 2;
  std::vector<char> side(mesh.triangles.size(), unseen);
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (side[seed] != unseen) continue;
    std::vector<std::uint32_t> members{seed};
    side[seed] = kept;
    std::size_t to_turn = 0, conflicts = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::uint32_t t = members[i];
      to_turn += side[t] == turned;
      for (std::uint8_t k = 0; k < degree[t]; ++k) {
        const auto [other, agrees] = links[t][k];
        const char opposite = side[t] == kept ? turned : kept, wanted = agrees ? side[t] : opposite;
        if (side[other] == unseen) {
          side[other] = wanted;
          members.push_back(other);
        } else {
          conflicts += side[other] != wanted;
        }
      }
    }
    result.conflicts += conflicts / 2;  // seen from both sides
    const char minority = 2 * to_turn > members.size() ? kept : turned;
    for (const std::uint32_t t : members) {
      if (side[t] != minority) continue;
      turn(mesh.triangles[t]);
      ++result.turned;
    }
  }
  BIN_SCENES_ASSERT(result.turned <= mesh.triangles.size());
  return result;
}

std::size_t turn_outward(Mesh& mesh) {
  struct Shell {
    std::vector<std::uint32_t> triangles;
    Aabb box;
    double volume6 = 0.0;
    bool closed = true;
    bool outermost = true;
    bool inside_out() const { return closed && volume6 < 0.0; }
  };
  const Shells labels = shells(mesh);
  std::vector<Shell> list(labels.count);
  BIN_SCENES_ASSERT(labels.of_triangle.size() == mesh.triangles.size());
  const Vec3 apex = mesh.empty() ? Vec3(Vec3::Zero()) : mesh.bounds().center();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Shell& shell = list[labels.of_triangle[t]];
    shell.triangles.push_back(t);
    const Vec3 &a = mesh.vertices[mesh.triangles[t][0]], &b = mesh.vertices[mesh.triangles[t][1]],
               &c = mesh.vertices[mesh.triangles[t][2]];
    for (const Vec3* v : {&a, &b, &c}) shell.box.extend(*v);
    shell.volume6 += (a - apex).dot((b - apex).cross(c - apex));
  }
  // Shells that meet along an edge are closed each by itself, or their volumes mean nothing.
  for_each_edge(edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    for (const EdgeUse* use = first; use != last; ++use) {
      const std::uint32_t label = labels.of_triangle[use->triangle];
      int passages = 0;
      for (const EdgeUse* other = first; other != last; ++other) {
        if (labels.of_triangle[other->triangle] == label) passages += other->forward ? 1 : -1;
      }
      if (passages != 0) list[label].closed = false;
    }
  });
  if (std::none_of(list.begin(), list.end(), [](const Shell& shell) { return shell.inside_out(); })) return 0;

  const auto contains = [&](const Shell& outer, const Shell& inner) {
    if ((inner.box.lower.array() < outer.box.lower.array()).any()) return false;
    if ((inner.box.upper.array() > outer.box.upper.array()).any()) return false;
    return std::abs(winding(mesh, outer.triangles, mesh.vertices[mesh.triangles[inner.triangles[0]][0]])) > 0.5;
  };
  std::vector<std::vector<std::size_t>> inside(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (std::size_t j = 0; j < list.size(); ++j) {
      if (i == j || !contains(list[i], list[j])) continue;
      inside[i].push_back(j);
      list[j].outermost = false;
    }
  }
  std::vector<char> turned(list.size(), 0);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].outermost || !list[i].inside_out()) continue;
    turned[i] = 1;
    for (const std::size_t j : inside[i]) turned[j] = 1;
  }
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!turned[labels.of_triangle[t]]) continue;
    turn(mesh.triangles[t]);
    ++count;
  }
  return count;
}

}  // namespace bin_scenes::repair
