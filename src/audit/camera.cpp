/// Labels of all images of a set: what they have in common is an error of the camera, what is left one of a part.
#include "audit/auditor.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <set>

namespace bin_scenes {

namespace {

/// Views of one camera: same files, same K, same size.
using Cameras = std::map<std::pair<std::string, std::array<double, 9>>, std::vector<std::size_t>>;

Cameras cameras_of(const BopSet& set, const AuditFigures& figures) {
  Cameras cameras;
  for (const auto& [number, image] : figures.images) {
    const BopView& view = set.views[number];
    const std::string size = std::to_string(image.width) + " x " + std::to_string(image.height);
    cameras[{size + view.suffix, view.k}].push_back(number);
  }
  return cameras;
}

std::vector<ShiftSample> shifts_of(const LabelledImage& image) {
  std::vector<ShiftSample> samples;
  for (const LabelFigures& part : image.parts)
    if (part.shift) samples.push_back({part.at, *part.shift});
  return samples;
}

std::vector<DepthSample> depths_of(const LabelledImage& image) {
  std::vector<DepthSample> samples;
  for (const LabelFigures& part : image.parts)
    if (part.depth) samples.push_back({*part.depth, part.model_depth, part.obliqueness});
  return samples;
}

constexpr std::size_t least_parts = 4;  ///< of an image that state an error of its own

/// The error of an image: that of its camera, and what all of its parts are off by beside it.
CameraError of_image(const LabelledImage& image, CameraError error, const std::array<double, 9>& k) {
  std::vector<double> x, y;
  for (const ShiftSample& sample : shifts_of(image)) {
    const Eigen::Vector2d left = sample.shift - error.at(sample.at, k);
    x.push_back(left.x());
    y.push_back(left.y());
  }
  if (x.size() >= least_parts) error.shift += Eigen::Vector2d(median_of(x), median_of(y));
  return error;
}

/// " cx +2.00 px" where it is not nothing.
void add_term(std::string& text, const char* name, double value, const char* unit, double least) {
  if (std::abs(value) >= least) text += formatted("%s %s %+.2f%s", text.empty() ? "" : ",", name, value, unit);
}

std::string camera_text(const std::string& camera, const CameraError& error, std::size_t parts,
                        const std::array<double, 9>& k) {
  const std::string text =
      formatted("K of the images of %s (fx %.6g, cx %.6g, cy %.6g) does not fit %zu masks, which say:", camera.c_str(),
                k[0], k[2], k[5], parts);
  std::string terms;
  add_term(terms, "cx", error.shift.x(), " px", 0.05);
  add_term(terms, "cy", error.shift.y(), " px", 0.05);
  add_term(terms, "fx", 100.0 * error.scale.x(), " %", 0.01);
  add_term(terms, "fy", 100.0 * error.scale.y(), " %", 0.01);
  add_term(terms, "k1", error.radial, "", 0.005);
  const Eigen::Vector2d half = error.shift.cwiseAbs();
  if (half.minCoeff() > 0.4 && half.maxCoeff() < 0.6) terms += "; half a pixel is where pixel centres are counted";
  return text + terms;
}

std::string depth_text(const std::string& camera, const DepthError& error, std::size_t parts) {
  if (std::abs(error.distance - 1.0) < 0.1)
    return "the depth images of " + camera + " hold distances from the camera, not depths along its axis";
  return formatted("the depth images of %s do not fit %zu parts: %+.2f mm, %+.3f %% (depth_scale)", camera.c_str(),
                   parts, error.offset, 100.0 * error.scale);
}

/// mm, standard deviation of the parts' depths about what they have in common: noise of the sensor that averaging over
/// a part does not remove. It is no larger than the noise of the pixels; what is, are poses that err.
double depth_noise(const LabelledImage& image) {
  std::vector<double> sizes, spreads;
  for (const LabelFigures& part : image.parts) {
    if (!part.depth) continue;
    sizes.push_back(std::abs(*part.depth));
    spreads.push_back(part.depth_spread);
  }
  return sizes.size() >= least_parts ? std::min(1.4826 * median_of(sizes), median_of(spreads)) : 0.0;
}

/// mm that noise, at three standard deviations, does not explain.
double beyond_noise(const LabelFigures& part, double noise) {
  return std::max(0.0, std::abs(*part.depth) - 3.0 * std::hypot(noise, part.depth_error));
}

}  // namespace

void Auditor::audit_labels(AuditFigures& figures, const std::function<void(double)>& progress) {
  SensorRig rig;
  const LabelAuditor auditor(set_, models_, rig);
  double done = 0.0;
  const double images = static_cast<double>(std::max<std::size_t>(1, around_.size()));
  for (const auto& [number, around] : around_) {
    figures.images[number] = auditor.compare(set_.views[number], around, {});
    progress(0.5 * ++done / images);
  }
  for (const auto& [camera, views] : cameras_of(set_, figures)) {
    const std::array<double, 9>& k = camera.second;
    std::vector<ShiftSample> shifts;
    for (const std::size_t number : views)
      for (const ShiftSample& sample : shifts_of(figures.images[number])) shifts.push_back(sample);
    const CameraError common = fit_camera(shifts, k).value_or(CameraError());
    const LabelledImage& first = figures.images[views.front()];
    if (common.largest(first.width, first.height, k) > figures.camera.limit)
      figures.faults.push_back(camera_text(camera.first, common, shifts.size(), k));
    for (const std::size_t number : views) {
      correct_camera(number, of_image(figures.images[number], common, k), auditor, figures);
      progress(0.5 + 0.5 * (++done - images) / images);
    }
    correct_depth(camera.first, views, figures);
  }
  for (const auto& [number, image] : figures.images) add_labels(number, image, figures);
}

void Auditor::correct_camera(std::size_t number, const CameraError& error, const LabelAuditor& auditor,
                             AuditFigures& figures) const {
  constexpr double negligible = 0.3;  // px; masks need not be compared anew
  LabelledImage& image = figures.images[number];
  if (image.width == 0) return;
  const BopView& view = set_.views[number];
  const double largest = error.largest(image.width, image.height, view.k);
  if (!shifts_of(image).empty()) figures.camera.add(largest, {number, AuditPlace::image});
  if (largest > negligible) {
    image = auditor.compare(view, around_.at(number), error);
  } else {
    for (LabelFigures& part : image.parts)
      if (part.shift) *part.shift -= error.at(part.at, view.k);
  }
  image.camera = error;
}

void Auditor::correct_depth(const std::string& camera, const std::vector<std::size_t>& views,
                            AuditFigures& figures) const {
  std::vector<DepthSample> samples;
  for (const std::size_t number : views)
    for (const DepthSample& sample : depths_of(figures.images[number])) samples.push_back(sample);
  const DepthError common = fit_depth(samples).value_or(DepthError());
  std::vector<double> all;
  for (const DepthSample& sample : samples) all.push_back(std::abs(common.of(sample)));
  if (median_of(all) > figures.depth_common.limit) figures.faults.push_back(depth_text(camera, common, samples.size()));
  for (const std::size_t number : views) {
    LabelledImage& image = figures.images[number];
    std::vector<double> left, stated;
    for (const DepthSample& sample : depths_of(image)) {
      left.push_back(sample.error - common.of(sample));
      stated.push_back(sample.error);
    }
    if (left.empty()) continue;
    const double of_image = left.size() >= least_parts ? median_of(left) : 0.0;
    image.depth_offset = left.size() >= least_parts ? median_of(stated) : 0.0;
    figures.depth_common.add(std::abs(image.depth_offset), {number, AuditPlace::image});
    for (LabelFigures& part : image.parts)
      if (part.depth) *part.depth -= common.of({*part.depth, part.model_depth, part.obliqueness}) + of_image;
  }
}

void Auditor::add_labels(std::size_t number, const LabelledImage& image, AuditFigures& figures) {
  const double noise = depth_noise(image);
  for (std::size_t i = 0; i < image.parts.size(); ++i) {
    const LabelFigures& part = image.parts[i];
    const AuditPlace place{number, i};
    if (part.iou) figures.mask.add(1.0 - *part.iou, place);
    if (part.iou_visible) figures.mask_visible.add(1.0 - *part.iou_visible, place);
    if (part.shift) figures.shift.add(part.shift->norm(), place);
    if (part.depth) figures.depth.add(beyond_noise(part, noise), place);
    if (part.counted) figures.counted.add(*part.counted, place);
    if (part.visible) figures.visible.add(std::abs(*part.visible), place);
  }
}

}  // namespace bin_scenes
