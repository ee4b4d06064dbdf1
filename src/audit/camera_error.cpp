/// Robust fits of what all labels of a camera have in common: errors of K, and of depth.
#include "audit/camera_error.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// The size that a share of the residuals does not exceed.
double quantile_of(const Eigen::VectorXd& residuals, double share) {
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < residuals.size(); ++i) sizes.push_back(std::abs(residuals[i]));
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

double spread_of(const Eigen::VectorXd& residuals, double least) {
  return std::max(least, 1.4826 * quantile_of(residuals, 0.5));
}

/// Tukey's biweight, for 95 % efficiency under normal errors.
constexpr double cutoff = 4.685;

double weight(double residual, double spread) {
  const double u = residual / (cutoff * spread);
  return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
}

double loss(double residual, double spread) {
  const double u = std::min(1.0, std::abs(residual / (cutoff * spread))), v = 1.0 - u * u;
  return cutoff * cutoff / 6.0 * (1.0 - v * v * v);
}

/// `start` has the parameters of the first columns. The spread begins as wide as two thirds of the residuals: where
/// most of them are zero, as in the centre of a distorted image, the others must not count as wrong before they are
/// fitted.
Eigen::VectorXd robust_fit(const Eigen::MatrixXd& rows, const Eigen::VectorXd& values, const Eigen::VectorXd& start,
                           double least) {
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(rows.cols());
  parameters.head(start.size()) = start;
  double widest = quantile_of(values - rows * parameters, 2.0 / 3.0);
  for (int step = 0; step < 40; ++step, widest *= 0.7) {
    const Eigen::VectorXd residuals = values - rows * parameters;
    const double spread = std::max(spread_of(residuals, least), widest);
    Eigen::MatrixXd weighted = rows;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) weighted.row(i) *= weight(residuals[i], spread);
    const Eigen::VectorXd next = (rows.transpose() * weighted).ldlt().solve(weighted.transpose() * values);
    if (!next.allFinite()) break;
    const double change = (next - parameters).norm();
    parameters = next;
    if (change < 1e-9 && widest < least) break;
  }
  return parameters;
}

/// Adds columns only where they explain the values far better, by the loss at the spread of the larger model.
Eigen::VectorXd chosen(const Eigen::MatrixXd& rows, const Eigen::VectorXd& values, const Eigen::VectorXd& start,
                       const std::vector<Eigen::Index>& sizes, double least) {
  constexpr double worth = 25.0;  // half a chi-square of 50: never by chance
  Eigen::VectorXd best = robust_fit(rows.leftCols(start.size()), values, start, least);
  for (const Eigen::Index size : sizes) {
    const Eigen::VectorXd larger = robust_fit(rows.leftCols(size), values, best, least);
    const Eigen::VectorXd after = values - rows.leftCols(size) * larger;
    const Eigen::VectorXd before = values - rows.leftCols(best.size()) * best;
    const double spread = spread_of(after, least);
    double gain = 0.0;
    for (Eigen::Index i = 0; i < values.size(); ++i) gain += loss(before[i], spread) - loss(after[i], spread);
    if (gain > worth) best = larger;
  }
  return best;
}

}  // namespace

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto center = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), center, values.end());
  return *center;
}

Eigen::Vector2d CameraError::at(const Eigen::Vector2d& at, const std::array<double, 9>& k) const {
  const Eigen::Vector2d from_center(at.x() - k[2], at.y() - k[5]);
  const double x = from_center.x() / k[0], y = from_center.y() / k[4], squared = x * x + y * y;
  return shift + (scale + Eigen::Vector2d::Constant(radial * squared)).cwiseProduct(from_center);
}

double CameraError::largest(int width, int height, const std::array<double, 9>& k) const {
  double most = 0.0;
  for (const double x : {0.0, 0.5 * width, width - 1.0})
    for (const double y : {0.0, 0.5 * height, height - 1.0}) most = std::max(most, at({x, y}, k).norm());
  return most;
}

std::array<double, 9> CameraError::corrected(std::array<double, 9> k) const {
  k[0] *= 1.0 + scale.x();
  k[4] *= 1.0 + scale.y();
  k[2] += shift.x();
  k[5] += shift.y();
  return k;
}

std::optional<CameraError> fit_camera(const std::vector<ShiftSample>& samples, const std::array<double, 9>& k) {
  constexpr double least_spread = 0.03;  // px, of shifts that are exact
  const auto count = static_cast<Eigen::Index>(samples.size());
  if (count < 4) return std::nullopt;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * count, 5);  // shift x, y; scale x, y; radial
  Eigen::VectorXd values(2 * count);
  std::vector<double> x_shifts, y_shifts;
  for (Eigen::Index i = 0; i < count; ++i) {
    const ShiftSample& sample = samples[static_cast<std::size_t>(i)];
    const double u = sample.at.x() - k[2], v = sample.at.y() - k[5];
    const double squared = u * u / (k[0] * k[0]) + v * v / (k[4] * k[4]);
    rows.row(2 * i) << 1.0, 0.0, u, 0.0, u * squared;
    rows.row(2 * i + 1) << 0.0, 1.0, 0.0, v, v * squared;
    values[2 * i] = sample.shift.x();
    values[2 * i + 1] = sample.shift.y();
    x_shifts.push_back(sample.shift.x());
    y_shifts.push_back(sample.shift.y());
  }
  const Eigen::VectorXd units = Eigen::VectorXd(rows.cwiseAbs().colwise().maxCoeff()).cwiseMax(1e-12);
  const Eigen::MatrixXd scaled = rows * units.cwiseInverse().asDiagonal();
  std::vector<Eigen::Index> sizes;
  if (count >= 10) sizes.push_back(4);
  if (count >= 20) sizes.push_back(5);
  const Eigen::Vector2d start(median_of(x_shifts), median_of(y_shifts));
  Eigen::VectorXd found = Eigen::VectorXd::Zero(5);
  const Eigen::VectorXd best = chosen(scaled, values, start, sizes, least_spread);
  found.head(best.size()) = best;
  found = found.cwiseQuotient(units);
  return CameraError{found.head<2>(), found.segment<2>(2), found[4]};
}

std::optional<DepthError> fit_depth(const std::vector<DepthSample>& samples) {
  constexpr double least_spread = 0.02;  // mm
  const auto count = static_cast<Eigen::Index>(samples.size());
  if (count < 4) return std::nullopt;
  Eigen::MatrixXd rows(count, 3);  // offset; scale; distance
  Eigen::VectorXd values(count);
  std::vector<double> errors;
  for (Eigen::Index i = 0; i < count; ++i) {
    const DepthSample& sample = samples[static_cast<std::size_t>(i)];
    rows.row(i) << 1.0, sample.depth, sample.depth * sample.obliqueness;
    values[i] = sample.error;
    errors.push_back(sample.error);
  }
  const Eigen::VectorXd units = Eigen::VectorXd(rows.cwiseAbs().colwise().maxCoeff()).cwiseMax(1e-12);
  const Eigen::MatrixXd scaled = rows * units.cwiseInverse().asDiagonal();
  std::vector<Eigen::Index> sizes;
  if (count >= 10) sizes.push_back(2);
  if (count >= 20) sizes.push_back(3);
  Eigen::VectorXd found = Eigen::VectorXd::Zero(3);
  const Eigen::VectorXd best =
      chosen(scaled, values, Eigen::VectorXd::Constant(1, median_of(errors)), sizes, least_spread);
  found.head(best.size()) = best;
  found = found.cwiseQuotient(units);
  return DepthError{found[0], found[1] / 1e3, found[2] / 1e3};
}

}  // namespace bin_scenes
