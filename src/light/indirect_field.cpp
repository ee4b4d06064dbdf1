/// A node for each face of a tile of the image, and in each quarter again where other surfaces are near; light is
/// gathered there. A pixel takes from the nodes of its own face.
#include "light/indirect_field.hpp"

#include "core/in_parallel.hpp"
#include "raster/pixel_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace bin_scenes {

namespace {

constexpr int coarsest = 8;          // pixel: largest distance between nodes
constexpr int finest = 1;            // pixel: smallest one
constexpr int tile_size = 4;         // pixel: of one tile all pixels ask the same nodes
constexpr double averaged = 0.2;     // of the distance to other surfaces: as far as indirect light is nearly linear
constexpr float predicted = 0.4f;    // share of the nodes' slopes in what lies between them
constexpr int most_samples = 1024;   // rays a node
constexpr float one_normal = 0.97f;  // cosine: facets of a curved surface that turn by less are one face
constexpr float one_plane = 0.15f;   // distance off a face's plane / distance on it

/// Nodes are closer together where surfaces are nearer than so many of their distances. Of few rays a node errs by more
/// than interpolation between distant nodes does; only many rays make close nodes worth their time.
double near_by(int samples) {
  return std::min(9.0, 1.5 * std::sqrt(samples / 16.0));
}

/// How much faster than of a matte surface the light changes along a shiny one, whose lobe meets less.
double narrowness(const Surface& surface) {
  return 1.0 + 2.0 * surface.gloss;
}

}  // namespace

IndirectField::IndirectField(const LitScene& scene, const View& view, const Setup& setup, const Pattern& pattern,
                             const Random& random)
    : scene_(scene),
      view_(view),
      setup_(setup),
      channels_(pattern.channels),
      growing_(pattern.growing),
      unit_(pattern.unit),

      respond_(pattern.respond),
      random_(random),
      width_(view.lens.width),
      height_(view.lens.height),
      columns_((width_ + tile_size - 1) / tile_size),
      rows_((height_ + tile_size - 1) / tile_size),
      points_(view.depth.size()) {
  const PixelRays rays(view.lens);
  in_parallel(static_cast<std::size_t>(height_), [&](std::size_t y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
      const std::size_t i = y * static_cast<std::size_t>(width_) + x;
      points_[i] = (view_.depth[i] * rays.at(x, y)).cast<float>();
    }
  });
  const int across = (width_ + coarsest - 1) / coarsest, down = (height_ + coarsest - 1) / coarsest;
  std::vector<Nodes> squares(static_cast<std::size_t>(across) * down);
  in_parallel(squares.size(), [&](std::size_t i) {
    fill(squares[i], static_cast<int>(i) % across * coarsest, static_cast<int>(i) / across * coarsest);
  });
  for (const Nodes& square : squares) {
    nodes_.all.insert(nodes_.all.end(), square.all.begin(), square.all.end());
    nodes_.followed.insert(nodes_.followed.end(), square.followed.begin(), square.followed.end());
    nodes_.others.insert(nodes_.others.end(), square.others.begin(), square.others.end());
  }
  sort_into_tiles();
}

/// Calls work(tile) for those in which a node counts.
template <class Work>
void IndirectField::for_tiles(const Node& node, const Work& work) const {
  const auto tile = [](float place, int count) {
    return std::clamp(static_cast<int>(std::floor(place / tile_size)), 0, count - 1);
  };
  for (int v = tile(node.y - node.reach, rows_); v <= tile(node.y + node.reach, rows_); ++v) {
    for (int u = tile(node.x - node.reach, columns_); u <= tile(node.x + node.reach, columns_); ++u) {
      work(static_cast<std::size_t>(v) * columns_ + u);
    }
  }
}

