/// Builds nodes, edges, creases, cones and clusters of a part from its surface samples, and keeps them in the cache on
/// disk.
#include "solver/sphere/shapes/contact_samples.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "part/part_bytes.hpp"
#include "solver/sphere/shapes/missed_features.hpp"
#include "solver/sphere/shapes/point_grid.hpp"
#include "solver/sphere/shapes/sample_clusters.hpp"

#include <algorithm>
#include <map>

namespace bin_scenes::sphere {

namespace {

/// Cones of points on faces: as far around the normal as the normals of neighbours on the same face lean.
std::vector<Cone> face_cones(const std::vector<SurfaceSample>& samples, double sharp_angle) {
  std::vector<Vec3> points;
  double spacing = 0;
  for (const SurfaceSample& sample : samples) {
    points.push_back(sample.point);
    spacing += sample.spacing / static_cast<double>(samples.size());
  }
  const PointGrid grid(points, 2.0 * spacing);
  const double least = std::cos(sharp_angle);
  std::vector<Cone> cones;
  for (const SurfaceSample& sample : samples) {
    double most = 1;
    grid.any_within(sample.point, 2.0 * sample.spacing, [&](std::size_t i) {
      const double lean = samples[i].normal.dot(sample.normal);
      if (lean > least) most = std::min(most, lean);
      return false;
    });
    Cone cone;
    cone.axis = sample.normal.cast<float>();
    cone.spread = static_cast<float>(std::acos(std::min(1.0, most)));
    cones.push_back(cone);
  }
  return cones;
}

}  // namespace

namespace {

/// Not those within another shell, or a wall as thin as `open` (m) before them.
void add_creases(const PartModel& part, const std::vector<Fold>& folds, Samples& samples) {
  constexpr std::size_t most = 4000;  // of a part; a finely tessellated one has more, of which the sharpest are enough
  const Mesh& mesh = part.mesh();
  const double open = 2e-3 * part.diagonal();
  std::vector<const Fold*> creases;
  for (const Fold& fold : folds)
    if (fold.closed && !fold.convex) creases.push_back(&fold);
  if (creases.size() > most) {
    std::stable_sort(creases.begin(), creases.end(),
                     [](const Fold* a, const Fold* b) { return a->cosine < b->cosine; });
    creases.resize(most);
  }
  std::map<std::uint32_t, std::uint32_t> ends;
  const auto end_at = [&](std::uint32_t vertex) {
    const auto [it, fresh] =
        ends.try_emplace(vertex, static_cast<std::uint32_t>(samples.nodes.size() + samples.crease_ends.size()));
    if (fresh) samples.crease_ends.push_back((mesh.vertices[vertex] - part.mass().center).cast<float>());
    return it->second;
  };
  for (const Fold* fold : creases) {
    const Cone cone = edge_cone(mesh, fold->a, fold->b, fold->faces);
    if (cone.bounds == 0) continue;
    const Vec3 out = (cone.bound[0] + cone.bound[1]).cast<double>().normalized();
    const Vec3 center = 0.5 * (mesh.vertices[fold->a] + mesh.vertices[fold->b]);
    if (part.query().inside(center + open * out)) continue;
    Edge edge{end_at(fold->a), end_at(fold->b), 0, 1, cone};
    edge.length = static_cast<float>((mesh.vertices[fold->a] - mesh.vertices[fold->b]).norm());
    samples.edges.push_back(edge);
  }
}

}  // namespace

Samples ball_samples(float radius) {
  Samples samples;
  samples.nodes = {Vec3f::Zero()};
  samples.cones = {Cone{}};
  samples.clusters = {{Vec3f::Zero(), 0}};
  samples.first_edge = {0, 0};
  samples.radius = samples.spacing = radius;
  lay_out(samples);
  return samples;
}

Samples make_samples(const PartModel& part, const std::vector<Fold>& folds, int count, double sharp_angle,
                     double ridge) {
  const Mesh& mesh = part.mesh();
  // A finely tessellated curve has many slightly bent edges: keep the sharpest until the nodes suffice.
  constexpr double most_missed = 5e-4, most_off = 2e-4;  // of d
  constexpr double sharpest = 0.75;                      // rad: a chamfer of 45 degrees has edges in any case
  // Of the nodes. So few edges are those of a polyhedron, not of a curved face, however long they are: with lines in
  // their place, the tip of a spike of eight faces had the cone of one line, and sank in sideways.
  constexpr double few_edges = 0.25;
  const double most_length = edge_share * count * longest_edge_piece * part.diagonal();
  SharpEdges sharp;
  for (;; sharp_angle = std::min(1.3 * sharp_angle, sharpest)) {
    const bool last = sharp_angle >= sharpest;
    const bool few = sharp_count(folds, sharp_angle) <= count * few_edges;
    if (!last && !few && sharp_length(mesh, folds, sharp_angle) > most_length) continue;
    sharp = straightened(mesh, sharp_edges(mesh, folds, sharp_angle), most_off * part.diagonal());
    if (last || sharp.convex.size() <= static_cast<std::size_t>(2 * count)) break;
  }
  const double edge_length = sharp_length(mesh, folds, sharp_angle);
  const double spacing = std::max(edge_length / (edge_share * count), 0.004 * part.diagonal());
  Draft draft = edge_draft(mesh, sharp, spacing);
  // Some of these fall on edges that have their nodes.
  const int faces = 2 * std::max(count / 2, count - static_cast<int>(draft.nodes.size()));
  // Face nodes, but for those that stand on a sharp edge already covered: half a piece away at most, also where it was
  // straightened. Their normals are means of two faces.
  const double half_piece = 0.5 * spacing + most_off * part.diagonal();
  const PointGrid on_edges(draft.nodes, half_piece);
  std::vector<SurfaceSample> on_faces;
  for (const SurfaceSample& sample : part.samples({faces, sharp_angle}).samples)
    if (!on_edges.any_within(sample.point, half_piece, [](std::size_t) { return true; })) on_faces.push_back(sample);
  const std::vector<Cone> cones = face_cones(on_faces, sharp_angle);
  for (std::size_t i = 0; i < on_faces.size(); ++i) draft.add(on_faces[i].point, cones[i]);
  double face_spacing = 0;
  for (const SurfaceSample& sample : on_faces) face_spacing += sample.spacing / static_cast<double>(on_faces.size());
  const double reach = face_spacing > 0 ? face_spacing : spacing;
  add_missed_vertices(mesh, reach, most_missed * part.diagonal(), draft);
  add_missed_ridges(mesh, reach, spacing, ridge * part.diagonal(), draft);
  Samples made = clustered(std::move(draft), part.mass().center, spacing);
  add_creases(part, folds, made);
  made.face_spacing = static_cast<float>(face_spacing);
  BIN_SCENES_ASSERT(made.nodes.size() == made.cones.size() && made.first_edge.size() == made.clusters.size() + 1);
  BIN_SCENES_ASSERT(each_is(made.edges, [&](const Edge& edge) {
    return std::max(edge.a, edge.b) < made.nodes.size() + made.crease_ends.size() && edge.length >= 0;
  }));
  for (const Cone& cone : made.cones)
    if (!cone.axis.isZero()) made.sag = std::max(made.sag, static_cast<float>(bulge(cone, face_spacing)));
  return made;
}

/// The lists that clustered() makes; lay_out() makes the others.
template <class Stream>
void members(Stream& stream, Samples& samples) {
  stream.raw_list(samples.nodes);
  stream.raw_list(samples.cones);
  stream.raw_list(samples.edges);
  stream.raw_list(samples.crease_ends);
  stream.raw_list(samples.clusters);
  stream.raw_list(samples.first_edge);
  stream(samples.spacing, samples.face_spacing, samples.sag, samples.radius);
  if (std::is_same_v<Stream, ByteReader> && stream.ok()) lay_out(samples);
}
template void members(ByteReader& stream, Samples& samples);
template void members(ByteWriter& stream, Samples& samples);

}  // namespace bin_scenes::sphere
