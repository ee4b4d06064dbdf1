#include "raster/projection.hpp"

#include <algorithm>
#include <limits>

namespace bin_scenes {

bool Projection::place(Body& body, const Pose& mesh_in_camera, bool whole) const {
  const Mesh& mesh = *body.placed.mesh;
  body.turn = mesh_in_camera.orientation.toRotationMatrix();
  body.place = mesh_in_camera.position;
  body.corners.reserve(mesh.vertices.size());
  double closest = std::numeric_limits<double>::infinity(), remotest = -closest;
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 p = body.turn * vertex + body.place;
    closest = std::min(closest, p.z());
    remotest = std::max(remotest, p.z());
    const double near = 1.0 / p.z();
    body.corners.push_back({lens_.fx * p.x() * near + lens_.cx, lens_.fy * p.y() * near + lens_.cy, near});
  }
  const bool out = closest * farthest_ > 1.0 || remotest * nearest_ < 1.0;
  if (out) body.corners.clear();
  const bool in_range = closest * nearest_ > 1.0 && remotest * farthest_ < 1.0;
  body.one_sided = in_range && body.placed.closed;
  const bool fits = out || in_range || (!whole && closest > 1e-6);
  if (fits) sort_into_bands(body);
  return fits;
}

/// Leaves out triangles that face away, where those are hidden, and those between the places that are asked for.
void Projection::sort_into_bands(Body& body) const {
  if (body.corners.empty()) return;
  double top = 1e300, bottom = -top;
  for (const ImageCorner& corner : body.corners) top = std::min(top, corner.v), bottom = std::max(bottom, corner.v);
  const double end = lens_.height - 1.0, right_end = lens_.width - 1.0;
  if (bottom < -reach_ || top > end + reach_) return;
  body.first_band = down(std::max(top - reach_, 0.0)) / band_rows;
  const int last_band = down(std::min(bottom + reach_ + 1.0, end)) / band_rows;
  body.bands.resize(static_cast<std::size_t>(last_band - body.first_band + 1));
  const std::vector<Triangle>& triangles = body.placed.mesh->triangles;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const ImageCorner &a = body.corners[triangles[t][0]], &b = body.corners[triangles[t][1]],
                      &c = body.corners[triangles[t][2]];
    const double area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);  // seen from outside: negative
    if (body.one_sided ? !(area < 0.0) : !(area != 0.0)) continue;
    const double high = std::min(a.v, std::min(b.v, c.v)), low = std::max(a.v, std::max(b.v, c.v));
    const double left = std::min(a.u, std::min(b.u, c.u)), right = std::max(a.u, std::max(b.u, c.u));
    if (low < -reach_ || high > end + reach_ || right < -reach_ || left > right_end + reach_) continue;
    const int from = up(std::max(left - reach_, 0.0)), to = down(std::min(right + reach_, right_end));
    const int first = up(std::max(high - reach_, 0.0)), last = down(std::min(low + reach_, end));
    if (from > to || first > last) continue;
    const Covering covering{t, static_cast<std::int16_t>(first), static_cast<std::int16_t>(last),
                            static_cast<std::int16_t>(from), static_cast<std::int16_t>(to)};
    for (int band = first / band_rows; band <= last / band_rows; ++band)
      body.bands[static_cast<std::size_t>(band - body.first_band)].push_back(covering);
  }
}

}  // namespace bin_scenes
