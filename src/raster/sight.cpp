/// Meshes are drawn into cells so that no cell misses what it holds; a mesh counts where a triangle may lie.
#include "raster/sight.hpp"

#include "raster/spans.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr double cell_size = 2.0;     // pixels of the light
constexpr double off_surface = 1e-5;  // m: rays begin so far above a surface (models/illumination.hpp)
constexpr std::uint32_t nobody = ~0u, bent = ~0u;

}  // namespace

/// A mesh in the light's field.
struct ClearSight::Seen {
  Scenery::Body body;
  Mat3 turn;                         // mesh to light
  Vec3 place;                        // m
  std::vector<ImageCorner> corners;  // in cells
  double margin;                     // cells
};

ClearSight::ClearSight(const Scenery& scenery, const Lens& light, const Pose& pose)
    : scenery_(scenery),
      lens_(light),
      turn_(pose.orientation.toRotationMatrix().transpose()),
      origin_(pose.position),
      columns_(static_cast<int>(light.width / cell_size) + 1),
      rows_(static_cast<int>(light.height / cell_size) + 1) {
  if (light.distorts() || light.skew != 0.0 || !(origin_.z() > scenery.floor_height().value_or(-1e300))) return;
  cells_.assign(static_cast<std::size_t>(columns_) * rows_, {nobody, bent, 0.0f, 0.0f});
  for (std::uint32_t i = 0; i < scenery.body_count(); ++i) {
    Seen seen;
    if (!project(scenery.body(i), seen)) {
      cells_.clear();
      return;
    }
    for (std::uint32_t t = 0; t < seen.body.mesh->triangles.size(); ++t) mark(seen, t, i);
  }
}

/// False: the mesh reaches behind the light.
bool ClearSight::project(const Scenery::Body& body, Seen& seen) const {
  seen.body = body;
  seen.turn = turn_ * body.pose.orientation.toRotationMatrix();
  seen.place = turn_ * (body.pose.position - origin_);
  seen.corners.reserve(body.mesh->vertices.size());
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : body.mesh->vertices) {
    const Vec3 p = seen.turn * vertex + seen.place;
    nearest = std::min(nearest, p.z());
    const double near = 1.0 / p.z();
    seen.corners.push_back({(lens_.fx * p.x() * near + lens_.cx + 0.5) / cell_size,
                            (lens_.fy * p.y() * near + lens_.cy + 0.5) / cell_size, near});
  }
  seen.margin = 0.01 + 4.0 * off_surface * std::max(lens_.fx, lens_.fy) / nearest / cell_size;
  return nearest > 0.01;
}

/// Within less than rays begin above a surface.
bool ClearSight::one_plane(const Scenery::Plane& a, const Scenery::Plane& b) {
  return a.normal.dot(b.normal) > 1.0 - 1e-12 && std::abs(a.offset - b.offset) < 1e-6;
}

void ClearSight::mark_cell(Cell& cell, const Seen& seen, std::uint32_t triangle, std::uint32_t body, double near) {
  const auto value = static_cast<float>(near * (1.0 + 1e-6));
  if (cell.body == body) {
    cell.first = std::max(cell.first, value);
    const std::vector<Scenery::Plane>& planes = *seen.body.planes;
    if (cell.plane != bent && !one_plane(planes[cell.plane], planes[triangle])) cell.plane = bent;
  } else if (value > cell.first) {
    cell = {body, triangle, value, cell.first};
  } else {
    cell.second = std::max(cell.second, value);
  }
}

void ClearSight::mark(const Seen& seen, std::uint32_t t, std::uint32_t body) {
  const Triangle& triangle = seen.body.mesh->triangles[t];
  const ImageCorner &a = seen.corners[triangle[0]], &b = seen.corners[triangle[1]], &c = seen.corners[triangle[2]];
  // Where light meets a closed mesh first, it meets a front.
  if (seen.body.closed && (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u) > 1e-9) return;
  const double top = std::min(a.v, std::min(b.v, c.v)) - seen.margin,
               bottom = std::max(a.v, std::max(b.v, c.v)) + seen.margin;
  const double left = std::min(a.u, std::min(b.u, c.u)) - seen.margin,
               right = std::max(a.u, std::max(b.u, c.u)) + seen.margin;
  if (bottom < 0.0 || right < 0.0 || top >= rows_ || left >= columns_) return;
  const int first = down(std::max(left, 0.0)), last = std::min(down(std::min(right, 1e6)), columns_ - 1);
  const int upper = down(std::max(top, 0.0)), lower = std::min(down(std::min(bottom, 1e6)), rows_ - 1);
  if (last - first <= 1 && lower - upper <= 1) {
    const double highest = std::max(a.near, std::max(b.near, c.near));
    for (int row = upper; row <= lower; ++row) {
      for (int column = first; column <= last; ++column)
        mark_cell(cells_[static_cast<std::size_t>(row) * columns_ + column], seen, t, body, highest);
    }
    return;
  }
  mark_rows(seen, t, body);
}

