#include "grasp/eye.hpp"

#include "bin_scenes/sensor/resolve.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

Eye::Eye(const RangeImage& image)
    : image_(image),
      lens_(lens_of(image.true_sensor())),
      into_camera_(image.true_sensor().pose.value_or(Pose()).inverse()),
      measures_(image.depth.size() == image.seen_depth().size() && image.label.size() == image.depth.size()) {}

void Eye::look(const Grasp& grasp, SceneGrasp& placed) const {
  std::size_t seen = 0, measured = 0;
  const auto label = static_cast<std::uint16_t>(placed.part + 1);
  for (const Vec3& contact : grasp.contacts) {
    const Vec3 point = into_camera_ * (placed.pose * contact);
    const auto pixel = point.z() > 0.0 ? lens_.project(point) : std::nullopt;
    if (!pixel || !lens_.inside(*pixel)) continue;
    const auto column = std::clamp(static_cast<int>(std::lround(pixel->x())), 0, lens_.width - 1);
    const auto row = std::clamp(static_cast<int>(std::lround(pixel->y())), 0, lens_.height - 1);
    const auto at =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(lens_.width) + static_cast<std::size_t>(column);
    // A pixel stores the depth at its centre; the point may be elsewhere in the pixel, on a slope.
    const double within = 5e-4 + 3.0 * point.z() / lens_.fx;
    if (image_.seen_label()[at] != label || !(std::abs(image_.seen_depth()[at] - point.z()) < within)) continue;
    ++seen;
    measured += measures_ && image_.label[at] == label && std::isfinite(image_.depth[at]);
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, grasp.contacts.size()));
  placed.visible.push_back(static_cast<double>(seen) / count);
  placed.measured.push_back(static_cast<double>(measured) / count);
}

}  // namespace bin_scenes
