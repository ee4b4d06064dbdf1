/// Structured light against its own formulas: errors on planes and balls, noise over the predicted sigma, and how sigma
/// grows with range, steps and baseline. Both fidelities are held against each other.
#include "sensors/rows.hpp"
#include "sensors/stage.hpp"

#include "bin_scenes/sensor/resolve.hpp"
#include "sensor/fit.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bench {
namespace {

const char* name_of(Fidelity fidelity) {
  return fidelity == Fidelity::decoded ? "decoded" : "analytic";
}

Sensor fringe_sensor(double distance, Fidelity fidelity, bool noise = true) {
  Sensor sensor = sensor_of("structured_light", distance);
  sensor.fidelity = fidelity;
  sensor.noise = noise;
  return sensor;
}

void plane_errors(Run& out, double z) {
  const Figure median{"decoded without noise: error on a plane, median", z, 20.0},
      p99{"decoded without noise: error on a plane, 99 %", z, 20.0};
  if (!out.wanted(median.key()) && !out.wanted(p99.key())) return;
  Targets targets = plate(z, 20.0, 0.5);
  const std::vector<double> errors = sorted_errors(shoot(targets, fringe_sensor(z, Fidelity::decoded, false), 0));
  const auto samples = static_cast<double>(errors.size());
  const bool goal = z == 1.0;
  out.row(row_of(median, 1e3 * quantile(errors, 0.5), "mm", goal ? "at most 0.02" : "").info("samples", samples));
  out.row(row_of(p99, 1e3 * quantile(errors, 0.99), "mm", goal ? "at most 0.1" : "").info("samples", samples));
}

void ball(Run& out, Fidelity fidelity, bool noise) {
  Figure figure{"radius of a ball of 100 mm, error"};
  figure.setting = std::string(name_of(fidelity)) + (noise ? ", default noise" : ", no noise");
  if (!out.wanted(figure.key())) return;
  Targets targets;
  targets.add(ball_target(0.1), {Vec3(0, 0, 1.0), Quat::Identity()});
  const Shot shot = shoot(targets, fringe_sensor(1.0, fidelity, noise), 1);
  std::vector<Vec3> points;
  const auto width = static_cast<std::size_t>(shot.view.lens.width);
  for (std::size_t i = 0; i < shot.sigma.size(); ++i) {
    if (shot.measured.validity[i] != Validity::valid) continue;
    points.push_back(shot.measured.depth[i] *
                     shot.view.lens.ray(static_cast<double>(i % width), static_cast<double>(i / width)));
  }
  out.row(row_of(figure, 1e3 * std::abs(fit_ball(points).radius - 0.1), "mm", noise ? "at most 0.05" : "at most 0.01")
              .info("samples", static_cast<double>(points.size())));
}

/// Root mean squares over all valid pixels.
struct Spread {
  double over_predicted = 0.0;  ///< error / predicted sigma
  double error = 0.0;           ///< m
  double samples = 0.0;
};
Spread spread_of(const Shot& shot) {
  Spread s;
  for (std::size_t i = 0; i < shot.sigma.size(); ++i) {
    if (shot.measured.validity[i] != Validity::valid) continue;
    const double error = shot.measured.depth[i] - shot.view.depth[i];
    s.over_predicted += std::pow(error / shot.sigma[i], 2);
    s.error += error * error;
    ++s.samples;
  }
  s.over_predicted = std::sqrt(s.over_predicted / s.samples);
  s.error = std::sqrt(s.error / s.samples);
  return s;
}

/// A row for each plate, and one for the ratio that lies farthest from 1, which says of which plate it is.
void noise_over_formula(Run& out, Fidelity fidelity) {
  Figure worst{"measured / predicted sigma, farthest from 1"};
  worst.setting = name_of(fidelity);
  std::string where;
  bool all = true;
  double ratio = 1.0;
  for (const double z : {0.5, 1.0, 2.0}) {
    for (const double degrees : {0.0, 40.0, 70.0}) {
      for (const double albedo : {0.05, 0.5, 0.9}) {
        if (out.quick() && (degrees == 40.0 || albedo == 0.5 || z != 1.0)) continue;
        const Figure figure{"measured / predicted sigma", z, degrees, albedo, name_of(fidelity)};
        if (!out.wanted(figure.key())) {
          all = false;
          continue;
        }
        Targets targets = plate(z, degrees, albedo);
        const Spread s = spread_of(shoot(targets, fringe_sensor(z, fidelity), 1));
        out.row(row_of(figure, s.over_predicted, "").info("samples", s.samples).info("sigma_mm", 1e3 * s.error));
        if (std::abs(s.over_predicted - 1.0) > std::abs(ratio - 1.0)) {
          ratio = s.over_predicted;
          where = Row::text(z) + " m, " + Row::text(degrees) + " degrees, albedo " + Row::text(albedo);
        }
      }
    }
  }
  if (all) out.row(row_of(worst, ratio, "", "0.97 to 1.03").info("at", where));
}

/// Axes in parallel and a wide projector: the plate lies in its field at every distance and for every baseline.
Sensor parallel_sensor(double distance, Fidelity fidelity) {
  Sensor sensor = fringe_sensor(distance, fidelity);
  sensor.projector.pose->orientation = Quat::Identity();
  sensor.projector.fov = 1.2;
  return sensor;
}

/// Exponent of the measured sigma over a setting, from its smallest to its largest value.
template <class Set>
void exponent(Run& out, const std::string& over, const std::vector<double>& values, double expected, const Set& set) {
  for (const Fidelity fidelity : {Fidelity::analytic, Fidelity::decoded}) {
    Figure figure{"sigma grows with " + over + ", exponent"};
    figure.setting = name_of(fidelity);
    if (!out.wanted(figure.key())) continue;
    std::vector<double> sigma;
    for (const double value : {values.front(), values.back()}) {
      double z = 1.0;
      const Sensor sensor = set(value, fidelity, z);
      Targets targets = plate(z, 0.0, 0.5);
      sigma.push_back(spread_of(shoot(targets, sensor, 1)).error);
    }
    const double power = std::log(sigma[1] / sigma[0]) / std::log(values.back() / values.front());
    const std::string goal = Row::text(expected - 0.02) + " to " + Row::text(expected + 0.02);
    out.row(row_of(figure, power, "", goal));
  }
}

void laws(Run& out) {
  exponent(out, "range 0.5 to 2 m", {0.5, 2.0}, 2.0, [](double value, Fidelity fidelity, double& z) {
    z = value;
    return parallel_sensor(z, fidelity);
  });
  exponent(out, "steps 4 to 32", {4, 32}, -0.5, [](double value, Fidelity fidelity, double&) {
    Sensor sensor = parallel_sensor(1.0, fidelity);
    sensor.settings.of<StructuredLightSettings>().steps = static_cast<int>(value);
    return sensor;
  });
  exponent(out, "baseline 0.05 to 0.2 m", {0.05, 0.2}, -1.0, [](double value, Fidelity fidelity, double&) {
    Sensor sensor = parallel_sensor(1.0, fidelity);
    sensor.projector.pose->position.x() = value;
    return sensor;
  });
}

/// Both fidelities on a ball, a block and a plate: how far errors are spread where both are valid, and the codes.
void agreement(Run& out, int width) {
  Figure rms{"analytic / decoded sigma on a still life, root mean square"},
      middle{"analytic / decoded sigma on a still life, median"},
      codes{"same validity, analytic and decoded, on a still life"};
  Sensor sensor = fringe_sensor(1.0, Fidelity::analytic);
  sensor.width = width;
  sensor.height = width * 3 / 4;
  sensor.k.clear();
  sensor = resolved(sensor, Request().bin);
  Sensor decoding = sensor;
  decoding.fidelity = Fidelity::decoded;
  rms.setting = middle.setting = codes.setting = std::to_string(width) + " x " + std::to_string(sensor.height);
  if (!out.wanted(rms.key()) && !out.wanted(middle.key()) && !out.wanted(codes.key())) return;
  Targets targets = still_life();
  const Shot a = shoot(targets, sensor, 1), d = shoot(targets, decoding, 1);
  std::vector<double> of_analytic, of_decoded;
  double square_a = 0.0, square_d = 0.0, same = 0.0;
  for (std::size_t i = 0; i < a.sigma.size(); ++i) {
    same += a.measured.validity[i] == d.measured.validity[i];
    if (a.measured.validity[i] != Validity::valid || d.measured.validity[i] != Validity::valid) continue;
    of_analytic.push_back(std::abs(a.measured.depth[i] - a.view.depth[i]));
    of_decoded.push_back(std::abs(d.measured.depth[i] - d.view.depth[i]));
    square_a += of_analytic.back() * of_analytic.back();
    square_d += of_decoded.back() * of_decoded.back();
  }
  std::sort(of_analytic.begin(), of_analytic.end());
  std::sort(of_decoded.begin(), of_decoded.end());
  const std::string goal = "0.9 to 1.1";
  out.row(row_of(rms, std::sqrt(square_a / square_d), "", goal)
              .info("samples", static_cast<double>(of_decoded.size()))
              .info("sigma_mm", 1e3 * std::sqrt(square_d / static_cast<double>(of_decoded.size()))));
  out.row(row_of(middle, quantile(of_analytic, 0.5) / quantile(of_decoded, 0.5), "", goal));
  out.row(row_of(codes, 100.0 * same / static_cast<double>(a.sigma.size()), "%", "at least 98"));
}

}  // namespace

void fringe_rows(Run& out) {
  for (const double z : {0.5, 1.0, 2.0}) plane_errors(out, z);
  for (const Fidelity fidelity : {Fidelity::analytic, Fidelity::decoded}) {
    for (const bool noise : {false, true}) ball(out, fidelity, noise);
    noise_over_formula(out, fidelity);
  }
  laws(out);
  for (const int width : {200, 640}) agreement(out, width);
}

}  // namespace bin_scenes::bench
