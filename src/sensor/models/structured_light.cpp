/// Light and column of every pixel, then its noise: by formula, or by images that are decoded. Pixels near edges are in
/// structured_light_strip.cpp.
#include "sensor/models/structured_light.hpp"

#include "core/in_parallel.hpp"
#include "sensor/models/imager.hpp"
#include "sensor/models/structured_light_strip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

/// Indirect over direct light from which on a Gray bit may be read wrong: half of it stands against half of the
/// direct light less the quarter of the amplitude that a bit has to pass.
constexpr double turns_bits = 0.7;

/// Adds what a fringe makes of a path: cosine and sine, and `all` channels further on their growth with each step.
void add_phasor_of(const Path& path, const Fringes& fringes, const Vec3* steps, int all, float* out) {
  const double turn = fringes.turn(), seen = path.weight * fringes.seen_through(path.spread, 0.0, 0.0);
  const double c = seen * std::cos(turn * path.column), s = seen * std::sin(turn * path.column);
  out[0] += static_cast<float>(c);
  out[1] += static_cast<float>(s);
  for (int axis = 0; axis < 2; ++axis) {
    float* const growth = out + (1 + axis) * all;
    const double step = path.slope.dot(steps[axis]);
    growth[0] -= static_cast<float>(turn * step * s);
    growth[1] += static_cast<float>(turn * step * c);
  }
}

}  // namespace

/// Normally distributed numbers, drawn in pairs.
class StructuredLight::Normals {
 public:
  explicit Normals(const Random& random) : random_(random) {}
  double next() {
    if (!spare_) random_.normals(first_, second_);
    spare_ = !spare_;
    return spare_ ? first_ : second_;
  }

 private:
  Random random_;
  double first_ = 0.0, second_ = 0.0;
  bool spare_ = false;
};

/// Of the second fringe by a stream of its own: what the filter leaves is as without it.
struct StructuredLight::Noise {
  Normals first, second;
};

StructuredLight::StructuredLight(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Setup& setup,
                                 const Random& random)
    : scenery_(scenery),
      view_(view),
      surfaces_(surfaces),
      setup_(setup),
      fringes_(setup.settings, setup.projector.width),
      second_(second_fringe(setup)),
      imager_(setup.imager, setup.noise),
      triangulation_(setup.projector, view.pose.inverse() * setup.projector_pose),
      rays_(view.lens),
      sight_(scenery, setup.projector, setup.projector_pose),
      spots_(scenery, view.lens, view.pose, setup.near, setup.far),
      shades_(scenery, setup.projector, setup.projector_pose, 0.0, std::numeric_limits<double>::infinity()),
      turn_(view.pose.orientation.toRotationMatrix()),
      codes_(view.depth.size()),
      columns_(view.depth.size()),
      whites_(view.depth.size()),
      planes_(view.depth.size()),
      worn_(surfaces.vary() ? view.depth.size() : 0) {
  constexpr std::size_t rows = 8;  // points enough to draw what occludes them
  const auto height = static_cast<std::size_t>(view_.lens.height);
  in_parallel((height + rows - 1) / rows,
              [&](std::size_t k) { light_rows(k * rows, std::min((k + 1) * rows, height)); });
  for (const double exposure : setup.imager.exposures)
    scales_.insert(scales_.begin(), exposure / setup.imager.exposure);
  if (scales_.empty()) scales_ = {1.0};
  gain_ = gain();
  if (setup.indirect.bounces == 0) return;
  const ProjectorLamp lamp(scenery, setup.projector, setup.projector_pose, surfaces);
  const int all = channels() + images();
  const IndirectField::Pattern pattern{
      all, setup.only_analytic ? channels() : all,
      [this](const std::vector<Path>& paths, const Vec3* steps, float* out) { add_paths(paths, steps, out); },
      mean_white()};
  indirect_ =
      std::make_unique<const IndirectField>(LitScene{scenery, surfaces, lamp}, view, setup.indirect, pattern, random);
}

