/// Finds the pixels of some rows that see more than one face or light; structured_light_cells.cpp has their cells.
/// Rows are done in strips, so that memory does not grow with the image.
#include "sensor/models/structured_light_strip.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr double least_step = 2e-6;  // m; below it two faces are one, whatever the noise

/// Share of a normal distribution below x.
double below(double x, double sigma) {
  return 0.5 * std::erfc(-x / sigma * M_SQRT1_2);
}

bool same(const Surface& a, const Surface& b) {
  return a.albedo == b.albedo && a.gloss == b.gloss && a.roughness == b.roughness && a.refraction == b.refraction &&
         a.extinction == b.extinction;
}

}  // namespace

StructuredLight::Strip::Strip(const StructuredLight& model, int first, int last)
    : model_(model),
      width_(model.view_.lens.width),
      height_(model.view_.lens.height),
      reach_(static_cast<int>(std::ceil(3.0 * model.setup_.imager.blur))),
      first_(first),
      last_(last),
      top_(std::max(0, first - reach_)),
      bottom_(std::min(height_, last + reach_)),
      origin_(static_cast<std::size_t>(top_) * width_) {
  for (int k = 0; k < per_pixel; ++k) {
    across_[k] = static_cast<float>(cells::across(k));
    down_[k] = static_cast<float>(cells::down(k));
  }
  const double blur = model.setup_.imager.blur;
  double sum = 0.0;
  const auto seen = [&](double at) { return blur > 0.0 ? below(at + 0.5, blur) - below(at - 0.5, blur) : 1.0; };
  for (int v = -reach_; v <= reach_; ++v) {
    for (int u = -reach_; u <= reach_; ++u) {
      weights_.emplace_back();
      for (int k = 0; k < per_pixel; ++k) {
        const double weight = seen(u + cells::across(k)) * seen(v + cells::down(k));
        weights_.back()[k] = static_cast<float>(weight);
        sum += weight;
      }
    }
  }
  for (Values& w : weights_) {
    w /= static_cast<float>(sum);
    shares_.push_back(w.sum());
  }

  const std::size_t pixels = static_cast<std::size_t>(bottom_ - top_) * width_;
  near_.assign(pixels, 0);
  cells_of_.assign(pixels, -1);
  const std::vector<Uneven> uneven = uneven_pixels();
  if (uneven.empty()) return;
  std::vector<const Uneven*> crossed;
  std::vector<char> needed(pixels, 0);
  for (const Uneven& pixel : uneven) {
    const int x = static_cast<int>(pixel.index % width_), y = static_cast<int>(pixel.index / width_);
    if (y >= top_ && y < bottom_) {  // beside an edge, cells are those of the pixel's face
      if (pixel.kind == Kind::bent) add_bent(pixel);
      if (pixel.kind == Kind::mixed) add_mixed(pixel);
      if (pixel.kind == Kind::crossed) crossed.push_back(&pixel);
    }
    for (int v = std::max(top_, y - 2 * reach_); v <= std::min(bottom_ - 1, y + 2 * reach_); ++v) {
      for (int u = std::max(0, x - 2 * reach_); u <= std::min(width_ - 1, x + 2 * reach_); ++u) {
        const std::size_t at = static_cast<std::size_t>(v) * width_ + u - origin_;
        needed[at] = 1;
        if (std::abs(u - x) <= reach_ && std::abs(v - y) <= reach_) near_[at] = 1;
      }
    }
  }
  cells_.reserve(cells_.size() + static_cast<std::size_t>(std::count(needed.begin(), needed.end(), 1)));
  add_crossed(crossed);
  for (std::size_t at = 0; at < pixels; ++at) {
    if (needed[at] && cells_of_[at] < 0 && model_.codes_[origin_ + at] != Validity::nothing) add_flat(origin_ + at);
  }
}

/// Whether two pixels are lit differently or have different surfaces.
bool StructuredLight::Strip::differ(std::size_t a, std::size_t b) const {
  if (model_.codes_[a] != model_.codes_[b]) return true;
  if (!model_.worn_.empty() && model_.worn_[a] != model_.worn_[b]) return true;
  const std::int32_t one = model_.view_.line[a], other = model_.view_.line[b];
  return one != other && !same(model_.surfaces_.of(one), model_.surfaces_.of(other));
}

/// Whether a neighbour is lit differently, sees nothing or has another surface.
bool StructuredLight::Strip::differs(int x, int y) const {
  const std::size_t own = static_cast<std::size_t>(y) * width_ + x;
  for (int v = std::max(0, y - 1); v <= std::min(height_ - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(width_ - 1, x + 1); ++u) {
      if (differ(own, static_cast<std::size_t>(v) * width_ + u)) return true;
    }
  }
  return false;
}

