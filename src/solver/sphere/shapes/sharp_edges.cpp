/// Collects sharp edges, joins those that continue each other straight, and works out the cone of each.
#include "solver/sphere/shapes/sharp_edges.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace bin_scenes::sphere {

Cone edge_cone(const Mesh& mesh, std::uint32_t a, std::uint32_t b, const std::array<std::size_t, 2>& faces) {
  Cone cone;
  const Vec3 along = (mesh.vertices[b] - mesh.vertices[a]).normalized();
  for (const std::size_t face : faces) {
    const Triangle& t = mesh.triangles[face];
    const Vec3 center = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
    Vec3 into = center - mesh.vertices[a];
    into -= into.dot(along) * along;
    if (into.norm() < 1e-9 * (mesh.vertices[b] - mesh.vertices[a]).norm()) return Cone{};  // a sliver says nothing
    cone.bound[cone.bounds++] = into.normalized().cast<float>();
  }
  cone.bound[cone.bounds++] = along.cast<float>();
  cone.bound[cone.bounds++] = -along.cast<float>();
  return cone;
}

namespace {

/// Joins runs of sharp edges, from one vertex where they cannot be joined to the next.
class Straightener {
 public:
  Straightener(const Mesh& mesh, const SharpEdges& sharp, double most_off)
      : mesh_(mesh), sharp_(sharp), most_off_(most_off), used_(sharp.convex.size()), around_(mesh.vertices.size()) {
    for (std::uint32_t i = 0; i < sharp.convex.size(); ++i)
      for (const std::uint32_t v : {sharp.convex[i].a, sharp.convex[i].b}) {
        Around& around = around_[v];
        if (around.count < 2) around.edge[around.count] = i;
        ++around.count;
      }
  }

  std::vector<SharpEdge> edges() {
    std::vector<SharpEdge> straight;
    const auto follow_unused = [&](bool from_ends) {
      for (std::uint32_t i = 0; i < used_.size(); ++i)
        for (const std::uint32_t v : {sharp_.convex[i].a, sharp_.convex[i].b})
          if (!used_[i] && from_ends != passable(v)) follow(i, v, straight);
    };
    follow_unused(true);
    follow_unused(false);  // loops
    std::sort(straight.begin(), straight.end(),
              [](const SharpEdge& x, const SharpEdge& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    return straight;
  }

 private:
  struct Around {
    int count = 0;
    std::array<std::uint32_t, 2> edge{};
  };

  /// Edges in a row, and what one in their place would look like.
  struct Run {
    std::vector<std::uint32_t> edges, vertices;
    Vec3 direction;                   ///< of its first edge
    std::array<Vec3, 2> first, sums;  ///< into both faces: at the first edge, over all of them
  };

  bool passable(std::uint32_t v) const {
    const Around& around = around_[v];
    return around.count == 2 && !sharp_.saddles[v] && sharp_.convex[around.edge[0]].cone.bounds > 0 &&
           sharp_.convex[around.edge[1]].cone.bounds > 0;
  }

  std::uint32_t other_end(std::uint32_t edge, std::uint32_t v) const {
    return sharp_.convex[edge].a == v ? sharp_.convex[edge].b : sharp_.convex[edge].a;
  }

  /// Into both faces of an edge, in the order of the faces of the run.
  std::array<Vec3, 2> into(std::uint32_t edge, const std::array<Vec3, 2>& like) const {
    const Cone& cone = sharp_.convex[edge].cone;
    std::array<Vec3, 2> both = {cone.bound[0].cast<double>(), cone.bound[1].cast<double>()};
    if (both[0].dot(like[0]) + both[1].dot(like[1]) < both[0].dot(like[1]) + both[1].dot(like[0]))
      std::swap(both[0], both[1]);
    return both;
  }

  Run begin(std::uint32_t edge, std::uint32_t v) const {
    const std::uint32_t end = other_end(edge, v);
    const Cone& cone = sharp_.convex[edge].cone;
    Run run{{edge}, {v, end}, (mesh_.vertices[end] - mesh_.vertices[v]).normalized(), {}, {}};
    run.first = run.sums = {cone.bound[0].cast<double>(), cone.bound[1].cast<double>()};
    BIN_SCENES_ASSERT(run.edges.size() + 1 == run.vertices.size());
    return run;
  }

  bool fits(const Run& run, std::uint32_t edge) const {
    constexpr std::size_t longest = 64;    // the check below looks at every vertex of the run
    constexpr double least_cosine = 0.98;  // 0.2 rad, of the run and of either face
    if (run.edges.size() == longest) return false;
    const std::uint32_t from = run.vertices.back(), to = other_end(edge, from);
    const Vec3 &a = mesh_.vertices[run.vertices.front()], &b = mesh_.vertices[to];
    if ((b - mesh_.vertices[from]).normalized().dot(run.direction) < least_cosine) return false;
    const std::array<Vec3, 2> sides = into(edge, run.first);
    if (sides[0].dot(run.first[0]) < least_cosine || sides[1].dot(run.first[1]) < least_cosine) return false;
    const Vec3 along = (b - a).normalized();
    return std::all_of(run.vertices.begin() + 1, run.vertices.end(), [&](std::uint32_t v) {
      const Vec3 from_a = mesh_.vertices[v] - a;
      return (from_a - from_a.dot(along) * along).norm() <= most_off_;
    });
  }

  SharpEdge joined(const Run& run) const {
    if (run.edges.size() == 1) return sharp_.convex[run.edges.front()];
    const auto [a, b] = std::minmax(run.vertices.front(), run.vertices.back());
    const Vec3 along = (mesh_.vertices[b] - mesh_.vertices[a]).normalized();
    SharpEdge edge{a, b, Cone{}};
    for (const Vec3& sum : run.sums)
      edge.cone.bound[edge.cone.bounds++] = (sum - sum.dot(along) * along).normalized().cast<float>();
    edge.cone.bound[edge.cone.bounds++] = along.cast<float>();
    edge.cone.bound[edge.cone.bounds++] = -along.cast<float>();
    return edge;
  }

  void follow(std::uint32_t edge, std::uint32_t v, std::vector<SharpEdge>& straight) {
    Run run = begin(edge, v);
    used_[edge] = true;
    for (;;) {
      const std::uint32_t end = run.vertices.back();
      const std::uint32_t next = around_[end].edge[around_[end].edge[0] == run.edges.back() ? 1 : 0];
      if (!passable(end) || used_[next]) break;
      used_[next] = true;
      if (fits(run, next)) {
        const std::array<Vec3, 2> sides = into(next, run.first);
        for (int side = 0; side < 2; ++side) run.sums[side] += sides[side];
        run.edges.push_back(next);
        run.vertices.push_back(other_end(next, end));
      } else {
        straight.push_back(joined(run));
        run = begin(next, end);
      }
    }
    straight.push_back(joined(run));
  }

  const Mesh& mesh_;
  const SharpEdges& sharp_;
  double most_off_;
  std::vector<bool> used_;
  std::vector<Around> around_;
};

}  // namespace

std::vector<Fold> folds_of(const Mesh& mesh, double angle) {
  struct Side {
    std::uint32_t b;
    std::size_t face;
  };
  const auto each_side = [&](auto&& visit) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int e = 0; e < 3; ++e) {
        const auto [a, b] = std::minmax(mesh.triangles[t][e], mesh.triangles[t][(e + 1) % 3]);
        visit(a, Side{b, t});
      }
  };
  // Sides by their lower vertex, one vertex after the other: sorting them all takes several times as long.
  std::vector<std::size_t> last(mesh.vertices.size() + 1, 0);
  each_side([&](std::uint32_t a, const Side&) { ++last[a + 1]; });
  std::partial_sum(last.begin(), last.end(), last.begin());
  std::vector<Side> sides(last.back());
  each_side([&](std::uint32_t a, const Side& side) { sides[last[a]++] = side; });
  std::vector<Vec3> normals(mesh.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t) normals[t] = mesh.area_vector(t).normalized();

