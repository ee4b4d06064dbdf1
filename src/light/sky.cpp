/// Reads Radiance files, and draws a direction by two searches: in the sums of the rows, then in those of one row.
#include "light/sky.hpp"

#include "bin_scenes/core/error.hpp"
#include "core/read_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <sstream>

namespace bin_scenes {

namespace {

constexpr int most_columns = 4096, most_rows = 2048;
constexpr std::size_t most_unused = 4;  ///< panoramas that are kept although nobody uses them, 100 MB each

Error no_panorama(const std::string& problem, const std::string& path) {
  return input_error(problem, path, "save it as Radiance RGBE (.hdr), twice as wide as high, at most 4096 x 2048");
}

/// Bytes of a Radiance file (Ward, "Real pixels", Graphics gems II, 1991).
class RgbeReader {
 public:
  explicit RgbeReader(const std::string& path) : path_(path) {
    try {
      bytes_ = read_file(path);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) throw;
      throw no_panorama(error.problem(), path);
    }
  }

  Panorama read() {
    if (bytes_.compare(0, 2, "#?") != 0) throw no_panorama("is no Radiance picture", path_);
    line();
    bool known = false;
    for (std::string text = line(); !text.empty(); text = line()) known |= text == "FORMAT=32-bit_rle_rgbe";
    if (!known) throw no_panorama("does not say FORMAT=32-bit_rle_rgbe", path_);
    Panorama out;
    std::istringstream size(line());
    std::string y, x;
    size >> y >> out.height >> x >> out.width;
    if (!size || y != "-Y" || x != "+X") throw no_panorama("has no resolution '-Y height +X width'", path_);
    if (out.width != 2 * out.height || out.width > most_columns || out.height > most_rows || out.height < 1)
      throw no_panorama("has " + std::to_string(out.width) + " x " + std::to_string(out.height) + " pixels", path_);
    out.radiance.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int row = 0; row < out.height; ++row)
      read_row(&out.radiance[static_cast<std::size_t>(row * out.width)], static_cast<std::size_t>(out.width));
    return out;
  }

 private:
  using Pixel = std::array<std::uint8_t, 4>;

  std::uint8_t byte() {
    if (at_ == bytes_.size()) throw no_panorama("ends before its last row", path_);
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }
  std::string line() {
    std::string text;
    for (std::uint8_t c = byte(); c != '\n'; c = byte()) text += static_cast<char>(c);
    return text;
  }
  void read_row(Eigen::Array3f* to, std::size_t width) {
    pixels_.resize(width);
    for (std::uint8_t& c : pixels_[0]) c = byte();
    const Pixel& first = pixels_[0];
    const std::size_t stated = first[2] * std::size_t{256} + first[3];
    if (first[0] == 2 && first[1] == 2 && stated == width && width >= 8) {
      for (std::size_t channel = 0; channel < 4; ++channel) read_runs(channel);
    } else {
      for (std::size_t i = 1; i < width; ++i)
        for (std::uint8_t& c : pixels_[i]) c = byte();
    }
    for (std::size_t i = 0; i < width; ++i) {
      const Pixel& p = pixels_[i];
      if (p[0] == 1 && p[1] == 1 && p[2] == 1) throw no_panorama("has runs of an old kind", path_);
      to[i] = Eigen::Array3f(p[0], p[1], p[2]) * (p[3] == 0 ? 0.0f : std::ldexp(1.0f, p[3] - 136));
    }
  }
  void read_runs(std::size_t channel) {
    for (std::size_t i = 0; i < pixels_.size();) {
      const std::uint8_t code = byte();
      const std::size_t count = code > 128 ? code - 128u : code;
      if (count == 0 || i + count > pixels_.size()) throw no_panorama("has a run beyond its row", path_);
      const std::uint8_t same = code > 128 ? byte() : std::uint8_t{0};
      for (std::size_t k = 0; k < count; ++k) pixels_[i++][channel] = code > 128 ? same : byte();
    }
  }