void IndirectField::sort_into_tiles() {
  const std::size_t tiles = static_cast<std::size_t>(columns_) * rows_;
  first_.assign(tiles + 1, 0);
  lit_.assign(tiles, 0);
  for (const Node& node : nodes_.all) {
    for_tiles(node, [&](std::size_t tile) {
      ++first_[tile + 1];
      lit_[tile] |= node.lit;
    });
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  near_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t n = 0; n < nodes_.all.size(); ++n) {
    for_tiles(nodes_.all[n], [&](std::size_t tile) { near_[next[tile]++] = n; });
  }
}

std::size_t IndirectField::tile_of(std::size_t pixel) const {
  const auto width = static_cast<std::size_t>(width_);
  return pixel / width / tile_size * static_cast<std::size_t>(columns_) + pixel % width / tile_size;
}

IndirectField::Face IndirectField::face(std::size_t pixel) const {
  return {points_[pixel], Eigen::Vector3f(view_.normal[pixel].data()), view_.line[pixel], view_.label[pixel]};
}

bool IndirectField::one_face(const Face& a, const Face& b) {
  if (a.label != b.label || a.line != b.line || !(a.normal.dot(b.normal) > one_normal)) return false;
  const Eigen::Vector3f apart = b.point - a.point;
  const float off = a.normal.dot(apart);
  return off * off <= one_plane * one_plane * apart.squaredNorm();
}

void IndirectField::fill(Nodes& out, int left, int top) const {
  std::vector<std::size_t> pixels;
  for (int y = top; y < std::min(top + coarsest, height_); ++y) {
    for (int x = left; x < std::min(left + coarsest, width_); ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width_ + x;
      if (!std::isnan(view_.depth[i])) pixels.push_back(i);
    }
  }
  divide(out, left, top, coarsest, std::move(pixels));
}

/// The pixel nearest to the mean place of some.
std::size_t IndirectField::central_pixel(const std::vector<std::size_t>& pixels) const {
  double x = 0.0, y = 0.0;
  for (const std::size_t i : pixels) x += static_cast<double>(i % width_), y += static_cast<double>(i / width_);
  x /= static_cast<double>(pixels.size()), y /= static_cast<double>(pixels.size());
  const auto off = [&](std::size_t i) {
    const double u = static_cast<double>(i % width_) - x, v = static_cast<double>(i / width_) - y;
    return u * u + v * v;
  };
  return *std::min_element(pixels.begin(), pixels.end(), [&](std::size_t a, std::size_t b) { return off(a) < off(b); });
}

/// The number of rays that a node needs for the standard error of the setup, by the variance of its first rays. Few
/// nodes with many rays cost less than many nodes with few, for the same error: what varies between nodes is noise
/// first.
int IndirectField::samples_for(const Gathered& light) const {
  const double tolerated = setup_.error * unit_;
  if (tolerated <= 0.0) return setup_.samples;
  double sum = 0.0, square = 0.0;
  for (const Path& path : light.paths) sum += path.weight, square += path.weight * path.weight;
  const double variance = std::max(0.0, setup_.samples * square - sum * sum);  // of one ray's share of the light
  return static_cast<int>(std::clamp(variance / (tolerated * tolerated), 1.0 * setup_.samples,
                                     std::max(1.0 * setup_.samples, 1.0 * most_samples)));
}

/// Light of a node. False: other surfaces are too near.
bool IndirectField::look(std::size_t pixel, double too_near, Gathered& light) const {
  const Face at = face(pixel);
  const SeenPoint point{view_.pose * at.point.cast<double>(), view_.pose.orientation * at.normal.cast<double>(),
                        at.line, true, at.label};
  const Vec3& eye = view_.pose.position;
  const Random key = random_.of_piece(pixel);
  if (!gather(scene_, point, eye, {setup_.samples, setup_.bounces, too_near}, key, light)) return false;
  const int samples = samples_for(light);
  if (samples > setup_.samples) gather(scene_, point, eye, {samples, setup_.bounces}, key, light);
  return true;
}