  BIN_SCENES_ASSERT(indices_in_range(mesh) && sides.size() == 3 * mesh.triangles.size());
  std::vector<Fold> folds;
  const double flat = std::cos(angle);
  std::size_t first = 0;
  for (std::uint32_t a = 0; a < mesh.vertices.size(); ++a) {
    std::stable_sort(sides.begin() + first, sides.begin() + last[a],
                     [](const Side& x, const Side& y) { return x.b < y.b; });
    for (std::size_t next; first < last[a]; first = next) {
      next = first + 1;
      while (next < last[a] && sides[next].b == sides[first].b) ++next;
      const std::uint32_t b = sides[first].b;
      Fold fold{a, b};
      if (next - first == 2) {
        const std::size_t f0 = sides[first].face, f1 = sides[first + 1].face;
        fold.closed = true;
        fold.faces = {f0, f1};
        fold.cosine = normals[f0].dot(normals[f1]);
        if (fold.cosine > flat) continue;
        // Convex: the far corner of one face lies behind the other face.
        std::uint32_t far = mesh.triangles[f1][0];
        for (const std::uint32_t v : mesh.triangles[f1])
          if (v != a && v != b) far = v;
        fold.convex = normals[f0].dot(mesh.vertices[far] - mesh.vertices[a]) < 0;
      }
      folds.push_back(fold);
    }
  }
  return folds;
}

SharpEdges sharp_edges(const Mesh& mesh, const std::vector<Fold>& folds, double angle) {
  SharpEdges sharp;
  sharp.saddles.resize(mesh.vertices.size());
  sharp.convex.reserve(folds.size());
  const double least = std::cos(angle);
  for (const Fold& fold : folds) {
    if (fold.cosine > least) continue;
    if (!fold.closed) {
      sharp.convex.push_back({fold.a, fold.b, Cone{}});
    } else if (fold.convex) {
      sharp.convex.push_back({fold.a, fold.b, edge_cone(mesh, fold.a, fold.b, fold.faces)});
    } else {
      sharp.saddles[fold.a] = sharp.saddles[fold.b] = true;
    }
  }
  return sharp;
}

double sharp_count(const std::vector<Fold>& folds, double angle) {
  const double least = std::cos(angle);
  return static_cast<double>(
      std::count_if(folds.begin(), folds.end(), [&](const Fold& fold) { return fold.cosine <= least && fold.convex; }));
}

double sharp_length(const Mesh& mesh, const std::vector<Fold>& folds, double angle) {
  double sum = 0;
  const double least = std::cos(angle);
  for (const Fold& fold : folds)
    if (fold.cosine <= least && fold.convex) sum += (mesh.vertices[fold.a] - mesh.vertices[fold.b]).norm();
  return sum;
}

SharpEdges straightened(const Mesh& mesh, SharpEdges sharp, double most_off) {
  BIN_SCENES_ASSERT(most_off >= 0.0 && sharp.saddles.size() == mesh.vertices.size());
  sharp.convex = Straightener(mesh, sharp, most_off).edges();
  return sharp;
}

}  // namespace bin_scenes::sphere
