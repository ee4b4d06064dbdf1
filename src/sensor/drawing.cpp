/// Bands of rows are drawn one by one. A band keeps for each pixel the nearest triangle; 1 / depth is linear in the
/// image on a plane.
#include "sensor/drawing.hpp"

#include "core/in_parallel.hpp"
#include "sensor/pixel_rays.hpp"
#include "sensor/spans.hpp"

#include <bitset>
#include <cmath>
#include <cstdint>
#include <limits>

namespace bin_scenes {

namespace {

constexpr int band_rows = 16;  // one band's pixels stay in the processor's cache

/// A mesh as the camera sees it.
struct Body {
  Scenery::Body placed;
  Mat3 turn;   // mesh to camera
  Vec3 place;  // m
  std::vector<ImageCorner> corners;
  bool one_sided = false;  // all that is seen of it faces the camera
  int first_band = 0;
  std::vector<std::vector<std::uint32_t>> bands;  // triangles
};

class Drawing {
 public:
  Drawing(const Scenery& scenery, const Lens& lens, const Pose& pose, double near, double far)
      : scenery_(scenery),
        lens_(lens),
        rays_(lens),
        turn_(pose.orientation.toRotationMatrix()),
        height_over_floor_(pose.position.z()),
        nearest_(1.0 / near),
        farthest_(1.0 / far),
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
  bool place(Body& body, const Pose& mesh_in_camera, bool whole) const;
  void frame(const Body& body, Silhouette& silhouette) const;
  void sort_into_bands(Body& body) const;
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

/// Projects the corners. False: the mesh reaches through the plane of the lens, or is not as whole as it has to be.
bool Drawing::place(Body& body, const Pose& mesh_in_camera, bool whole) const {
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
  return out || in_range || (!whole && closest > 1e-6);
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

/// Leaves out triangles that face away, where those are hidden, and those between pixel centres.
void Drawing::sort_into_bands(Body& body) const {
  if (body.corners.empty()) return;
  double top = 1e300, bottom = -top;
  for (const ImageCorner& corner : body.corners) top = std::min(top, corner.v), bottom = std::max(bottom, corner.v);
  const double end = lens_.height - 1.0, right_end = lens_.width - 1.0;
  if (bottom < -edge || top > end + edge) return;
  body.first_band = down(std::max(top, 0.0)) / band_rows;
  body.bands.resize(static_cast<std::size_t>(down(std::min(bottom + 1.0, end)) / band_rows - body.first_band + 1));
  const std::vector<Triangle>& triangles = body.placed.mesh->triangles;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const ImageCorner &a = body.corners[triangles[t][0]], &b = body.corners[triangles[t][1]],
                      &c = body.corners[triangles[t][2]];
    const double area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);  // seen from outside: negative
    if (body.one_sided ? !(area < 0.0) : !(area != 0.0)) continue;
    const double high = std::min(a.v, std::min(b.v, c.v)), low = std::max(a.v, std::max(b.v, c.v));
    const double left = std::min(a.u, std::min(b.u, c.u)), right = std::max(a.u, std::max(b.u, c.u));
    if (low < -edge || high > end + edge || right < -edge || left > right_end + edge) continue;
    if (up(std::max(left - edge, 0.0)) > down(std::min(right + edge, right_end))) continue;
    const int first = up(std::max(high - edge, 0.0)), last = down(std::min(low + edge, end));
    if (first > last) continue;
    for (int band = first / band_rows; band <= last / band_rows; ++band)
      body.bands[static_cast<std::size_t>(band - body.first_band)].push_back(t);
  }
}

bool Drawing::place_bodies(bool for_silhouettes) {
  const Pose bin_in_camera = view_.pose.inverse();
  std::vector<char> fits(bodies_.size(), 0);
  in_parallel(bodies_.size(), [&](std::size_t i) {
    Body& body = bodies_[i];
    body.placed = scenery_.body(i);
    const bool part = body.placed.part >= 0;
    fits[i] = place(body, bin_in_camera * body.placed.pose, for_silhouettes && part);
    if (!fits[i]) return;
    sort_into_bands(body);
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
    for (const std::uint32_t t : body.bands[own]) draw_triangle(band, body, t, silhouette);
  }
  if (scenery_.on_floor()) draw_floor(band);
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
