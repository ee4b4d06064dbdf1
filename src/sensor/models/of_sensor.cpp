#include "sensor/models/of_sensor.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "core/in_parallel.hpp"
#include "sensor/models/exposure.hpp"

#include <algorithm>
#include <utility>

namespace bin_scenes {

const Names<MixedPixels> mixed_pixels{{"remove", MixedPixels::remove}, {"keep", MixedPixels::keep}};

void check_baseline(const std::string& key, double baseline) {
  if (baseline == 0.0)
    throw input_error("is 0, so that nothing can be measured by triangulation", key,
                      "give a baseline, usually 0.1 to 0.3 m");
}

IndirectField::Setup indirect_of(const Sensor& sensor) {
  return {sensor.bounces.value_or(sensor_model(sensor.model).bounces), sensor.indirect_samples};
}

Random random_of(const Draw& draw) {
  return Random(draw.seed, draw.scene, Stream::noise).of_piece(draw.sensor);
}

Random rays_of(const Draw& draw) {
  return Random(draw.seed, draw.scene, Stream::sensor).of_piece(draw.sensor);
}

void add_truth(RangeImage& image, View&& view) {
  image.truth_depth.resize(view.depth.size());
  const auto width = static_cast<std::size_t>(view.lens.width);
  in_parallel(static_cast<std::size_t>(view.lens.height),
              [&](std::size_t row) { std::copy_n(&view.depth[row * width], width, &image.truth_depth[row * width]); });
  image.truth_label = std::move(view.label);
}

RangeImage image_of(View&& view, Measurement&& measured) {
  RangeImage image;
  image.width = view.lens.width;
  image.height = view.lens.height;
  image.intensity = std::move(measured.intensity);
  image.snr = std::move(measured.snr);
  const std::size_t pixels = view.depth.size();
  BIN_SCENES_ASSERT(measured.depth.size() == pixels && measured.validity.size() == pixels);
  image.depth.resize(pixels);
  image.label.resize(pixels);
  image.normal = std::move(view.normal);
  image.validity.resize(pixels);
  add_truth(image, std::move(view));
  const auto width = static_cast<std::size_t>(image.width);
  in_parallel(static_cast<std::size_t>(image.height), [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      const bool valid = measured.validity[i] == Validity::valid;
      image.validity[i] = static_cast<std::uint8_t>(measured.validity[i]);
      image.depth[i] = static_cast<float>(measured.depth[i]);
      image.label[i] = valid ? image.truth_label[i] : std::uint16_t{0};
    }
  });
  return image;
}

RangeImage image_with_gray(View&& view, Measurement&& measured, const Sensor& sensor, bool noise, const Draw& draw) {
  constexpr std::uint64_t piece = std::uint64_t{1} << 60;  // behind those of the models
  const int width = view.lens.width;
  if (!draw.gray) return image_of(std::move(view), std::move(measured));
  std::vector<std::uint8_t> gray = exposed_for_parts(std::move(measured.light), view.label, width,
                                                     Imager(sensor.imager, noise), random_of(draw).of_piece(piece));
  RangeImage image = image_of(std::move(view), std::move(measured));
  image.gray = std::move(gray);
  return image;
}

namespace {

Targets plate_of(const Pose& camera, double distance, double incidence, double albedo) {
  Targets targets;
  const Quat turn = camera.orientation * Quat(Eigen::AngleAxisd(incidence, Vec3::UnitX()));
  const double size = 20.0 * distance;
  targets.add(box_target({size, size, 0.01 * size}),
              {camera * Vec3(0, 0, distance) + turn * Vec3(0, 0, 0.005 * size), turn}, {albedo, 0.0, 0.4});
  return targets;
}

}  // namespace

Plate::Plate(const Sensor& sensor, double distance, double incidence, double albedo)
    : targets(plate_of(*sensor.pose, distance, incidence, albedo)),
      scenery(targets.scenery()),
      surfaces(targets.surfaces()),
      sensor_(sensor) {}

View Plate::seen_at_center() const {
  Sensor cut = sensor_;
  const int left = (sensor_.width - 9) / 2, top = (sensor_.height - 9) / 2;
  cut.width = cut.height = 9;
  cut.k[2] -= left;
  cut.k[5] -= top;
  return render(scenery, lens_of(cut), *cut.pose, cut.near, cut.far);
}

}  // namespace bin_scenes