/// A node for each face of a square of the image; where surfaces are near, in each quarter again.
void IndirectField::divide(Nodes& out, int left, int top, int spacing, std::vector<std::size_t> pixels) const {
  Gathered light;
  while (!pixels.empty()) {
    const std::size_t seed = pixels.front();
    const Face own = face(seed);
    const auto rest =
        std::stable_partition(pixels.begin(), pixels.end(), [&](std::size_t i) { return one_face(own, face(i)); });
    std::vector<std::size_t> same(pixels.begin(), rest);
    if (same.empty()) same.push_back(seed);  // of a normal that is no number
    pixels.erase(pixels.begin(), rest == pixels.begin() ? rest + 1 : rest);
    const std::size_t center = central_pixel(same);
    const double size = spacing * view_.depth[center] / view_.lens.fx;
    const double dense = near_by(setup_.samples) * narrowness(scene_.surfaces.of(own.line));
    const double too_near = spacing <= finest ? std::numeric_limits<double>::infinity() : 1.0 / (dense * size);
    if (look(center, too_near, light)) {
      add_node(out, center, spacing, light);
      continue;
    }
    const int half = spacing / 2;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int l = left + (quarter & 1) * half, t = top + quarter / 2 * half;
      std::vector<std::size_t> inside;
      for (const std::size_t i : same) {
        const int u = static_cast<int>(i % width_), v = static_cast<int>(i / width_);
        if (u >= l && u < l + half && v >= t && v < t + half) inside.push_back(i);
      }
      divide(out, l, t, half, std::move(inside));
    }
  }
}

/// From what a pixel sees to what a ray beside its own meets on the same plane (m, bin frame).
Vec3 IndirectField::step_on_face(std::size_t pixel, const Vec3& step) const {
  const auto& n = view_.normal[pixel];
  const Vec3 normal(n[0], n[1], n[2]), ray = points_[pixel].cast<double>() / view_.depth[pixel];
  return view_.pose.orientation * (view_.depth[pixel] * (step - normal.dot(step) / normal.dot(ray) * ray));
}

void IndirectField::add_node(Nodes& out, std::size_t pixel, int spacing, const Gathered& light) const {
  thread_local std::vector<float> values;
  values.assign(3 * static_cast<std::size_t>(channels_), 0.0f);
  if (!light.paths.empty()) {
    const Vec3 steps[] = {step_on_face(pixel, Vec3(1.0 / view_.lens.fx, 0.0, 0.0)),
                          step_on_face(pixel, Vec3(0.0, 1.0 / view_.lens.fy, 0.0))};
    respond_(light.paths, steps, values.data());
  }
  for (int part = 0; part < 3; ++part)
    out.followed.insert(out.followed.end(), values.begin() + part * channels_,
                        values.begin() + part * channels_ + growing_);
  out.others.insert(out.others.end(), values.begin() + growing_, values.begin() + channels_);
  const double pixel_size = view_.depth[pixel] / view_.lens.fx;
  const double reach = std::clamp(
      averaged / narrowness(scene_.surfaces.of(view_.line[pixel])) / std::max(light.nearness * pixel_size, 1e-9),
      1.5 * spacing, 1.5 * coarsest);
  out.all.push_back({face(pixel), static_cast<float>(pixel % width_), static_cast<float>(pixel / width_),
                     static_cast<float>(reach), !light.paths.empty()});
}

