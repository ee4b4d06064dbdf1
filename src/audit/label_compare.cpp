/// Overlap and sub-pixel shift of two masks.
#include "audit/label_compare.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// A rectangle of an image, in pixels; the right and lower ends do not belong to it.
struct Window {
  int left = 1 << 30, top = 1 << 30, right = 0, bottom = 0;
  bool empty() const { return right <= left || bottom <= top; }
  int width() const { return right - left; }
  int height() const { return bottom - top; }
  void extend(const BinaryImage& image) {
    std::size_t i = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x, ++i) {
        if (!image.inside[i]) continue;
        left = std::min(left, x), right = std::max(right, x + 1);
        top = std::min(top, y), bottom = std::max(bottom, y + 1);
      }
  }
  Window grown(int margin, int width, int height) const {
    return {std::max(0, left - margin), std::max(0, top - margin), std::min(width, right + margin),
            std::min(height, bottom + margin)};
  }
};

/// Floats of a window.
struct Patch {
  int width = 0, height = 0;
  std::vector<float> value;
  Patch(int columns, int rows)
      : width(columns), height(rows), value(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0f) {}
  float& at(int x, int y) { return value[index(x, y)]; }
  float at(int x, int y) const { return value[index(x, y)]; }
  /// Between pixels; the outermost pixels go on beyond the window.
  float between(double x, double y) const {
    const double u = std::clamp(x, 0.0, width - 1.001), v = std::clamp(y, 0.0, height - 1.001);
    const int column = static_cast<int>(u), row = static_cast<int>(v);
    const auto s = static_cast<float>(u - column), t = static_cast<float>(v - row);
    return (1.0f - t) * ((1.0f - s) * at(column, row) + s * at(column + 1, row)) +
           t * ((1.0f - s) * at(column, row + 1) + s * at(column + 1, row + 1));
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

Patch cut(const BinaryImage& image, const Window& window) {
  Patch patch(window.width(), window.height());
  for (int y = 0; y < patch.height; ++y)
    for (int x = 0; x < patch.width; ++x) patch.at(x, y) = image.at(window.left + x, window.top + y) ? 1.0f : 0.0f;
  return patch;
}

/// The mean of 3 x 3 pixels, three times: nearly a Gaussian of 1.4 px.
void smooth(Patch& patch) {
  Patch rows(patch.width, patch.height);
  const auto mean = [](const Patch& from, int x, int y, int dx, int dy) {
    float sum = 0.0f;
    for (int k = -1; k <= 1; ++k)
      sum += from.at(std::clamp(x + k * dx, 0, from.width - 1), std::clamp(y + k * dy, 0, from.height - 1));
    return sum / 3.0f;
  };
  for (int pass = 0; pass < 3; ++pass) {
    for (int y = 0; y < patch.height; ++y)
      for (int x = 0; x < patch.width; ++x) rows.at(x, y) = mean(patch, x, y, 1, 0);
    for (int y = 0; y < patch.height; ++y)
      for (int x = 0; x < patch.width; ++x) patch.at(x, y) = mean(rows, x, y, 0, 1);
  }
}

/// 1 where pixels are compared: inside the image by more than smoothing reaches, and away from what is hidden.
Patch weights(const BinaryImage& hidden, const Window& window, int width, int height) {
  constexpr int reach = 3;
  Patch weight(window.width(), window.height());
  for (int y = 0; y < weight.height; ++y) {
    for (int x = 0; x < weight.width; ++x) {
      const int column = window.left + x, row = window.top + y;
      bool compared = column >= reach && row >= reach && column < width - reach && row < height - reach;
      for (int dy = -reach; compared && !hidden.inside.empty() && dy <= reach; ++dy)
        for (int dx = -reach; compared && dx <= reach; ++dx) compared = !hidden.at(column + dx, row + dy);
      weight.at(x, y) = compared ? 1.0f : 0.0f;
    }
  }
  return weight;
}

Eigen::Vector2d centroid(const Patch& patch) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (int y = 0; y < patch.height; ++y)
    for (int x = 0; x < patch.width; ++x) {
      sum += static_cast<double>(patch.at(x, y)) * Eigen::Vector2d(x, y);
      count += static_cast<double>(patch.at(x, y));
    }
  return count > 0.0 ? Eigen::Vector2d(sum / count) : Eigen::Vector2d::Zero();
}

/// The normal equations of stated(p) = own(p - shift) at a shift.
struct Equations {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0.0;  ///< of the residuals

