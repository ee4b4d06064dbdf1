/// A node for each face of a tile of the image, and in each quarter again where other surfaces are near; light is
/// gathered there. A pixel takes from the nodes of its own face.
#include "sensor/models/indirect_field.hpp"

#include "core/in_parallel.hpp"
#include "sensor/pixel_rays.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr int tile_size = 8;         // pixel: largest distance between nodes
constexpr int finest = 1;            // pixel: smallest one
constexpr double near_by = 8.0;      // nodes lie closer where surfaces are nearer than so many of their distances
constexpr double averaged = 0.2;     // of the distance to other surfaces: as far as indirect light is nearly linear
constexpr float foretold = 0.4f;     // share of the nodes' slopes in what lies between them
constexpr float one_normal = 0.97f;  // cosine: facets of a curved surface that turn by less are one face
constexpr float one_plane = 0.15f;   // distance off a face's plane / distance on it

}  // namespace

IndirectField::IndirectField(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Lamp& lamp,
                             const Setup& setup, int channels, int growing, const Respond& respond,
                             const Random& random)
    : scenery_(scenery),
      view_(view),
      surfaces_(surfaces),
      lamp_(lamp),
      setup_(setup),
      channels_(channels),
      growing_(growing),
      respond_(respond),
      random_(random),
      width_(view.lens.width),
      height_(view.lens.height),
      columns_((width_ + tile_size - 1) / tile_size),
      points_(view.depth.size()) {
  const int rows = (height_ + tile_size - 1) / tile_size;
  tiles_.resize(static_cast<std::size_t>(rows) * columns_);
  const PixelRays rays(view.lens);
  in_parallel(static_cast<std::size_t>(height_), [&](std::size_t y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
      const std::size_t i = y * static_cast<std::size_t>(width_) + x;
      points_[i] = (view_.depth[i] * rays.at(x, y)).cast<float>();
    }
  });
  in_parallel(static_cast<std::size_t>(rows), [&](std::size_t row) {
    for (int column = 0; column < columns_; ++column) {
      fill(tiles_[row * static_cast<std::size_t>(columns_) + column], column * tile_size,
           static_cast<int>(row) * tile_size);
    }
  });
  std::vector<std::uint32_t> first;
  for (Tile& t : tiles_) {
    first.push_back(static_cast<std::uint32_t>(nodes_.size()));
    nodes_.insert(nodes_.end(), t.nodes.begin(), t.nodes.end());
    values_.insert(values_.end(), t.values.begin(), t.values.end());
    t.nodes = {};
    t.values = {};
  }
  first.push_back(static_cast<std::uint32_t>(nodes_.size()));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns_; ++x) {
      Tile& own = tiles_[static_cast<std::size_t>(y) * columns_ + x];
      bool lit = false;
      for (int v = std::max(0, y - 1); v <= std::min(rows - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(columns_ - 1, x + 1); ++u) {
          const std::size_t at = static_cast<std::size_t>(v) * columns_ + u;
          for (std::uint32_t n = first[at]; n < first[at + 1]; ++n) {
            if (!reaches(nodes_[n], x, y)) continue;
            own.near.push_back(n);
            lit = lit || nodes_[n].lit;
          }
        }
      }
      if (!lit) own.near.clear();
    }
  }
}

/// Whether a node counts for pixels of a tile.
bool IndirectField::reaches(const Node& node, int column, int row) const {
  const auto off = [](float at, int tile) {
    return std::max(static_cast<float>(tile * tile_size) - at, at - static_cast<float>((tile + 1) * tile_size - 1));
  };
  return off(node.x, column) < node.reach && off(node.y, row) < node.reach;
}

std::size_t IndirectField::tile_of(std::size_t pixel) const {
  const auto width = static_cast<std::size_t>(width_);
  return pixel / width / tile_size * static_cast<std::size_t>(columns_) + pixel % width / tile_size;
}