/// What the nearest node of the face has: for slivers of faces.
bool IndirectField::nearest(std::size_t pixel, int count, float* channels) const {
  const auto width = static_cast<std::size_t>(width_);
  const auto x = static_cast<float>(pixel % width), y = static_cast<float>(pixel / width);
  const Face own = face(pixel);
  const std::size_t tile = tile_of(pixel);
  float distance = 2.0f * coarsest;
  const Node* best = nullptr;
  std::uint32_t number = 0;
  for (std::uint32_t k = first_[tile]; k < first_[tile + 1]; ++k) {
    const std::uint32_t i = near_[k];
    const Node& node = nodes_.all[i];
    const float off = std::abs(node.x - x) + std::abs(node.y - y);
    if (off >= distance || !one_face(node.face, own)) continue;
    distance = off;
    best = &node, number = i;
  }
  if (!best || !best->lit) return false;
  const int followed = std::min(count, growing_);
  std::copy_n(&nodes_.followed[3 * static_cast<std::size_t>(number) * growing_], followed, channels);
  const std::size_t others = static_cast<std::size_t>(number) * static_cast<std::size_t>(channels_ - growing_);
  for (int c = growing_; c < count; ++c) channels[c] = nodes_.others[others + static_cast<std::size_t>(c - growing_)];
  return true;
}

/// A plane through the nodes around, the nearer the heavier. Where the light bends, such a mean errs by as much to one
/// side as the mean of what the nodes' own slopes predict errs to the other: the centre of both is taken. A little
/// less of the slopes, for they do not know where the lit surface ends.
bool IndirectField::at(std::size_t pixel, int count, float* channels) const {
  std::fill(channels, channels + count, 0.0f);
  const std::size_t tile = tile_of(pixel);
  if (!lit_[tile] || std::isnan(view_.depth[pixel])) return false;
  const auto width = static_cast<std::size_t>(width_);
  const auto x = static_cast<float>(pixel % width), y = static_cast<float>(pixel / width);
  struct Used {
    std::uint32_t node;
    float weight, x, y;
  };
  thread_local std::vector<Used> used;
  used.clear();
  const Face own = face(pixel);
  float m = 0.0f, mx = 0.0f, my = 0.0f, mxx = 0.0f, mxy = 0.0f, myy = 0.0f;
  bool lit = false;
  for (std::uint32_t k = first_[tile]; k < first_[tile + 1]; ++k) {
    const std::uint32_t i = near_[k];
    const Node& node = nodes_.all[i];
    const float u = node.x - x, v = node.y - y;
    if (std::abs(u) >= node.reach || std::abs(v) >= node.reach || !one_face(node.face, own)) continue;
    const float share = 1.0f / node.reach;
    const float weight = (1.0f - share * std::abs(u)) * (1.0f - share * std::abs(v));
    if (!(weight > 0.0f)) continue;
    used.push_back({i, weight, u, v});
    lit = lit || node.lit;
    m += weight, mx += weight * u, my += weight * v;
    mxx += weight * u * u, mxy += weight * u * v, myy += weight * v * v;
  }
  if (used.empty()) return nearest(pixel, count, channels);
  if (!lit) return false;
  // Weighted least squares; a ridge keeps few nodes, or nodes in a line, from leaning the plane.
  const float ridge = 1e-3f * m + 0.05f * (mxx + myy);
  const float cx = mx / m, cy = my / m;
  const float sxx = mxx - mx * cx + ridge, sxy = mxy - mx * cy, syy = myy - my * cy + ridge;
  const float det = sxx * syy - sxy * sxy;
  const float ax = -(syy * cx - sxy * cy) / det, ay = -(sxx * cy - sxy * cx) / det;
  for (const Used& u : used) {
    const float weight = u.weight * (1.0f / m + ax * (u.x - cx) + ay * (u.y - cy));
    const float* const value = &nodes_.followed[3 * static_cast<std::size_t>(u.node) * growing_];
    const float *const right = value + growing_, *const down = right + growing_;
    for (int c = 0; c < std::min(count, growing_); ++c) {
      channels[c] += weight * (value[c] - predicted * (u.x * right[c] + u.y * down[c]));
    }
    const std::size_t others = static_cast<std::size_t>(u.node) * static_cast<std::size_t>(channels_ - growing_);
    for (int c = growing_; c < count; ++c)
      channels[c] += weight * nodes_.others[others + static_cast<std::size_t>(c - growing_)];
  }
  return true;
}

}  // namespace bin_scenes