/// By how much a neighbour lies off the plane of this pixel's face (m); 0 if by less than least_step.
double StructuredLight::Strip::hidden_step(const Pixel& pixel) const {
  const Lens& lens = model_.view_.lens;
  const int x = static_cast<int>(pixel.index % width_), y = static_cast<int>(pixel.index / width_);
  const double facing = pixel.normal.dot(pixel.ray);
  const double across = pixel.normal.x() / lens.fx, down = pixel.normal.y() / lens.fy;
  double largest = 0.0;
  for (int v = std::max(0, y - 1); v <= std::min(height_ - 1, y + 1); ++v) {
    const double* const depth = &model_.view_.depth[static_cast<std::size_t>(v) * width_];
    for (int u = std::max(0, x - 1); u <= std::min(width_ - 1, x + 1); ++u) {
      const double here = std::abs(facing + across * (u - x) + down * (v - y));
      const double off = std::abs(depth[u] * (facing + across * (u - x) + down * (v - y)) - pixel.plane);
      if (off > least_step * here) largest = std::max(largest, off / here);
    }
  }
  return largest;
}

/// What noise hides is even.
StructuredLight::Strip::Kind StructuredLight::Strip::kind_of(const Pixel& pixel, const Seen* corners) const {
  const Lens& lens = model_.view_.lens;
  const Validity code = model_.codes_[pixel.index];
  double tolerance = least_step;
  if (code == Validity::valid) {
    tolerance = std::max(tolerance, 0.5 * model_.depth_sigma(pixel, model_.fringe(pixel)));
  }
  const Surface& own = model_.surfaces_.of(model_.view_.line[pixel.index]);
  Kind kind = Kind::even;
  for (int k = 0; k < 4; ++k) {
    const double u = cells::across(cells::corners[k]), v = cells::down(cells::corners[k]);
    const double here = pixel.normal.dot(pixel.ray + Vec3(u / lens.fx, v / lens.fy, 0.0));
    const double off = std::abs(corners[k].depth - pixel.plane / here);
    const bool other = corners[k].lit.code != code || !same(own, model_.surfaces_.of(corners[k].line)) ||
                       corners[k].diffuse != model_.diffuse(pixel.index);
    // A sixteenth of the pixel is enough to be mixed, and of what is removed nobody asks how much.
    const bool removed = reach_ == 0 && model_.setup_.settings.mixed == MixedPixels::remove;
    if (!(off < model_.setup_.settings.edge_step)) return removed ? Kind::mixed : Kind::crossed;
    if (other) kind = Kind::crossed;
    if (off > tolerance && kind == Kind::even) kind = Kind::bent;
  }
  return kind;
}

/// Of some rows: whether each pixel and its neighbours show one face in the same light. That spares most of them more.
std::vector<char> StructuredLight::Strip::uniform(int first, int last) const {
  const int top = std::max(0, first - 1), bottom = std::min(height_, last + 1);
  const auto at = [&](int y, int x) {
    return static_cast<std::size_t>(y - top) * width_ + static_cast<std::size_t>(x);
  };
  std::vector<char> across(at(bottom, 0), 1), down = across, all(static_cast<std::size_t>(last - first) * width_, 0);
  for (int y = top; y < bottom; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * width_;
    alike(row, row + 1, width_ - 1, &across[at(y, 0)]);
    if (y + 1 < bottom) alike(row, row + static_cast<std::size_t>(width_), width_, &down[at(y, 0)]);
  }
  for (int y = first; y < last; ++y) {
    const char* const own = &across[at(y, 0)];
    const char* const above = y > top ? own - width_ : own;
    const char* const below = y + 1 < bottom ? own + width_ : own;
    const char* const to_below = &down[at(y, 0)];
    const char* const to_above = y > top ? to_below - width_ : to_below;
    char* const same = &all[static_cast<std::size_t>(y - first) * width_];
    for (int x = 0; x < width_; ++x) {
      same[x] = static_cast<char>(own[x] & above[x] & below[x] & to_below[x] & to_above[x]);
      if (x > 0) same[x] = static_cast<char>(same[x] & own[x - 1] & above[x - 1] & below[x - 1]);
    }
  }
  return all;
}

/// Whether two pixels see one plane of one surface, lit alike; for `count` pairs.
void StructuredLight::Strip::alike(std::size_t a, std::size_t b, int count, char* out) const {
  const Validity* const code = model_.codes_.data();
  const std::int32_t* const line = model_.view_.line.data();
  const std::array<float, 3>* const normal = model_.view_.normal.data();
  const double* const plane = model_.planes_.data();
  for (int x = 0; x < count; ++x, ++a, ++b) {
    const bool one_plane = std::abs(plane[a] - plane[b]) < 0.1 * least_step;
    out[x] =
        static_cast<char>(one_plane & (code[a] == code[b]) & (line[a] == line[b]) & (normal[a][0] == normal[b][0]) &
                          (normal[a][1] == normal[b][1]) & (normal[a][2] == normal[b][2]));
  }
  if (model_.worn_.empty()) return;
  a -= static_cast<std::size_t>(count), b -= static_cast<std::size_t>(count);
  for (int x = 0; x < count; ++x, ++a, ++b) out[x] = static_cast<char>(out[x] & (model_.worn_[a] == model_.worn_[b]));
}