bool IndirectField::one_face(std::size_t a, std::size_t b) const {
  if (view_.label[a] != view_.label[b] || view_.line[a] != view_.line[b]) return false;
  const auto &n = view_.normal[a], &m = view_.normal[b];
  if (!(n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > one_normal)) return false;
  const Eigen::Vector3f apart = points_[b] - points_[a];
  const float off = n[0] * apart[0] + n[1] * apart[1] + n[2] * apart[2];
  return off * off <= one_plane * one_plane * apart.squaredNorm();
}

void IndirectField::fill(Tile& out, int left, int top) const {
  std::vector<std::size_t> pixels;
  for (int y = top; y < std::min(top + tile_size, height_); ++y) {
    for (int x = left; x < std::min(left + tile_size, width_); ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width_ + x;
      if (!std::isnan(view_.depth[i])) pixels.push_back(i);
    }
  }
  divide(out, left, top, tile_size, std::move(pixels));
}

/// A node for each face of a square of the image; where surfaces are near, in each quarter again.
void IndirectField::divide(Tile& out, int left, int top, int spacing, std::vector<std::size_t> pixels) const {
  while (!pixels.empty()) {
    const std::size_t seed = pixels.front();
    const auto rest =
        std::stable_partition(pixels.begin(), pixels.end(), [&](std::size_t i) { return one_face(seed, i); });
    std::vector<std::size_t> face(pixels.begin(), rest);
    if (face.empty()) face.push_back(seed);  // of a normal that is no number
    pixels.erase(pixels.begin(), rest == pixels.begin() ? rest + 1 : rest);
    double x = 0.0, y = 0.0;
    for (const std::size_t i : face) x += static_cast<double>(i % width_), y += static_cast<double>(i / width_);
    x /= static_cast<double>(face.size()), y /= static_cast<double>(face.size());
    const auto off = [&](std::size_t i) {
      const double u = static_cast<double>(i % width_) - x, v = static_cast<double>(i / width_) - y;
      return u * u + v * v;
    };
    const std::size_t middle =
        *std::min_element(face.begin(), face.end(), [&](std::size_t a, std::size_t b) { return off(a) < off(b); });
    const double pixel_size = view_.depth[middle] / view_.lens.fx;
    if (spacing <= finest || nearness(middle, spacing) * near_by * spacing * pixel_size < 1.0) {
      add_node(out, middle, spacing);
      continue;
    }
    const int half = spacing / 2;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int l = left + (quarter & 1) * half, t = top + quarter / 2 * half;
      std::vector<std::size_t> inside;
      for (const std::size_t i : face) {
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
  const Vec3 normal(n[0], n[1], n[2]), ray = position(pixel) / view_.depth[pixel];
  return view_.pose.orientation * (view_.depth[pixel] * (step - normal.dot(step) / normal.dot(ray) * ray));
}

SeenPoint IndirectField::point_of(std::size_t pixel) const {
  const auto& n = view_.normal[pixel];
  return {view_.pose * position(pixel), view_.pose.orientation * Vec3(n[0], n[1], n[2]), view_.line[pixel], true};
}

/// Mean of 1 / distance to what lies around (1/m), by a few rays.
double IndirectField::nearness(std::size_t pixel, int spacing) const {
  constexpr int rays = 8;
  const Random key = random_.of_piece(pixel).of_piece(static_cast<std::size_t>(spacing));
  return bin_scenes::nearness(scenery_, surfaces_, point_of(pixel), view_.pose.position, rays, key);
}

void IndirectField::add_node(Tile& out, std::size_t pixel, int spacing) const {
  Gathered light;
  gather(scenery_, lamp_, surfaces_, point_of(pixel), view_.pose.position, setup_.samples, setup_.bounces,
         random_.of_piece(pixel), light);
  const std::size_t at = out.values.size();
  out.values.resize(at + 3 * static_cast<std::size_t>(channels_), 0.0f);
  if (!light.paths.empty()) {
    respond_(light.paths, channels_, &out.values[at]);
    std::vector<float> moved(growing_);
    const Vec3 steps[] = {Vec3(1.0 / view_.lens.fx, 0.0, 0.0), Vec3(0.0, 1.0 / view_.lens.fy, 0.0)};
    for (int axis = 0; axis < 2; ++axis) {
      const Vec3 step = step_on_face(pixel, steps[axis]);
      float* const growth = &out.values[at + static_cast<std::size_t>((1 + axis) * channels_)];
      for (const double half : {-0.5, 0.5}) {
        std::vector<Path> paths = light.paths;
        for (Path& path : paths) path.column += half * path.slope.dot(step);
        std::fill(moved.begin(), moved.end(), 0.0f);
        respond_(paths, growing_, moved.data());
        for (int c = 0; c < growing_; ++c) growth[c] += half > 0.0 ? moved[c] : -moved[c];
      }
    }
  }
  const double pixel_size = view_.depth[pixel] / view_.lens.fx;
  const double reach =
      std::clamp(averaged / std::max(light.nearness * pixel_size, 1e-9), 1.5 * spacing, 1.5 * tile_size);
  out.nodes.push_back({pixel, static_cast<float>(pixel % width_), static_cast<float>(pixel / width_),
                       static_cast<float>(reach), !light.paths.empty()});
}

/// What the nearest node of the face has: for slivers of faces.
bool IndirectField::nearest(std::size_t pixel, int count, float* channels) const {
  const auto width = static_cast<std::size_t>(width_);
  const auto x = static_cast<float>(pixel % width), y = static_cast<float>(pixel / width);
  float distance = 2.0f * tile_size;
  const float* values = nullptr;
  for (const std::uint32_t i : tiles_[tile_of(pixel)].near) {
    const Node& node = nodes_[i];
    const float off = std::abs(node.x - x) + std::abs(node.y - y);
    if (off >= distance || !one_face(node.pixel, pixel)) continue;
    distance = off;
    values = node.lit ? &values_[3 * static_cast<std::size_t>(i) * channels_] : nullptr;
  }
  if (values) std::copy_n(values, count, channels);
  return values != nullptr;
}

/// A plane through the nodes around, the nearer the heavier. Where the light bends, such a mean errs by as much to one
/// side as the mean of what the nodes' own slopes foretell errs to the other: the middle of both is taken. A little
/// less of the slopes, for they do not know where the lit surface ends.
bool IndirectField::at(std::size_t pixel, int count, float* channels) const {
  std::fill(channels, channels + count, 0.0f);
  const std::vector<std::uint32_t>& near = tiles_[tile_of(pixel)].near;
  if (near.empty() || std::isnan(view_.depth[pixel])) return false;
  const auto width = static_cast<std::size_t>(width_);
  const auto x = static_cast<float>(pixel % width), y = static_cast<float>(pixel / width);
  struct Used {
    std::uint32_t node;
    float weight, x, y;
  };
  thread_local std::vector<Used> used;
  used.clear();
  float m = 0.0f, mx = 0.0f, my = 0.0f, mxx = 0.0f, mxy = 0.0f, myy = 0.0f;
  bool lit = false;
  for (const std::uint32_t i : near) {
    const Node& node = nodes_[i];
    const float u = node.x - x, v = node.y - y;
    const float weight =
        std::max(0.0f, 1.0f - std::abs(u) / node.reach) * std::max(0.0f, 1.0f - std::abs(v) / node.reach);
    if (weight <= 0.0f || !one_face(node.pixel, pixel)) continue;
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
    const float *const value = &values_[3 * static_cast<std::size_t>(u.node) * channels_],
                       *const right = value + channels_, *const down = right + channels_;
    for (int c = 0; c < std::min(count, growing_); ++c) {
      channels[c] += weight * (value[c] - foretold * (u.x * right[c] + u.y * down[c]));
    }
    for (int c = growing_; c < count; ++c) channels[c] += weight * value[c];
  }
  return true;
}

}  // namespace bin_scenes
