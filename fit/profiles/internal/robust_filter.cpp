#include "fit/profiles/internal/robust_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/statistics.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

constexpr int kIterationLimit = 3000;
/// After this many iterations only half of each step is taken, then a quarter, then an eighth. With
/// strong undulations next to the cut-off, full steps would overshoot without end. The share of the
/// step does not change the line to which the iteration converges.
constexpr int kIterationsPerDamping = 100;
constexpr int kDampings = 3;
constexpr double kStandardised = 4.4478;  // 3 standard deviations: median|e| = 0.67449 sigma
constexpr double kSettledStep = 1e-9;
/// If the weight of a neighbourhood is below this, its mean is round-off of the transform.
constexpr double kLeastWeight = 1e-6;
/// Floor of the scale, as a multiple of the largest change of the mean line by a second filtering.
/// A spike lifts the first line by a bump b, of which the second filtering removes
/// (1 - 1/sqrt(2)) b. With a floor of twice b the points beside the spike stay inside, and the
/// parts that the filter removes from smooth undulations have a weight above 0.95.
constexpr double kFloor = 2.0 / (1.0 - 1.0 / std::numbers::sqrt2);

/// Source of the scale of the residuals.
enum class Scale {
  kMedian,   ///< From their median, as in the standard.
  kFloored,  ///< The same, but not below the floor.
};

std::vector<double> gaussian_mean(std::span<const double> r, double cutoff) {
  auto f = spectrum(r);
  for (std::size_t k = 0; k < f.size(); ++k) {
    f[k] *= gaussian_transmission(static_cast<double>(k), cutoff);
  }
  return series_of(f, r.size());
}

double median_distance(std::span<const double> r, std::span<const double> w) {
  std::vector<double> distance(r.size());
  for (std::size_t i = 0; i < r.size(); ++i) distance[i] = std::abs(r[i] - w[i]);
  return core::median(std::move(distance));
}

/// Tukey's weights of the residuals.
std::vector<double> weights(std::span<const double> r, std::span<const double> w, double c) {
  std::vector<double> out(r.size(), 0.0);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double ratio = (r[i] - w[i]) / c;
    if (std::abs(ratio) <= 1.0) out[i] = (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
  }
  return out;
}

double greatest_step(std::span<const double> a, std::span<const double> b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

/// Iterates the mean line of a profile whose mean is 0.
core::Result<RobustMeanLine> settled_line(const std::vector<double>& r, double cutoff_upr,
                                          Scale scale) {
  RobustMeanLine out{gaussian_mean(r, cutoff_upr), 0, scale == Scale::kFloored};
  const auto [low, high] = std::minmax_element(r.begin(), r.end());
  const double round_off = 64.0 * std::numeric_limits<double>::epsilon() * (*high - *low);
  std::vector<double> weighted(r.size());
  while (out.iterations < kIterationLimit) {
    ++out.iterations;
    double c = kStandardised * median_distance(r, out.r_mm);
    if (scale == Scale::kFloored) {
      c = std::max(c, kFloor * greatest_step(out.r_mm, gaussian_mean(out.r_mm, cutoff_upr)));
    }
    if (c <= round_off) return out;  // half of the profile is its own mean line
    const auto delta = weights(r, out.r_mm, c);
    for (std::size_t i = 0; i < delta.size(); ++i) weighted[i] = delta[i] * r[i];
    auto line = gaussian_mean(weighted, cutoff_upr);
    const auto weight = gaussian_mean(delta, cutoff_upr);
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (weight[i] < kLeastWeight) {
        return core::fail(core::Code::kNotConverged,
                          fmt::format("the robust filter at {} UPR finds only outliers round row "
                                      "{}; take a lower cut-off or the linear filter",
                                      cutoff_upr, i));
      }
      line[i] /= weight[i];
    }
    const double step = greatest_step(line, out.r_mm);
    const double share = std::exp2(-std::min(out.iterations / kIterationsPerDamping, kDampings));
    for (std::size_t i = 0; i < line.size(); ++i) out.r_mm[i] += share * (line[i] - out.r_mm[i]);
    if (step <= kSettledStep * c + round_off) return out;
  }
  return core::fail(core::Code::kNotConverged,
                    fmt::format("the robust filter at {} UPR still moves after {} iterations; take "
                                "another cut-off or the linear filter",
                                cutoff_upr, kIterationLimit));
}

}  // namespace

core::Result<RobustMeanLine> robust_mean_line(std::span<const double> r_mm, double cutoff_upr) {
  // The profile is taken relative to its mean, so that a radius of many mm costs no digits.
  const double mean = core::mean(r_mm);
  std::vector<double> r(r_mm.begin(), r_mm.end());
  for (double& value : r) value -= mean;
  auto line = settled_line(r, cutoff_upr, Scale::kMedian);
  // The residuals of a smooth profile are not noise, but the parts of its undulations that the
  // filter removes; their median is no measure of the largest ones.
  if (!line) line = settled_line(r, cutoff_upr, Scale::kFloored);
  if (!line) return line;
  for (double& value : line->r_mm) value += mean;
  return line;
}

}  // namespace rondure::fit