  Equations(const Patch& own, const Patch& stated, const Patch& weight, const Eigen::Vector2d& shift) {
    for (int y = 1; y + 1 < stated.height; ++y) {
      for (int x = 1; x + 1 < stated.width; ++x) {
        if (weight.at(x, y) == 0.0f) continue;
        const double u = x - shift.x(), v = y - shift.y();
        const double residual = static_cast<double>(stated.at(x, y) - own.between(u, v));
        const Eigen::Vector2d slope(0.5 * static_cast<double>(own.between(u - 1.0, v) - own.between(u + 1.0, v)),
                                    0.5 * static_cast<double>(own.between(u, v - 1.0) - own.between(u, v + 1.0)));
        matrix += slope * slope.transpose();
        right += residual * slope;
        squares += residual * residual;
      }
    }
  }
};

/// A pixel of a straight border gives about 0.2 to the matrix of its equations. Both directions need some pixels.
bool states_both(const Eigen::Matrix2d& matrix) {
  constexpr double least = 0.2 * 12.0;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(matrix).eigenvalues().minCoeff() > least;
}

struct Fit {
  Eigen::Vector2d shift;
  double squares;
};

std::optional<Fit> fit(const Patch& own, const Patch& stated, const Patch& weight, Eigen::Vector2d shift) {
  constexpr int steps = 25;
  constexpr double most_shift = 15.0, longest_step = 2.0;  // px
  for (int step = 0; step < steps; ++step) {
    const Equations equations(own, stated, weight, shift);
    if (!states_both(equations.matrix)) return std::nullopt;
    Eigen::Vector2d move = equations.matrix.ldlt().solve(equations.right);
    if (move.norm() > longest_step) move *= longest_step / move.norm();
    shift += move;
    if (shift.norm() > most_shift) return std::nullopt;
    if (move.norm() < 1e-3) break;
  }
  return Fit{shift, Equations(own, stated, weight, shift).squares};
}

}  // namespace

double tolerant_iou(const BinaryImage& a, const BinaryImage& b) {
  Window window;
  window.extend(a);
  window.extend(b);
  if (window.empty()) return 1.0;
  std::size_t all = 0, apart = 0;
  const auto near = [](const BinaryImage& image, int x, int y) {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (image.at(x + dx, y + dy)) return true;
    return false;
  };
  for (int y = window.top; y < window.bottom; ++y) {
    for (int x = window.left; x < window.right; ++x) {
      const bool in_a = a.at(x, y), in_b = b.at(x, y);
      all += in_a || in_b;
      if (in_a != in_b) apart += !near(in_a ? b : a, x, y);
    }
  }
  return 1.0 - static_cast<double>(apart) / static_cast<double>(all);
}

std::optional<Eigen::Vector2d> mask_shift(const BinaryImage& own, const BinaryImage& stated,
                                          const BinaryImage& hidden) {
  constexpr int margin = 8;
  Window of_own, window;
  of_own.extend(own);
  window.extend(own);
  window.extend(stated);
  if (of_own.empty()) return std::nullopt;
  const Window limit = of_own.grown(20, own.width, own.height);  // what is further away no shift explains
  window = window.grown(margin, own.width, own.height);
  window = {std::max(window.left, limit.left), std::max(window.top, limit.top), std::min(window.right, limit.right),
            std::min(window.bottom, limit.bottom)};
  if (window.width() < 4 || window.height() < 4) return std::nullopt;
  Patch a = cut(own, window), b = cut(stated, window);
  const Eigen::Vector2d apart = centroid(b) - centroid(a);
  smooth(a);
  smooth(b);
  const Patch weight = weights(hidden, window, own.width, own.height);
  std::optional<Fit> best = fit(a, b, weight, Eigen::Vector2d::Zero());
  if (apart.norm() > 1.0) {
    const std::optional<Fit> other = fit(a, b, weight, apart);
    if (other && (!best || other->squares < best->squares)) best = other;
  }
  // A border that is off by a third of a pixel in a random direction everywhere leaves 0.02 a pixel of border.
  const Equations at_zero(a, b, weight, Eigen::Vector2d::Zero());
  const double border = at_zero.matrix.trace() / 0.2;
  if (!best || best->squares > 0.1 * border) return std::nullopt;
  return best->shift;
}

}  // namespace bin_scenes