/// The cells of each row that a large triangle may touch.
void ClearSight::mark_rows(const Seen& seen, std::uint32_t t, std::uint32_t body) {
  const Triangle& triangle = seen.body.mesh->triangles[t];
  const ImageCorner* const corner[3] = {&seen.corners[triangle[0]], &seen.corners[triangle[1]],
                                        &seen.corners[triangle[2]]};
  const auto [high, low] = std::minmax({corner[0]->v, corner[1]->v, corner[2]->v});
  const double highest = std::max(corner[0]->near, std::max(corner[1]->near, corner[2]->near));
  const int upper = down(std::max(high - seen.margin, 0.0)),
            lower = std::min(down(std::min(low + seen.margin, 1e6)), rows_ - 1);
  // 1 / depth in the plane, linear in column and row
  const Scenery::Plane& plane = (*seen.body.planes)[t];
  const Vec3 normal = seen.turn * plane.normal, slope = normal / (plane.offset + normal.dot(seen.place));
  const double across = slope.x() * cell_size / lens_.fx, along = slope.y() * cell_size / lens_.fy;
  const double corner_cell =
      slope.z() - slope.x() * (lens_.cx + 0.5) / lens_.fx - slope.y() * (lens_.cy + 0.5) / lens_.fy;
  const double growth = (0.5 + seen.margin) * (std::abs(across) + std::abs(along));
  for (int row = upper; row <= lower; ++row) {
    const double top = row - seen.margin, bottom = row + 1 + seen.margin;
    double left = 1e300, right = -left;
    for (int k = 0; k < 3; ++k) {
      const ImageCorner &a = *corner[k], &b = *corner[k == 2 ? 0 : k + 1];
      if (std::max(a.v, b.v) < top || std::min(a.v, b.v) > bottom) continue;
      for (const double v : {std::clamp(a.v, top, bottom), std::clamp(b.v, top, bottom)}) {
        const double share = a.v == b.v ? 0.0 : (v - a.v) / (b.v - a.v), u = a.u + share * (b.u - a.u);
        left = std::min(left, a.v == b.v ? std::min(a.u, b.u) : u);
        right = std::max(right, a.v == b.v ? std::max(a.u, b.u) : u);
      }
    }
    if (!(right + seen.margin >= 0.0 && left - seen.margin < columns_)) continue;
    const int first = down(std::max(left - seen.margin, 0.0)),
              last = std::min(down(std::min(right + seen.margin, 1e6)), columns_ - 1);
    for (int column = first; column <= last; ++column) {
      const double near = corner_cell + across * (column + 0.5) + along * (row + 0.5) + growth;
      mark_cell(cells_[static_cast<std::size_t>(row) * columns_ + column], seen, t, body,
                near < highest ? near : highest);
    }
  }
}

bool ClearSight::clear(const Vec3& point, const Vec3& there, const Eigen::Vector2d& pixel,
                       const Scenery::Face& face) const {
  if (cells_.empty() || !(there.z() > 0.0)) return false;
  const double u = (pixel.x() + 0.5) * (1.0 / cell_size), v = (pixel.y() + 0.5) * (1.0 / cell_size);
  if (!(u >= 0.0 && v >= 0.0 && u < columns_ && v < rows_)) return false;
  const Cell& cell = cells_[static_cast<std::size_t>(v) * columns_ + static_cast<std::size_t>(u)];
  const double depth = there.z() + 2.0 * off_surface;  // what comes nearer than this may occlude the point
  if (face.on_floor) return cell.first * depth < 1.0;
  if (cell.body != face.body || face.normal.dot(origin_ - point) <= 0.0) return false;
  if (point.z() < scenery_.floor_height().value_or(-1e300) + off_surface) return false;
  return (face.outermost || cell.plane != bent) && cell.second * depth < 1.0;
}

}  // namespace bin_scenes
