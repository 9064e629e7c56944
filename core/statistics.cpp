#include "core/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include <boost/math/distributions/chi_squared.hpp>

namespace rondure::core {

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double root_mean_square(std::span<const double> values) {
  if (values.empty()) return 0.0;
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double standard_deviation(std::span<const double> values, double mean) {
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double order_statistic(std::vector<double> values, std::size_t rank) {
  assert(rank < values.size());
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double median(std::vector<double> values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}

double upper_median(std::vector<double> values) {
  const std::size_t middle = values.size() / 2;
  return order_statistic(std::move(values), middle);
}

double chi_square_quantile(double probability, double degrees_of_freedom) {
  assert(probability > 0.0 && probability < 1.0 && degrees_of_freedom > 0.0);
  // Computed in double like everything else: long double costs five times the time for the last
  // bit.
  using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return boost::math::quantile(
      boost::math::chi_squared_distribution<double, Policy>(degrees_of_freedom), probability);
}

}  // namespace rondure::core