  std::string path_, bytes_;
  std::size_t at_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace

std::shared_ptr<const Panorama> read_panorama(const std::string& path) {
  namespace fs = std::filesystem;
  struct Known {
    std::uintmax_t bytes;
    fs::file_time_type changed;
    std::weak_ptr<const Panorama> panorama;
  };
  static std::mutex mutex;
  static std::map<std::string, Known> all;
  static std::deque<std::shared_ptr<const Panorama>> last;
  const std::lock_guard<std::mutex> lock(mutex);
  std::error_code ignored;
  const std::uintmax_t bytes = fs::file_size(path, ignored);
  const fs::file_time_type changed = fs::last_write_time(path, ignored);
  Known& known = all[path];
  std::shared_ptr<const Panorama> panorama = known.panorama.lock();
  if (!panorama || known.bytes != bytes || known.changed != changed) {
    panorama = std::make_shared<const Panorama>(RgbeReader(path).read());
    known = {bytes, changed, panorama};
  }
  if (std::find(last.begin(), last.end(), panorama) == last.end()) last.push_back(panorama);
  if (last.size() > most_unused) last.pop_front();
  return panorama;
}

Sky::Sky(std::shared_ptr<const Panorama> picture, const Eigen::Array3d& scale, double turn)
    : picture_(std::move(picture)), scale_(scale), turn_(turn) {
  const auto width = static_cast<std::size_t>(picture_->width);
  double all = 0.0;
  for (std::size_t i = 0; i < picture_->radiance.size();) {
    double row = 0.0;
    for (std::size_t x = 0; x < width; ++x, ++i) columns_.push_back(row += flux_of(i));
    rows_.push_back(all += row);
  }
}

double Sky::solid_angle(std::size_t row) const {
  const double step = M_PI / picture_->height, top = static_cast<double>(row) * step;
  return 2.0 * M_PI / picture_->width * (std::cos(top) - std::cos(top + step));
}

double Sky::flux_of(std::size_t pixel) const {
  const double mean = (scale_ * picture_->radiance[pixel].cast<double>()).mean();
  return mean * solid_angle(pixel / static_cast<std::size_t>(picture_->width));
}

std::size_t Sky::pixel_of(const Vec3& direction) const {
  const double down = std::acos(std::clamp(direction.z(), -1.0, 1.0)) / M_PI;
  double across = 0.5 - (std::atan2(direction.y(), direction.x()) - turn_) / (2.0 * M_PI);
  across -= std::floor(across);
  const int row = std::min(static_cast<int>(down * picture_->height), picture_->height - 1);
  const int column = std::min(static_cast<int>(across * picture_->width), picture_->width - 1);
  return static_cast<std::size_t>(row * picture_->width + column);
}

Eigen::Array3d Sky::at(const Vec3& direction) const {
  return scale_ * picture_->radiance[pixel_of(direction)].cast<double>();
}

double Sky::density(const Vec3& direction) const {
  const std::size_t pixel = pixel_of(direction);
  const std::size_t row = pixel / static_cast<std::size_t>(picture_->width);
  return flux() > 0.0 ? flux_of(pixel) / (flux() * solid_angle(row)) : 0.0;
}

Sky::Sample Sky::sample(double u, double v) const {
  const auto width = static_cast<std::size_t>(picture_->width);
  /// The place of a share of a sum: in which part of it, and how far.
  const auto place = [](const double* sums, std::size_t count, double share) {
    const double sum = share * sums[count - 1];
    const auto i = std::min(static_cast<std::size_t>(std::upper_bound(sums, sums + count, sum) - sums), count - 1);
    const double before = i == 0 ? 0.0 : sums[i - 1], own = sums[i] - before;
    return std::make_pair(i, own > 0.0 ? (sum - before) / own : 0.5);
  };
  const auto [row, down] = place(rows_.data(), rows_.size(), v);
  const auto [column, across] = place(&columns_[row * width], width, u);
  const double step = M_PI / picture_->height, top = static_cast<double>(row) * step;
  const double z = std::cos(top) + down * (std::cos(top + step) - std::cos(top));
  const double turn = turn_ + 2.0 * M_PI * (0.5 - (static_cast<double>(column) + across) / picture_->width);
  const double flat = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double density = flux() > 0.0 ? flux_of(row * width + column) / (flux() * solid_angle(row)) : 0.0;
  return {Vec3(flat * std::cos(turn), flat * std::sin(turn), z), density};
}

}  // namespace bin_scenes
