/// Bands of rows are drawn one by one; in a band the spots lie in the order of their pixels, and a triangle finds those
/// that it may cover by the numbers at which each pixel's begin.
#include "raster/spots.hpp"

#include "core/in_parallel.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// Half a plane of the image: where value(spot) is not negative. Its border belongs to both sides.
struct Half {
  double across, along, start;  // start: at the origin, which lies near
  double shift;                 // columns by which the border moves from one row to the next

  /// @param origin_u, origin_v  pixel
  Half(const ImageCorner& a, const ImageCorner& b, double sign, double origin_u, double origin_v)
      : across(sign * (a.v - b.v)),
        along(sign * (b.u - a.u)),
        start(across * (origin_u - a.u) + along * (origin_v - a.v) + on_edge * (std::abs(across) + std::abs(along))),
        shift(-along / across) {}
  double value(double u, double v) const { return start + across * u + along * v; }
  /// Narrows the columns, from the origin, where a row may lie in it.
  void narrow(double row, double& left, double& right) const {
    const double border = shift * row - start / across, beside = SpotDrawing::reach * (1.0 + std::abs(shift));
    if (across > 0.0) left = std::max(left, border - beside);
    if (across < 0.0) right = std::min(right, border + beside);
  }
};

}  // namespace

struct SpotDrawing::Band {
  int index = 0;
  std::vector<Spot*> given;           ///< as they came
  std::vector<Spot> spots;            ///< by pixel
  std::vector<std::uint32_t> begins;  ///< of each pixel's spots, row-major; one more at the end
  std::vector<std::uint32_t> places;  ///< in `spots` of those given

  void sort(const Lens& lens);
};

void SpotDrawing::Band::sort(const Lens& lens) {
  const int top = index * Projection::band_rows, rows = std::min(Projection::band_rows, lens.height - top);
  begins.assign(static_cast<std::size_t>(rows) * lens.width + 1, 0);
  places.resize(given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    const int row = std::clamp(down(given[i]->v + 0.5) - top, 0, rows - 1);
    const int column = std::clamp(down(given[i]->u + 0.5), 0, lens.width - 1);
    places[i] = static_cast<std::uint32_t>(row * lens.width + column);
    ++begins[places[i]];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& begin : begins) begin = sum += begin;  // ends, for now: filling counts them down
  spots.resize(given.size());
  for (std::size_t i = given.size(); i-- > 0;) spots[places[i] = --begins[places[i]]] = *given[i];
}

SpotDrawing::SpotDrawing(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far)
    : scenery_(scenery),
      lens_(lens),
      floor_(pose.orientation.toRotationMatrix().row(2).transpose() /
             (scenery.floor_height().value_or(0.0) - pose.position.z())),
      nearest_(1.0 / near),
      usable_(!lens.distorts() && lens.skew == 0.0),
      bodies_(usable_ ? scenery.body_count() : 0) {
  const Pose bin_in_camera = pose.inverse();
  const Projection projection(lens, near, far, reach);
  std::vector<char> fits(bodies_.size(), 0);
  in_parallel(bodies_.size(), [&](std::size_t i) {
    bodies_[i].placed = scenery.body(i);
    fits[i] = projection.place(bodies_[i], bin_in_camera * bodies_[i].placed.pose, false);
  });
  usable_ = usable_ && std::find(fits.begin(), fits.end(), 0) == fits.end();
  triangles_in_.assign(static_cast<std::size_t>((lens.height - 1) / Projection::band_rows + 1), 0);
  for (const Projection::Body& body : bodies_)
    for (std::size_t k = 0; k < body.bands.size(); ++k)
      triangles_in_[static_cast<std::size_t>(body.first_band) + k] += body.bands[k].size();
}

bool SpotDrawing::draw(Spot* spots, std::size_t count) const {
  constexpr std::size_t as_quick = 8;  // triangles passed by in the time of a ray
  if (!usable_ || count == 0) return false;
  thread_local std::vector<Band> bands;  // keeps its memory
  if (bands.size() < triangles_in_.size()) bands.resize(triangles_in_.size());
  std::size_t passed = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const int row = std::clamp(down(spots[i].v + 0.5), 0, lens_.height - 1);
    const auto index = static_cast<std::size_t>(row / Projection::band_rows);
    if (bands[index].given.empty()) passed += triangles_in_[index];
    bands[index].given.push_back(&spots[i]);
  }
  const bool pays = passed < as_quick * count;
  for (std::size_t k = 0; k < triangles_in_.size(); ++k) {
    Band& band = bands[k];
    if (pays && !band.given.empty()) {
      band.index = static_cast<int>(k);
      draw_band(band);
    }
    band.given.clear();
  }
  return pays;
}

