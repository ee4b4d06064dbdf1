#include "core/in_parallel.hpp"
#include "sensor/models/structured_light_strip.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bin_scenes {

/// Light of one face: three columns that have the mean, variance and fourth moment of those that the footprint covers.
void StructuredLight::add_face(const Pixel& pixel, float* images) const {
  const Vec2 passed = slope(pixel);
  const double blur = setup_.imager.blur, x = passed.x() * passed.x(), y = passed.y() * passed.y();
  const double variance = (x + y) * (1.0 / 12.0 + blur * blur);
  // A box lacks 1/120 of a normal distribution's fourth moment; a normal distribution's is 3 variance^2.
  const double fourth = 3.0 * variance * variance - (x * x + y * y) / 120.0;
  const double white = gain_ * whites_[pixel.index], column = columns_[pixel.index];
  if (!(variance > 0.0)) {
    add_light(column, white, images);
    return;
  }
  const double reach = std::sqrt(fourth / variance), share = 0.5 * variance * variance / fourth;
  add_light(column - reach, share * white, images);
  add_light(column, (1.0 - 2.0 * share) * white, images);
  add_light(column + reach, share * white, images);
}

/// Takes the images by the longest exposure that saturates in no fringe, else by the shortest. Returns whether a fringe
/// saturates.
bool StructuredLight::expose(const std::vector<float>& images, Random& draw, std::vector<float>& shot,
                             float& scale) const {
  bool saturated = true;
  for (std::size_t k = 0; k < scales_.size() && saturated; ++k) {
    scale = static_cast<float>(scales_[k]);
    shot.assign(images.begin(), images.end());
    for (float& signal : shot) signal *= scale;
    imager_.expose(shot.data(), static_cast<std::size_t>(fringes_.images()), draw);
    saturated = imager_.saturated(*std::max_element(shot.begin(), shot.begin() + setup_.settings.steps));
  }
  return saturated;
}

/// Makes the images of a pixel and reads them as a device does.
void StructuredLight::read(const Strip& strip, const Pixel& p, std::vector<float>& images, Random& draw,
                           Measurement& out) const {
  const std::size_t i = p.index;
  const Validity code = out.validity[i] = codes_[i];
  const bool near_edge = strip.near_edge(i);
  thread_local std::vector<float> indirect;
  indirect.resize(static_cast<std::size_t>(channels()) + images.size());
  const bool twice = indirect_ && indirect_->at(i, static_cast<int>(indirect.size()), indirect.data());
  if (!twice) indirect[white] = 0.0f;
  if (setup_.gray) out.light[i] = static_cast<float>(white_light(i, indirect.data()));
  if (code != Validity::valid && !(code == Validity::shadow && near_edge) && !twice) return;
  std::fill(images.begin(), images.end(), 0.0f);
  double background = ambient(i);
  bool mixed = false;
  if (near_edge) {
    thread_local std::vector<float> columns, whites;
    columns.clear(), whites.clear();
    const Blend blend = strip.blend(p, [&](const Strip::Cells& cells, const Strip::Values& weight) {
      for (int k = 0; k < Strip::per_pixel; ++k) {
        const auto white = static_cast<float>(gain_ * weight[k] * cells.white[k]);
        if (white > 0.0f) columns.push_back(cells.column[k]), whites.push_back(white);
      }
    });
    fringes_.add_light(columns, whites, images.data());
    if (second_) second_->add_light(columns, whites, images.data() + fringes_.images());
    blend_white_light(blend, i, out);
    if (blend.outside) out.validity[i] = Validity::outside;
    if (blend.outside || (code == Validity::shadow && blend.white <= 0.0 && !twice)) return;
    mixed = blend.off_share > Blend::tolerated && setup_.settings.mixed == MixedPixels::remove;
    background = setup_.imager.ambient * blend.diffuse;
  } else if (code == Validity::valid) {
    add_face(p, images.data());
  }
  for (std::size_t n = 0; n < images.size(); ++n) {
    if (twice) images[n] += static_cast<float>(gain_) * indirect[channels() + n];
    images[n] += static_cast<float>(background);
  }
  thread_local std::vector<float> shot;
  float scale = 1.0f;
  const bool saturated = expose(images, draw, shot, scale);
  const float sum = std::accumulate(shot.begin(), shot.begin() + setup_.settings.steps, 0.0f);
  const float mean = sum / static_cast<float>(setup_.settings.steps);
  out.intensity[i] = std::min(1.0f, mean / scale);
  const Fringes::Reading reading = fringes_.read(shot.data());
  out.snr[i] = static_cast<float>(reading.modulation / fringes_.amplitude_sigma(std::sqrt(imager_.variance(mean))));
  if (mixed) {
    out.validity[i] = Validity::mixed;
  } else if (saturated) {
    out.validity[i] = Validity::saturated;
  } else if (reading.modulation < setup_.settings.min_modulation) {
    out.validity[i] = code == Validity::valid ? Validity::dark : code;
  } else if (std::isnan(reading.column)) {
    out.validity[i] = Validity::decoding;
  } else {
    deliver(out, p, reading.column);
    if (!second_) return;
    float* const more = shot.data() + fringes_.images();
    Random own = draw.of_piece(i);
    imager_.expose(more, static_cast<std::size_t>(second_->images()), own);
    take_reflection(out, p, reading.column, second_->column_of(second_->phase(more)));
  }
}

Measurement StructuredLight::decoded(const Random& random) const {
  Measurement out(view_.depth.size());
  if (setup_.gray) out.light.resize(view_.depth.size());
  in_strips([&](const Strip& strip, int first, int last) {
    std::vector<float> images(static_cast<std::size_t>(this->images()));
    for (int row = first; row < last; ++row) {
      Random draw = random.of_piece(static_cast<std::size_t>(row));
      for (int x = 0; x < view_.lens.width; ++x) {
        read(strip, pixel(static_cast<std::size_t>(x), static_cast<std::size_t>(row)), images, draw, out);
      }
    }
  });
  return out;
}

}  // namespace bin_scenes
