/// Bands of rows are drawn one by one. A band keeps for each pixel the nearest triangle; 1 / depth is linear in the
/// image on a plane.
#include "raster/drawing.hpp"

#include "core/in_parallel.hpp"
#include "raster/pixel_rays.hpp"
#include "raster/projection.hpp"
#include "raster/spans.hpp"

#include <bitset>
#include <cmath>
#include <cstdint>
#include <limits>

namespace bin_scenes {

namespace {

constexpr int band_rows = Projection::band_rows;
using Body = Projection::Body;

class Drawing {
 public:
  Drawing(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far)
      : scenery_(scenery),
        lens_(lens),
        rays_(lens),
        turn_(pose.orientation.toRotationMatrix()),
        height_over_floor_(pose.position.z() - scenery.floor_height().value_or(0.0)),
        nearest_(1.0 / near),
        farthest_(1.0 / far),
        projection_(lens, near, far, 0.0),
        bodies_(scenery.body_count()),
        silhouettes_(scenery.part_count()) {
    view_.lens = lens;
    view_.pose = pose;
  }

  bool place_bodies(bool for_silhouettes);
  void draw();
  View& view() { return view_; }
  std::vector<Silhouette>& silhouettes() { return silhouettes_; }

 private:
  struct Band;
  void frame(const Body& body, Silhouette& silhouette) const;
  void draw_band(int band);
  void draw_triangle(Band& band, const Body& body, std::uint32_t triangle, Silhouette* silhouette) const;
  void draw_floor(Band& band) const;
  void show(const Band& band);
  struct Shown {
    std::array<float, 3> normal;
    std::uint16_t label;
    std::int32_t line;
  };
  Shown shown_of(std::uint32_t face) const;

  const Scenery& scenery_;
  Lens lens_;
  PixelRays rays_;
  Mat3 turn_;
  double height_over_floor_;
  double nearest_, farthest_;  // 1 / depth
  Projection projection_;
  std::vector<Body> bodies_;
  View view_;
  std::vector<Silhouette> silhouettes_;
};

/// Where a band keeps some pixels of a row.
struct Kept {
  double* near;
  std::uint32_t* face;
};

struct Drawing::Band {
  int top, bottom;           // rows, inclusive
  std::vector<double> near;  // 1 / depth
  std::vector<std::uint32_t> face;