void SpotDrawing::draw_band(Band& band) const {
  band.sort(lens_);
  for (const Projection::Body& body : bodies_) {
    const std::size_t own = static_cast<std::size_t>(band.index) - static_cast<std::size_t>(body.first_band);
    if (own >= body.bands.size()) continue;
    for (const Projection::Covering& covering : body.bands[own]) draw_triangle(band, body, covering);
  }
  if (scenery_.floor_height()) draw_floor(band);
  for (std::size_t i = 0; i < band.given.size(); ++i) *band.given[i] = band.spots[band.places[i]];
}

/// A triangle in the image. Places count from one of its pixels, so that far corners round little.
struct SpotDrawing::Shape {
  double u, v;  ///< pixel, the origin
  Half ab, bc, ca;
  Vec3 near;               ///< 1 / depth = near . (1, u, v)
  double lowest, highest;  ///< of its corners

  Shape(const Lens& lens, const Projection::Body& body, const Projection::Covering& covering, const ImageCorner& a,
        const ImageCorner& b, const ImageCorner& c);
  /// The columns of a row in which it may lie.
  void narrow(int row, int& left, int& right) const {
    double first = left - u, last = right - u;
    for (const Half* half : {&ab, &bc, &ca}) half->narrow(row - v, first, last);
    left = up(std::min(first + u, right + 1.0));
    right = down(std::max(last + u, left - 1.0));
  }
  /// Shows it where it is nearer than what a spot shows, and `limit` is nearer still.
  void show(Spot& spot, std::uint32_t face, double limit) const {
    const double across = spot.u - u, along = spot.v - v;
    // Of a triangle seen edge on, the plane says nothing; its corners do.
    const double here = std::min(std::max(near.x() + near.y() * across + near.z() * along, lowest), highest);
    const bool seen = (ab.value(across, along) >= 0.0) & (bc.value(across, along) >= 0.0) &
                      (ca.value(across, along) >= 0.0) & (here > spot.near) & (here <= limit);
    spot.near = seen ? here : spot.near;
    spot.face = seen ? face : spot.face;
  }
};

namespace {
double sign_of(const ImageCorner& a, const ImageCorner& b, const ImageCorner& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u) < 0.0 ? -1.0 : 1.0;
}
}  // namespace

SpotDrawing::Shape::Shape(const Lens& lens, const Projection::Body& body, const Projection::Covering& covering,
                          const ImageCorner& a, const ImageCorner& b, const ImageCorner& c)
    : u(covering.left),
      v(covering.top),
      ab(a, b, sign_of(a, b, c), u, v),
      bc(b, c, sign_of(a, b, c), u, v),
      ca(c, a, sign_of(a, b, c), u, v),
      lowest(std::min(a.near, std::min(b.near, c.near))),
      highest(std::max(a.near, std::max(b.near, c.near))) {
  const Scenery::Plane& plane = (*body.placed.planes)[covering.triangle];
  const Vec3 normal = body.turn * plane.normal;
  const Vec3 slope = normal / (plane.offset + normal.dot(body.place));  // 1 / depth = slope . ray
  near = {slope.dot(Vec3((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1.0)), slope.x() / lens.fx,
          slope.y() / lens.fy};
}

void SpotDrawing::draw_triangle(Band& band, const Projection::Body& body, const Projection::Covering& covering) const {
  constexpr int wide = 6;  // pixels: rows of narrower triangles are not worth the sums
  const int top = band.index * Projection::band_rows;
  const int last = std::min(covering.bottom - top, Projection::band_rows - 1);
  const auto begin_of = [&](int row, int column) {
    return band.begins[static_cast<std::size_t>(row) * lens_.width + static_cast<std::size_t>(column)];
  };
  int row = std::max(covering.top - top, 0);
  while (row <= last && begin_of(row, covering.left) == begin_of(row, covering.right + 1)) ++row;
  if (row > last) return;
  const Triangle& t = body.placed.mesh->triangles[covering.triangle];
  const Shape shape(lens_, body, covering, body.corners[t[0]], body.corners[t[1]], body.corners[t[2]]);
  const std::uint32_t face = body.placed.first_face + covering.triangle;
  for (; row <= last; ++row) {
    int left = covering.left, right = covering.right;
    if (right - left >= wide) shape.narrow(row + top, left, right);
    if (left > right) continue;
    const std::uint32_t end = begin_of(row, right + 1);
    for (std::uint32_t i = begin_of(row, left); i < end; ++i) shape.show(band.spots[i], face, nearest_);
  }
}

void SpotDrawing::draw_floor(Band& band) const {
  for (Spot& spot : band.spots) {
    const double here = floor_.dot(Vec3((spot.u - lens_.cx) / lens_.fx, (spot.v - lens_.cy) / lens_.fy, 1.0));
    if (here > spot.near && here <= nearest_) spot.near = here, spot.face = Scenery::floor_face;
  }
}

}  // namespace bin_scenes
