/// Order statistics, distances of distributions and fitted exponents of benchmark samples.
#pragma once

#include <vector>

namespace bin_scenes::bench {

/// Value below which a share `q` (0..1) of the samples lies, linear between neighbours (type 7 of Hyndman & Fan 1996,
/// "Sample quantiles in statistical packages"); NaN without samples.
double quantile(std::vector<double> samples, double q);
double median(std::vector<double> samples);
/// Largest minus smallest; 0 for none.
double range(const std::vector<double>& samples);

/// Wasserstein-1 (earth mover's) distance of two empirical distributions on a line, in the samples' unit: the area
/// between their quantile functions. NaN if either is empty.
double wasserstein(std::vector<double> a, std::vector<double> b);

/// Least-squares slope of log y over log x: the exponent p of y ~ x^p. NaN below two different x; all values > 0.
double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace bin_scenes::bench