/// Of the pixels that the projector lights.
double StructuredLight::mean_white() const {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < whites_.size(); ++i) {
    if (codes_[i] != Validity::valid) continue;
    sum += whites_[i];
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// None: reflections are not filtered.
std::unique_ptr<const Fringes> StructuredLight::second_fringe(const Setup& setup) {
  if (setup.reflection.step == 0.0) return nullptr;
  return std::make_unique<const Fringes>(
      Fringes::without_code(setup.settings, setup.reflection.period, setup.projector.width));
}

/// Light of all images at a column.
void StructuredLight::add_light(double column, double white, float* images) const {
  fringes_.add_light(column, white, images);
  if (second_) second_->add_light(column, white, images + fringes_.images());
}

void StructuredLight::add_even_light(const Path& path, double column, double weight, float* images) const {
  fringes_.add_even_light(column, path.spread, weight, images);
  if (second_) second_->add_even_light(column, path.spread, weight, images + fringes_.images());
}

/// Fringes as a sum of phasors, Gray bits as sums of lit and dark. Each path stands for all columns of its sample.
void StructuredLight::add_paths(const std::vector<Path>& paths, const Vec3* steps, float* out) const {
  const int all = channels() + images();
  for (const Path& path : paths) {
    out[white] += static_cast<float>(path.weight);
    add_phasor_of(path, fringes_, steps, all, out + cosine);
    if (second_) add_phasor_of(path, *second_, steps, all, out + second_cosine);
    add_even_light(path, path.column, path.weight, out + channels());
    if (setup_.only_analytic) continue;
    for (int axis = 0; axis < 2; ++axis) {
      float* const growth = out + (1 + axis) * all + channels();
      const double step = path.slope.dot(steps[axis]);
      add_even_light(path, path.column + 0.5 * step, path.weight, growth);
      add_even_light(path, path.column - 0.5 * step, -path.weight, growth);
    }
  }
}

/// @param first, last  rows, last + 1
void StructuredLight::light_rows(std::size_t first, std::size_t last) {
  const auto width = static_cast<std::size_t>(view_.lens.width);
  const std::size_t origin = first * width, count = (last - first) * width;
  std::vector<SeenPoint> points(count);
  std::vector<Lit> lit(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = origin + k;
    const Pixel p = pixel(k % width, first + k / width);
    planes_[i] = view_.depth[i] * p.normal.dot(p.ray);
    if (std::isnan(view_.depth[i])) continue;
    const Vec3 point = view_.pose.position + turn_ * (view_.depth[i] * p.ray);
    points[k] = {point, turn_ * p.normal, view_.line[i], true, view_.label[i], view_.face[i]};
  }
  light(source(), view_.pose.position, points.data(), lit.data(), count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = origin + k;
    codes_[i] = lit[k].code;
    columns_[i] = lit[k].column;
    whites_[i] = lit[k].reflected / std::max(lit[k].distance * lit[k].distance, 1e-12);
    Surface own;
    if (!worn_.empty() && points[k].hit)
      worn_[i] = diffuse_share(surfaces_.at(points[k].line, points[k].label, points[k].position, own));
  }
}

/// The automatic exposure looks at a grid of pixels: some ten thousand give the median distance as well as all do.
double StructuredLight::gain() const {
  constexpr double enough = 16384;
  const auto width = static_cast<std::size_t>(view_.lens.width), height = static_cast<std::size_t>(view_.lens.height);
  const auto step = static_cast<std::size_t>(std::max(1.0, std::sqrt(static_cast<double>(width * height) / enough)));
  std::vector<Lit> lit;
  std::vector<double> depths;
  for (std::size_t y = step / 2; y < height; y += step) {
    for (std::size_t x = step / 2; x < width; x += step) {
      const std::size_t i = y * width + x;
      lit.emplace_back();
      lit.back().code = codes_[i];
      lit.back().distance =
          (setup_.projector_pose.position - (view_.pose.position + turn_ * (view_.depth[i] * rays_.at(x, y)))).norm();
      depths.push_back(view_.depth[i]);
    }
  }
  return gain_of(setup_.imager, lit, depths, (view_.pose.inverse() * setup_.projector_pose.position).z());
}

StructuredLight::Pixel StructuredLight::pixel(std::size_t column, std::size_t row) const {
  Pixel p;
  p.index = row * static_cast<std::size_t>(view_.lens.width) + column;
  p.ray = rays_.at(column, row);
  const auto& n = view_.normal[p.index];
  p.normal = {n[0], n[1], n[2]};
  p.plane = planes_[p.index];
  return p;
}

/// Columns of the projector passed on a pixel's face from it to the next one, across and down.
StructuredLight::Vec2 StructuredLight::slope(const Pixel& pixel) const {
  return triangulation_.slope(pixel.ray, view_.depth[pixel.index], pixel.normal, view_.lens);
}

/// Share of ambient light sent back.
double StructuredLight::diffuse(std::size_t index) const {
  return worn_.empty() ? diffuse_share(surfaces_.of(view_.line[index])) : worn_[index];
}

double StructuredLight::ambient(std::size_t index) const {
  return setup_.imager.ambient * diffuse(index);
}

/// Of direct light.
double StructuredLight::amplitude(const Pixel& pixel, const Fringes& fringes) const {
  const double white = gain_ * whites_[pixel.index];
  const Vec2 passed = slope(pixel);
  return white * fringes.amplitude() * fringes.seen_through(passed.x(), passed.y(), setup_.imager.blur);
}

StructuredLight::Fringe StructuredLight::fringe(const Pixel& pixel) const {
  return {ambient(pixel.index) + gain_ * whites_[pixel.index] * fringes_.mean(), amplitude(pixel, fringes_)};
}

/// Light of the grey image at a pixel's centre while the projector shows white.
double StructuredLight::white_light(std::size_t index, const float* indirect) const {
  return ambient(index) + gain_ * (whites_[index] + indirect[white]);
}

/// Replaces direct and ambient light of the pixel's centre by those of the whole pixel.
void StructuredLight::blend_white_light(const Blend& blend, std::size_t index, Measurement& out) const {
  if (!setup_.gray) return;
  out.light[index] += static_cast<float>(setup_.imager.ambient * blend.diffuse - ambient(index) +
                                         gain_ * (blend.white - whites_[index]));
}

double StructuredLight::depth_sigma(std::size_t index) const {
  if (codes_[index] != Validity::valid) return std::numeric_limits<double>::quiet_NaN();
  const auto width = static_cast<std::size_t>(view_.lens.width);
  const Pixel p = pixel(index % width, index / width);
  return depth_sigma(p, fringe(p));
}

/// Whether the brightest of a fringe's images saturates.
bool StructuredLight::saturates(const Fringe& f, double column) const {
  if (!imager_.saturated(f.mean + f.amplitude)) return false;  // spares most pixels the cosine
  return imager_.saturated(f.mean + f.amplitude * fringes_.brightest(column));
}

/// The longest exposure of a fringe that does not saturate, else the shortest.
double StructuredLight::scale_for(const Fringe& f, double column) const {
  if (scales_.size() == 1) return scales_.back();
  for (const double scale : scales_) {
    if (!saturates({scale * f.mean, scale * f.amplitude}, column)) return scale;
  }
  return scales_.back();
}

double StructuredLight::depth_sigma(const Pixel& pixel, const Fringe& f) const {
  const double scale = scale_for(f, columns_[pixel.index]);
  return triangulation_.depth_per_column(pixel.ray, view_.depth[pixel.index]) *
         fringes_.column_sigma(std::sqrt(imager_.variance(scale * f.mean)), scale * f.amplitude);
}

void StructuredLight::deliver(Measurement& out, const Pixel& pixel, double column) const {
  const double z = triangulation_.depth(pixel.ray, column);
  const bool good = z >= setup_.near && z <= setup_.far;
  out.validity[pixel.index] = good ? Validity::valid : Validity::decoding;
  if (good) out.depth[pixel.index] = z;
}

/// Takes a pixel away whose second fringe gives another depth, or is too weak to give one.
void StructuredLight::take_reflection(Measurement& out, const Pixel& pixel, double column, double second) const {
  Validity& validity = out.validity[pixel.index];
  if (validity != Validity::valid) return;
  double& depth = out.depth[pixel.index];
  const double off = std::abs(std::remainder(second - column, setup_.reflection.period));
  if (off * triangulation_.depth_per_column(pixel.ray, depth) <= setup_.reflection.step) return;
  validity = Validity::reflection;
  depth = std::numeric_limits<double>::quiet_NaN();
}

/// Adds the indirect light to a fringe and moves the column that is read.
/// @param indirect  cosine, sine
void StructuredLight::add_phasor(const Fringes& fringes, const float* indirect, double& column,
                                 double& amplitude) const {
  const double turn = fringes.turn(), scale = gain_ * fringes.amplitude();
  const double c = amplitude * std::cos(turn * column) + scale * indirect[0],
               s = amplitude * std::sin(turn * column) + scale * indirect[1];
  const double error = std::remainder(std::atan2(s, c) - turn * column, 2.0 * M_PI);
  column += error / turn;
  amplitude = std::hypot(c, s);
}

/// Whether no noise lifts a fringe of indirect light alone over the threshold.
bool StructuredLight::too_dark(const float* indirect) const {
  const double scale = scales_.front();
  const double mean = scale * (setup_.imager.ambient + gain_ * indirect[white] * fringes_.mean());
  const double amplitude = scale * gain_ * fringes_.amplitude() * std::hypot(indirect[cosine], indirect[sine]);
  return amplitude + 6.0 * fringes_.amplitude_sigma(std::sqrt(imager_.variance(mean))) < setup_.settings.min_modulation;
}

/// The light of a pixel near an edge. False: it is decided already what becomes of the pixel.
bool StructuredLight::blended(const Strip& strip, const Pixel& pixel, Received& got, Measurement& out) const {
  const Blend blend = strip.blend(pixel, [](const Strip::Cells&, const Strip::Values&) {});
  blend_white_light(blend, pixel.index, out);
  if (blend.outside) out.validity[pixel.index] = Validity::outside;
  if (blend.outside || (codes_[pixel.index] == Validity::shadow && blend.white <= 0.0)) return false;
  got.mixed = blend.off_share > Blend::tolerated && setup_.settings.mixed == MixedPixels::remove;
  const double period = setup_.settings.period, turn = 2.0 * M_PI / period;
  const double phase = std::atan2(blend.sine, blend.cosine) / turn;
  got.column = phase + period * std::round((blend.column - phase) / period);
  got.fringe = {setup_.imager.ambient * blend.diffuse + gain_ * blend.white * fringes_.mean(),
                gain_ * fringes_.amplitude() * std::hypot(blend.sine, blend.cosine)};
  if (!second_) return true;
  got.second_column = std::atan2(blend.second_sine, blend.second_cosine) / second_->turn();
  got.second_amplitude = gain_ * second_->amplitude() * std::hypot(blend.second_sine, blend.second_cosine);
  return true;
}

/// The noise of what is received, and what is reported of the pixel.
void StructuredLight::report(const Pixel& pixel, const Received& got, Noise& noise, Measurement& out) const {
  Validity& validity = out.validity[pixel.index];
  out.intensity[pixel.index] = static_cast<float>(std::min(got.fringe.mean, 1.0));
  const double scale = scale_for(got.fringe, got.column);
  const Fringe f{scale * got.fringe.mean, scale * got.fringe.amplitude};
  const double sigma = std::sqrt(imager_.variance(f.mean)), of_phase = setup_.noise ? noise.first.next() : 0.0;
  // The amplitude's noise matters where it may fall below the threshold.
  double amplitude = f.amplitude;
  const double spread = fringes_.amplitude_sigma(sigma);
  out.snr[pixel.index] = static_cast<float>(f.amplitude / spread);
  if (setup_.noise && std::abs(amplitude - setup_.settings.min_modulation) < 6.0 * spread)
    amplitude += spread * noise.first.next();
  if (got.mixed) {
    validity = Validity::mixed;
  } else if (saturates(f, got.column)) {
    validity = Validity::saturated;
  } else if (amplitude < setup_.settings.min_modulation) {
    validity = codes_[pixel.index] == Validity::shadow ? Validity::shadow : Validity::dark;
  } else {
    const double column = got.column + fringes_.column_sigma(sigma, f.amplitude) * of_phase;
    deliver(out, pixel, column);
    if (!second_) return;
    double second = got.second_column;
    if (setup_.noise) second += second_->column_sigma(sigma, scale * got.second_amplitude) * noise.second.next();
    take_reflection(out, pixel, column, second);
  }
}

void StructuredLight::measure_row(const Strip& strip, std::size_t row, const Random& random, Measurement& out) const {
  const auto width = static_cast<std::size_t>(view_.lens.width);
  std::vector<float> images(static_cast<std::size_t>(this->images()));
  Noise noise{Normals(random.of_piece(row)), Normals(random.of_piece(2 * view_.depth.size() + row))};
  for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
    const Validity code = out.validity[i] = codes_[i];
    const bool near_edge = strip.near_edge(i);
    float indirect[most_channels] = {};
    const bool twice = indirect_ && indirect_->at(i, channels(), indirect);
    if (setup_.gray) out.light[i] = static_cast<float>(white_light(i, indirect));
    if (code != Validity::valid && !(code == Validity::shadow && near_edge) && !twice) continue;
    const Pixel p = pixel(i - row * width, row);
    if (twice && code != Validity::valid && !near_edge && too_dark(indirect)) {
      out.intensity[i] = static_cast<float>(std::min(ambient(i) + gain_ * indirect[white] * fringes_.mean(), 1.0));
      continue;
    }
    if (twice && (code != Validity::valid || indirect[white] > turns_bits * whites_[i])) {
      Random draw = random.of_piece(view_.depth.size() + i);
      read(strip, p, images, draw, out);
      continue;
    }
    Received got;
    if (!near_edge) {
      got = {columns_[i], fringe(p)};
      if (second_) got.second_column = columns_[i], got.second_amplitude = amplitude(p, *second_);
    } else if (!blended(strip, p, got, out)) {
      continue;
    }
    if (twice) {
      got.fringe.mean += gain_ * indirect[white] * fringes_.mean();
      add_phasor(fringes_, indirect + cosine, got.column, got.fringe.amplitude);
      if (second_) add_phasor(*second_, indirect + second_cosine, got.second_column, got.second_amplitude);
    }
    report(p, got, noise, out);
  }
}

Measurement StructuredLight::analytic(const Random& random) const {
  Measurement out(view_.depth.size());
  if (setup_.gray) out.light.resize(view_.depth.size());
  in_strips([&](const Strip& strip, int first, int last) {
    for (int row = first; row < last; ++row) measure_row(strip, static_cast<std::size_t>(row), random, out);
  });
  return out;
}

}  // namespace bin_scenes