  Kept at(int row, int width, int column) {
    const std::size_t i = static_cast<std::size_t>(row - top) * width + column;
    return {&near[i], &face[i]};
  }
};

void set_bits(Silhouette& s, int row, int first, int last) {
  std::uint64_t* const words = &s.bits[static_cast<std::size_t>(row - s.top) * s.words_per_row()];
  first -= s.left, last -= s.left;
  for (int word = first / 64; word <= last / 64; ++word) {
    const int from = std::max(first - 64 * word, 0), to = std::min(last - 64 * word, 63);
    words[word] |= (~std::uint64_t{0} >> (63 - to)) & (~std::uint64_t{0} << from);
  }
}

/// The rectangle of the image that a body can cover.
void Drawing::frame(const Body& body, Silhouette& s) const {
  double left = 1e300, right = -left, top = left, bottom = -left;
  for (const ImageCorner& corner : body.corners) {
    left = std::min(left, corner.u), right = std::max(right, corner.u);
    top = std::min(top, corner.v), bottom = std::max(bottom, corner.v);
  }
  const auto clamped = [](double value, int end) { return std::clamp(value, -1.0, static_cast<double>(end)); };
  const int first = std::max(0, down(clamped(left, lens_.width))),
            last = std::min(lens_.width - 1, up(clamped(right, lens_.width)));
  const int upper = std::max(0, down(clamped(top, lens_.height))),
            lower = std::min(lens_.height - 1, up(clamped(bottom, lens_.height)));
  if (last < first || lower < upper) return;
  s.left = first, s.top = upper;
  s.width = last - first + 1, s.height = lower - upper + 1;
  s.bits.assign(s.words_per_row() * static_cast<std::size_t>(s.height), 0);
}

bool Drawing::place_bodies(bool for_silhouettes) {
  const Pose bin_in_camera = view_.pose.inverse();
  std::vector<char> fits(bodies_.size(), 0);
  in_parallel(bodies_.size(), [&](std::size_t i) {
    Body& body = bodies_[i];
    body.placed = scenery_.body(i);
    const bool part = body.placed.part >= 0;
    fits[i] = projection_.place(body, bin_in_camera * body.placed.pose, for_silhouettes && part);
    if (!fits[i]) return;
    if (for_silhouettes && part) frame(body, silhouettes_[static_cast<std::size_t>(body.placed.part)]);
  });
  return std::find(fits.begin(), fits.end(), 0) == fits.end();
}

/// What of a plane lies nearer than all before. `near` is linear: start + step * (x of the ray).
struct Plane {
  double start, step, lowest, highest, limit;
};
void draw_span(const Plane& plane, const double* ray_x, int count, const Kept& kept, std::uint32_t face) {
  for (int i = 0; i < count; ++i) {
    // Of a triangle seen edge on, the plane says nothing; its corners do.
    const double here = std::min(std::max(plane.start + plane.step * ray_x[i], plane.lowest), plane.highest);
    const bool first = here > kept.near[i] && here <= plane.limit;
    kept.near[i] = first ? here : kept.near[i];
    kept.face[i] = first ? face : kept.face[i];
  }
}

void Drawing::draw_triangle(Band& band, const Body& body, std::uint32_t t, Silhouette* silhouette) const {
  const Triangle& corners = body.placed.mesh->triangles[t];
  const ImageCorner* const corner[3] = {&body.corners[corners[0]], &body.corners[corners[1]],
                                        &body.corners[corners[2]]};
  const Scenery::Plane& plane = (*body.placed.planes)[t];
  const Vec3 normal = body.turn * plane.normal;
  const Vec3 slope = normal / (plane.offset + normal.dot(body.place));  // 1 / depth = slope . ray
  const auto [lowest, highest] = std::minmax({corner[0]->near, corner[1]->near, corner[2]->near});
  for_spans(corner, band.top, band.bottom, lens_.width, [&](int row, int first, int last) {
    const Plane along{slope.y() * rays_.y(row) + slope.z(), slope.x(), lowest, highest, nearest_};
    draw_span(along, rays_.x() + first, last - first + 1, band.at(row, lens_.width, first), body.placed.first_face + t);
    if (silhouette) set_bits(*silhouette, row, first, last);
  });
}

void Drawing::draw_floor(Band& band) const {
  for (int row = band.top; row <= band.bottom; ++row) {
    const Vec3 slope = turn_.row(2).transpose() / -height_over_floor_;
    const Plane along{slope.y() * rays_.y(row) + slope.z(), slope.x(), -1e300, 1e300, nearest_};
    draw_span(along, rays_.x(), lens_.width, band.at(row, lens_.width, 0), Scenery::floor_face);
  }
}

void Drawing::draw_band(int index) {
  thread_local Band band;  // keeps its memory
  band.top = index * band_rows;
  band.bottom = std::min(band.top + band_rows, lens_.height) - 1;
  const std::size_t pixels = static_cast<std::size_t>(band.bottom - band.top + 1) * lens_.width;
  band.near.assign(pixels, farthest_);
  band.face.assign(pixels, Scenery::no_face);
  for (const Body& body : bodies_) {
    const std::size_t own = static_cast<std::size_t>(index) - static_cast<std::size_t>(body.first_band);
    if (own >= body.bands.size()) continue;
    Silhouette* const silhouette =
        body.placed.part < 0 || silhouettes_[static_cast<std::size_t>(body.placed.part)].bits.empty()
            ? nullptr
            : &silhouettes_[static_cast<std::size_t>(body.placed.part)];
    for (const Projection::Covering& c : body.bands[own]) draw_triangle(band, body, c.triangle, silhouette);
  }
  if (scenery_.floor_height()) draw_floor(band);
  show(band);
}

/// From faces to depth, label and normal.
void Drawing::show(const Band& band) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const std::size_t first = static_cast<std::size_t>(band.top) * lens_.width;
  std::uint32_t face = Scenery::no_face;
  Shown shown{{nan, nan, nan}, 0, -1};
  for (std::size_t i = 0; i < band.near.size(); ++i) {
    if (band.face[i] != face) shown = shown_of(face = band.face[i]);
    view_.depth[first + i] = face == Scenery::no_face ? std::numeric_limits<double>::quiet_NaN() : 1.0 / band.near[i];
    view_.label[first + i] = shown.label;
    view_.normal[first + i] = shown.normal;
    view_.face[first + i] = face;
    view_.line[first + i] = shown.line;
  }
}

Drawing::Shown Drawing::shown_of(std::uint32_t face) const {
  Vec3 n = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  Shown shown{{}, 0, -1};
  if (face == Scenery::floor_face) {
    n = (height_over_floor_ > 0.0 ? 1.0 : -1.0) * turn_.row(2).transpose();
    shown.line = scenery_.floor_line();
  } else if (face != Scenery::no_face) {
    const auto after = std::upper_bound(bodies_.begin(), bodies_.end(), face,
                                        [](std::uint32_t f, const Body& body) { return f < body.placed.first_face; });
    const Body& body = *std::prev(after);
    const Scenery::Plane& plane = (*body.placed.planes)[face - body.placed.first_face];
    n = body.turn * plane.normal;
    if (plane.offset + n.dot(body.place) > 0.0) n = -n;  // towards the lens
    shown.label = body.placed.label, shown.line = body.placed.line;
  }
  shown.normal = {static_cast<float>(n.x()), static_cast<float>(n.y()), static_cast<float>(n.z())};
  return shown;
}

void Drawing::draw() {
  const std::size_t pixels = static_cast<std::size_t>(lens_.width) * lens_.height;
  view_.depth.resize(pixels);
  view_.label.resize(pixels);
  view_.normal.resize(pixels);
  view_.line.resize(pixels);
  view_.face.resize(pixels);
  in_parallel(static_cast<std::size_t>((lens_.height + band_rows - 1) / band_rows),
              [&](std::size_t band) { draw_band(static_cast<int>(band)); });
  for (Silhouette& s : silhouettes_)
    for (const std::uint64_t word : s.bits) s.count += std::bitset<64>(word).count();
}

}  // namespace

std::optional<View> drawn(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far,
                          std::vector<Silhouette>* alone) {
  if (lens.distorts() || lens.skew != 0.0) return std::nullopt;
  Drawing drawing(scenery, lens, pose, near, far);
  if (!drawing.place_bodies(alone != nullptr)) return std::nullopt;
  drawing.draw();
  if (alone) *alone = std::move(drawing.silhouettes());
  return std::move(drawing.view());
}

}  // namespace bin_scenes
