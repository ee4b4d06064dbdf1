/// Depth errors of structured light in a V-groove, whose faces light each other, by albedo, period and bounces.
#include "framework/benchmark.hpp"

#include "sensor/groove_device.hpp"
#include "sensor/shot.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bench {
namespace {

/// Errors of pixels whose face lies at least so far from the line, across it.
struct Errors {
  double rms = 0.0, largest = 0.0;  ///< of the phase, as depth (m): fringes are not told apart
  double valid = 0.0, other = 0.0;  ///< shares of pixels: valid, and read in another fringe
  double seen = 0.0;                ///< pixels
};

Errors errors_of(const View& view, const Measurement& measured, const StructuredLight::Setup& setup, double least) {
  const Triangulation triangle(setup.projector, setup.projector_pose);
  const auto width = static_cast<std::size_t>(view.lens.width);
  Errors out;
  for (std::size_t i = 0; i < view.depth.size(); ++i) {
    const Vec3 ray = view.lens.ray(static_cast<double>(i % width), static_cast<double>(i / width));
    if (!(std::abs(view.depth[i] * ray.x()) >= least)) continue;
    out.seen += 1.0;
    if (measured.validity[i] != Validity::valid) continue;
    out.valid += 1.0;
    const auto column = [&](double depth) {
      return setup.projector.project(setup.projector_pose.inverse() * (depth * ray))->x();
    };
    const double off = column(measured.depth[i]) - column(view.depth[i]);
    const double in_period = std::remainder(off, setup.settings.period);
    if (std::abs(off - in_period) > 0.5 * setup.settings.period) out.other += 1.0;
    const double error = std::abs(in_period) * triangle.depth_per_column(ray, view.depth[i]);
    out.rms += error * error;
    out.largest = std::max(out.largest, error);
  }
  out.rms = std::sqrt(out.rms / out.valid);
  out.valid /= out.seen;
  out.other /= out.seen;
  return out;
}

void groove_row(Run& out, const std::string& name, const Surface& surface, double period, int bounces, bool decoded) {
  const Row key =
      Row::keys("surface", name, "period_px", period, "bounces", bounces, "fidelity", decoded ? "decoded" : "analytic");
  if (!out.wanted(key)) return;
  Targets targets = test::groove(surface, 0.75, 0.057, 0.3);
  StructuredLight::Setup setup = test::groove_device(period, bounces);
  setup.noise = false;
  const auto [view, measured, sigma] = test::shoot<StructuredLight>(targets, test::groove_camera(), setup, decoded);
  const Errors all = errors_of(view, measured, setup, 0.0), apart = errors_of(view, measured, setup, 0.0045);
  out.row(Row(key)
              .exact("rms_mm", 1e3 * all.rms)
              .exact("largest_mm", 1e3 * all.largest)
              .exact("rms_apart_mm", 1e3 * apart.rms)
              .exact("largest_apart_mm", 1e3 * apart.largest)
              .exact("valid_percent", 100.0 * all.valid)
              .exact("other_fringe_percent", 100.0 * all.other)
              .info("pixels", all.seen));
}

void run(Run& out) {
  const Surface bright{0.9, 0.0, 0.4}, dark{0.45, 0.0, 0.4}, satin{0.8, 0.7, 0.4}, shiny{0.8, 0.9, 0.3};
  for (const double period : {16.0, 64.0}) {
    for (const int bounces : {0, 1, 2}) groove_row(out, "matte, albedo 0.9", bright, period, bounces, false);
    groove_row(out, "matte, albedo 0.9", bright, period, 1, true);
    groove_row(out, "matte, albedo 0.45", dark, period, 1, false);
  }
  groove_row(out, "albedo 0.8, gloss 0.7, roughness 0.4", satin, 16.0, 1, false);
  groove_row(out, "albedo 0.8, gloss 0.9, roughness 0.3", shiny, 16.0, 1, false);
}

const Registration registration{"light",
                                "structured light in a V-groove",
                                {"surface", "period_px", "bounces", "fidelity"},
                                run,
                                "src/light src/raster src/sensor"};

}  // namespace
}  // namespace bin_scenes::bench