std::vector<StructuredLight::Strip::Uneven> StructuredLight::Strip::uneven_pixels() const {
  std::vector<std::size_t> maybe;
  const double edge = model_.setup_.settings.edge_step;
  const int from = std::max(0, first_ - 2 * reach_), to = std::min(height_, last_ + 2 * reach_);
  const std::vector<char> plain = uniform(from, to);
  for (int y = from; y < to; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (plain[static_cast<std::size_t>(y - from) * width_ + static_cast<std::size_t>(x)]) continue;
      const std::size_t index = static_cast<std::size_t>(y) * width_ + x;
      const Validity code = model_.codes_[index];
      if (code != Validity::valid && code != Validity::shadow) continue;
      if (differs(x, y)) {
        maybe.push_back(index);
        continue;
      }
      const Pixel pixel = model_.pixel(static_cast<std::size_t>(x), static_cast<std::size_t>(y));
      const double step = hidden_step(pixel);
      // Cells lie up to 3/8 of a pixel from the centre and see as much of the step to a neighbour.
      if (step >= edge ||
          (step > 0.0 && code == Validity::valid && step > 2.0 * model_.depth_sigma(pixel, model_.fringe(pixel)))) {
        maybe.push_back(index);
      }
    }
  }
  std::vector<Place> corners;
  for (const std::size_t index : maybe) {
    for (const int cell : cells::corners) corners.push_back({index, cell});
  }
  const std::vector<Seen> seen = cast(corners);
  std::vector<Uneven> uneven, even;
  for (std::size_t i = 0; i < maybe.size(); ++i) {
    const Pixel pixel = model_.pixel(maybe[i] % width_, maybe[i] / width_);
    const Seen* const own = &seen[4 * i];
    const Kind kind = kind_of(pixel, own);
    if (kind == Kind::even && reach_ == 0) continue;
    (kind == Kind::even ? even : uneven).push_back({maybe[i], kind, {own[0], own[1], own[2], own[3]}});
  }
  if (reach_ > 0) add_beside(from, to, even, uneven);
  return uneven;
}

/// An edge that runs between pixels crosses none of their cells, yet the blur brings light from its other side. Of
/// even pixels, those count whose neighbour across the edge is even, too.
void StructuredLight::Strip::add_beside(int from, int to, const std::vector<Uneven>& even,
                                        std::vector<Uneven>& uneven) const {
  const std::size_t origin = static_cast<std::size_t>(from) * width_;
  std::vector<char> crossed(static_cast<std::size_t>(to - from) * width_, 0);
  for (const Uneven& pixel : uneven) crossed[pixel.index - origin] = 1;
  for (const Uneven& pixel : even) {
    const int x = static_cast<int>(pixel.index % width_), y = static_cast<int>(pixel.index / width_);
    const auto edge_towards = [&](int u, int v) {
      if (u < 0 || u >= width_ || v < from || v >= to) return false;
      const std::size_t other = static_cast<std::size_t>(v) * width_ + u;
      return !crossed[other - origin] && edge_between(pixel.index, other);
    };
    if (!edge_towards(x - 1, y) && !edge_towards(x + 1, y) && !edge_towards(x, y - 1) && !edge_towards(x, y + 1))
      continue;
    uneven.push_back(pixel);
    uneven.back().kind = Kind::beside;
  }
}

/// Whether two pixels that both see something of the projector's field differ, or lie edge_step apart.
bool StructuredLight::Strip::edge_between(std::size_t a, std::size_t b) const {
  const Validity code = model_.codes_[b];
  if (code != Validity::valid && code != Validity::shadow) return false;
  if (differ(a, b)) return true;
  const Pixel own = model_.pixel(a % width_, a / width_);
  const double here = own.normal.dot(model_.rays_.at(b % width_, b / width_));
  return !(std::abs(model_.view_.depth[b] - own.plane / here) < model_.setup_.settings.edge_step);
}

/// Share of a neighbour's cells that lie off a pixel's face by edge_step or more.
float StructuredLight::Strip::off_face(const Pixel& pixel, int right, int down, const Cells& cells,
                                       const Values& weight) const {
  const Lens& lens = model_.view_.lens;
  const auto across = static_cast<float>(pixel.normal.x() / lens.fx),
             along = static_cast<float>(pixel.normal.y() / lens.fy);
  const auto center = static_cast<float>(pixel.normal.dot(pixel.ray)) + across * static_cast<float>(right) +
                      along * static_cast<float>(down);
  const auto plane = static_cast<float>(pixel.plane), step = static_cast<float>(model_.setup_.settings.edge_step);
  const Values here = center + across * across_ + along * down_;
  return ((cells.depth * here - plane).abs() < step * here.abs()).select(Values::Zero(), weight).sum();
}

}  // namespace bin_scenes
