/// Makes the collision shape of a part: how many samples it needs, its field, and what of both is kept in the cache.
#include "solver/sphere/shapes/shape.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "bin_scenes/part/wall_thickness.hpp"
#include "part/part_cache.hpp"
#include "solver/sphere/shapes/sharp_edges.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <iomanip>
#include <sstream>

namespace bin_scenes::sphere {

namespace {

/// Radius of the ball a tessellated ball stands for: all its vertices lie on it and no face cuts deep below; else 0.
float ball_radius(const PartModel& part) {
  const Mesh& mesh = part.mesh();
  const Vec3& center = part.mass().center;
  const double radius = part.radius();
  for (const Vec3& v : mesh.vertices)
    if ((v - center).norm() < 0.999 * radius) return 0;
  for (const Triangle& t : mesh.triangles)
    if (((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3 - center).norm() < 0.97 * radius)
      return 0;
  return static_cast<float>(radius);
}

constexpr double coarse_per_patch = 0.35;  ///< samples per square as wide as the part is thick, while pouring
constexpr int most_samples = 6000;         ///< of a sheet as thin as paper: more would cost more than they find

int at_least(int count, double wanted) {
  return std::max(count, static_cast<int>(std::min<double>(wanted, most_samples)));
}

/// Nodes of a part that is mostly curved, so that neighbours lean by 0.3 rad and stand a third of the radius apart.
/// Wider apart, crossing pins tremble. Fillets, tighter than the part is thick, do not count.
double nodes_on_curves(const PartModel& part, double thickness, double sharp_angle) {
  constexpr double lean = 0.3, flat = 0.01;  // rad
  const Mesh& mesh = part.mesh();
  double curved = 0.0, leaning = 0.0;  // m2; area / radius^2
  for (const Fold& fold : folds_of(mesh, flat)) {
    const double angle = std::acos(std::clamp(fold.cosine, -1.0, 1.0));
    if (!fold.closed || !fold.convex || angle > sharp_angle) continue;
    double area = 0.0;
    for (const std::size_t face : fold.faces) area += 0.5 * mesh.area_vector(face).norm();
    const double radius = area / (mesh.vertices[fold.a] - mesh.vertices[fold.b]).norm() / angle;
    if (radius < 0.7 * thickness) continue;
    curved += area;
    leaning += area / (radius * radius);
  }
  const double whole = part.mass().area;
  return curved < 0.5 * whole ? 0.0 : whole / curved * leaning / (lean * lean);
}

struct Prepared {
  Samples coarse, fine;
  double wall = 0;  ///< m: wall_thickness()
};

template <class Stream>
void members(Stream& stream, Prepared& prepared) {
  stream(prepared.coarse, prepared.fine, prepared.wall);
}

Prepared prepare(const PartModel& part, int coarse, int fine) {
  // Between samples farther apart than a thin part is thick, a part slips in unseen and is then caught inside.
  const MassProperties& mass = part.mass();
  const double thickness = 2.0 * mass.volume / mass.area;
  const double patches = mass.area / (thickness * thickness);
  constexpr double coarse_angle = 0.5, fine_angle = 0.15;
  constexpr double coarse_ridge = 4e-3, fine_ridge = 1.5e-3;  // of d; less = a cylinder's facets are all ridges
  const std::vector<Fold> folds = folds_of(part.mesh(), fine_angle);
  // Edges as sharp as this are no curved face, however many there are: those of a thread, of teeth.
  const double edge_nodes =
      sharp_length(part.mesh(), folds, coarse_angle) / (longest_edge_piece * part.diagonal()) / edge_share;
  const int coarse_count = at_least(coarse, coarse_per_patch * patches);
  const int fine_count = at_least(fine, std::max({patches, edge_nodes, nodes_on_curves(part, thickness, fine_angle)}));
  Prepared prepared;
  prepared.wall = wall_thickness(part.query());
  if (fine == 0) {
    prepared.coarse = prepared.fine = make_samples(part, folds, coarse_count, coarse_angle, coarse_ridge);
    return prepared;
  }
  std::future<Samples> fine_samples =
      std::async(std::launch::async, [&] { return make_samples(part, folds, fine_count, fine_angle, fine_ridge); });
  prepared.coarse = make_samples(part, folds, coarse_count, coarse_angle, coarse_ridge);
  prepared.fine = fine_samples.get();
  return prepared;
}

constexpr double cells_through = 1.5;  ///< of the field, through the thinnest part: two nodes see its inside

constexpr double thin = 50.0;  ///< thicknesses; a part longer than that meets others as one of that size would

/// m. The margin of contacts of a needle 1:200, as a share of its diagonal, is nearly its thickness: contacts kept,
/// pushed apart and reused over such lengths make it tremble. An open bin has no thickness.
double size_at_contacts(const PartModel& part) {
  const MassProperties& mass = part.mass();
  const double thickness = 2.0 * mass.volume / mass.area;
  return part.load_report().closed ? std::min(part.diagonal(), thin * thickness) : part.diagonal();
}

/// / diagonal. Contacts are found halfway through a step: with 0.08, a part that falls 2 m onto an edge meets the
/// plate elsewhere than in shorter steps, and is thrown aside by 13 % of its speed.
constexpr double widest_wall = 0.04;
constexpr double of_a_rod = 1.5;  ///< wall / (2 volume / area), at least: 2 of a rod, 1 of a sheet

double wall_of(const PartModel& part, double measured, double thickness) {
  return measured < of_a_rod * thickness ? thickness
                                         : std::max(thickness, std::min(measured, widest_wall * part.diagonal()));
}

Flag coarsened_flag(const PartModel& part, const FieldOptions& asked, const DistanceField& field) {
  const auto text = [](double value) {
    std::ostringstream out;
    out << std::setprecision(3) << value;
    return out.str();
  };
  const double got = field.cell / part.diagonal();
  return {"field_coarsened",
          "the distance field of " + part.path() + " has cells of " + text(got) + " of its diagonal instead of " +
              text(asked.cell) + ", which would take more than " + std::to_string(asked.max_nodes) + " nodes",
          "set solver.sphere.field_cell to " + text(1.005 * got) +
              " or more, raise memory_budget for hundreds of models, or live with the coarser field"};
}

}  // namespace

Shape make_shape(const PartModel& part, int coarse, int fine, double field_cell, std::size_t field_nodes) {
  Shape shape;
  const MassProperties& mass = part.mass();
  shape.center = mass.center.cast<float>();
  shape.radius = static_cast<float>(part.radius());
  shape.thickness = shape.wall = static_cast<float>(2.0 * mass.volume / mass.area);
  shape.diagonal = static_cast<float>(part.diagonal());
  shape.size = static_cast<float>(size_at_contacts(part));
  shape.unit_inertia = (mass.inertia / mass.volume).cast<float>();
  const Aabb box = part.mesh().bounds();
  shape.box_center = (box.center() - mass.center).cast<float>();
  shape.box_half = (0.5 * box.size()).cast<float>();

  BIN_SCENES_ASSERT(shape.radius > 0 && shape.diagonal > 0 && shape.size > 0);
  BIN_SCENES_ASSERT(shape.unit_inertia.allFinite() && (shape.box_half.array() >= 0).all());
  shape.field.ball = ball_radius(part);
  if (shape.field.ball > 0) {
    shape.coarse = shape.fine = ball_samples(shape.field.ball);
    return shape;
  }
  // A sheet thinner than a cell has no inside: others would pass through it.
  FieldOptions options;
  options.cell = field_cell;
  options.max_nodes = field_nodes;
  if (shape.thickness > 0) options.cell = std::min(field_cell, shape.thickness / part.diagonal() / cells_through);
  std::future<const DistanceField&> made_field =
      std::async(std::launch::async, [&]() -> const DistanceField& { return part.field(options); });
  const std::string key = part.mesh_key() + " " + std::to_string(samples_format) + " " + std::to_string(coarse) + " " +
                          std::to_string(fine);
  Prepared prepared = cached<Prepared>("nodes", key, [&] { return prepare(part, coarse, fine); });
  shape.coarse = std::move(prepared.coarse);
  shape.fine = std::move(prepared.fine);
  shape.wall = static_cast<float>(wall_of(part, prepared.wall, 2.0 * mass.volume / mass.area));

  const DistanceField& field = made_field.get();
  shape.field.origin = (field.origin - mass.center).cast<float>();
  shape.field.cell = static_cast<float>(field.cell);
  BIN_SCENES_ASSERT(field.cell > 0.0 && field.values.size() == static_cast<std::size_t>(field.nodes[0]) *
                                                                   static_cast<std::size_t>(field.nodes[1]) *
                                                                   static_cast<std::size_t>(field.nodes[2]));
  BIN_SCENES_ASSERT(!shape.coarse.nodes.empty() && !shape.fine.nodes.empty());
  shape.field.inverse_cell = 1.0f / shape.field.cell;
  shape.field.nx = field.nodes[0];
  shape.field.ny = field.nodes[1];
  shape.field.nz = field.nodes[2];
  shape.field.values = field.values.data();
  if (field.coarsened) shape.flags.push_back(coarsened_flag(part, options, field));
  const Vec3 pad = (box.lower - field.origin).cwiseMax(0.0);
  shape.field.padding = static_cast<float>(pad.minCoeff());
  for (Samples* s : {&shape.coarse, &shape.fine}) s->edge_grid = make_edge_grid(*s, shape.field);
  return shape;
}

}  // namespace bin_scenes::sphere
