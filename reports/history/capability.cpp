#include "reports/history/capability.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/noise.h"
#include "core/statistics.h"

namespace rondure::reports {
namespace {

using core::Code;

constexpr double kLeastP = 0.05;
constexpr double kRangeToSigma = 1.128;  ///< d2 for ranges of two values.
constexpr double kUpperShare = 0.99865;
constexpr std::uint64_t kSeed = 22514;
constexpr std::size_t kDraws = 4000;

struct Moments {
  double mean = 0.0;
  double sd = 0.0;
};

Moments moments_of(std::span<const double> values) {
  Moments out;
  const auto n = static_cast<double>(values.size());
  for (const double x : values) out.mean += x / n;
  for (const double x : values) out.sd += (x - out.mean) * (x - out.mean) / (n - 1.0);
  out.sd = std::sqrt(out.sd);
  return out;
}

/// ln of the values, or why they cannot be used.
core::Result<std::vector<double>> logarithms(std::span<const double> values_mm, std::size_t least) {
  if (values_mm.size() < least) {
    return core::fail_with(Code::kTooFewPoints, "{} results, at least {} are needed",
                           values_mm.size(), least);
  }
  std::vector<double> out;
  for (const double x : values_mm) {
    if (!(x > 0.0) || !std::isfinite(x)) {
      return core::fail_with(Code::kOutOfRange, "a deviation of {} mm has no logarithm; exclude it",
                             x);
    }
    out.push_back(std::log(x));
  }
  const auto [low, high] = std::minmax_element(out.begin(), out.end());
  if (*high - *low < 1e-12) return core::fail(Code::kRank, "all results are alike");
  return out;
}

/// Percentile of a sorted sample at place share (n + 1), as in ISO 3534-1.
double sample_percentile(const std::vector<double>& sorted, double share) {
  const double place = share * (static_cast<double>(sorted.size()) + 1.0) - 1.0;
  const double last = static_cast<double>(sorted.size()) - 1.0;
  const double at = std::clamp(place, 0.0, last);
  const auto left = std::min(static_cast<std::size_t>(at), sorted.size() - 2);
  const double part = at - static_cast<double>(left);
  return (1.0 - part) * sorted[left] + part * sorted[left + 1];
}

struct LimitPair {
  std::optional<double> lower_mm;
  std::optional<double> upper_mm;
};

/// Index of a log-normal model, of one side or the lesser of both.
double index_of(const LimitPair& limits, const Moments& ln) {
  double index = std::numeric_limits<double>::infinity();
  if (limits.upper_mm) {
    const double above = *limits.upper_mm > 0.0 ? std::log(*limits.upper_mm) - ln.mean
                                                : -std::numeric_limits<double>::infinity();
    index = std::expm1(above) / std::expm1(3.0 * ln.sd);
  }
  if (limits.lower_mm) {
    const double below = *limits.lower_mm > 0.0 ? std::log(*limits.lower_mm) - ln.mean
                                                : -std::numeric_limits<double>::infinity();
    index = std::min(index, std::expm1(below) / std::expm1(-3.0 * ln.sd));
  }
  return index;
}

/// Lower confidence bound of the index of a log-normal model: the 5 % point of its generalised
/// pivotal quantity. Standard deviation and mean are drawn from their uncertainty in the sample: sd
/// / sd* from chi square, the mean from sd* / sqrt(n). Fixed seed, same bits.
double lower_bound(const LimitPair& limits, const Moments& ln, double n) {
  core::KeyedNoise noise(kSeed, {});
  const double freedom = n - 1.0;
  std::vector<double> drawn(kDraws);
  for (double& index : drawn) {
    const double probability = 0.5 * std::erfc(-noise.normal() / std::sqrt(2.0));
    const double sd = ln.sd * std::sqrt(freedom / core::chi_square_quantile(probability, freedom));
    const double mean = ln.mean + noise.normal() * sd / std::sqrt(n);
    index = index_of(limits, {mean, sd});
  }
  return core::order_statistic(std::move(drawn), kDraws / 20);
}

/// The index from the points of the capability.
void set_index(const LimitPair& limits, Capability& out) {
  out.index = std::numeric_limits<double>::infinity();
  if (limits.upper_mm) {
    out.index = (*limits.upper_mm - out.median_mm) / (out.upper_point_mm - out.median_mm);
  }
  if (limits.lower_mm) {
    out.index = std::min(
        out.index, (out.median_mm - *limits.lower_mm) / (out.median_mm - *out.lower_point_mm));
  }
}

Capability log_normal(const Moments& ln, double n, const LimitPair& limits) {
  Capability out;
  out.median_mm = std::exp(ln.mean);
  out.upper_point_mm = std::exp(ln.mean + 3.0 * ln.sd);
  if (limits.lower_mm) out.lower_point_mm = std::exp(ln.mean - 3.0 * ln.sd);
  set_index(limits, out);
  out.lower_bound = lower_bound(limits, ln, n);
  return out;
}

Capability of_sample(std::span<const double> values_mm, const LimitPair& limits) {
  std::vector<double> sorted(values_mm.begin(), values_mm.end());
  std::sort(sorted.begin(), sorted.end());
  Capability out;
  out.method = Capability::Method::kSample;
  out.median_mm = sample_percentile(sorted, 0.5);
  out.upper_point_mm = sample_percentile(sorted, kUpperShare);
  if (limits.lower_mm) out.lower_point_mm = sample_percentile(sorted, 1.0 - kUpperShare);
  set_index(limits, out);
  return out;
}

}  // namespace

core::Result<ControlLimits> control_limits(std::span<const double> values_mm) {
  TRY(const auto ln, logarithms(values_mm, kLeastForLimits));
  double range = 0.0;
  for (std::size_t i = 1; i < ln.size(); ++i) {
    range += std::abs(ln[i] - ln[i - 1]) / static_cast<double>(ln.size() - 1);
  }
  const double mean = moments_of(ln).mean;
  const double reach = 3.0 * range / kRangeToSigma;
  return ControlLimits{std::exp(mean - reach), std::exp(mean), std::exp(mean + reach)};
}

core::Result<Capability> capability_between(std::span<const double> values_mm,
                                            const std::optional<double>& lower_mm,
                                            const std::optional<double>& upper_mm) {
  const LimitPair limits = {lower_mm, upper_mm};
  TRY(const auto ln, logarithms(values_mm, kLeastForIndex));
  const double p = anderson_darling_p(ln);
  if (p < kLeastP && values_mm.size() < kEnoughForSample) {
    return core::fail_with(
        Code::kNotConverged,
        "the results do not follow a log-normal distribution (Anderson-Darling p = {:.2g}), and {} "
        "are too few for percentiles of their own ({} are needed)",
        p, values_mm.size(), kEnoughForSample);
  }
  Capability out = p < kLeastP
                       ? of_sample(values_mm, limits)
                       : log_normal(moments_of(ln), static_cast<double>(values_mm.size()), limits);
  out.fit_p = p;
  return out;
}

double anderson_darling_p(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const Moments m = moments_of(sorted);
  const auto n = static_cast<double>(sorted.size());
  const auto below = [&](double x) {
    return 0.5 * std::erfc(-(x - m.mean) / m.sd / std::sqrt(2.0));
  };
  const auto above = [&](double x) {
    return 0.5 * std::erfc((x - m.mean) / m.sd / std::sqrt(2.0));
  };
  constexpr double kTiny = 1e-300;
  double sum = 0.0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double weight = 2.0 * static_cast<double>(i) + 1.0;
    sum += weight * (std::log(std::max(below(sorted[i]), kTiny)) +
                     std::log(std::max(above(sorted[sorted.size() - 1 - i]), kTiny)));
  }
  const double a = (-n - sum / n) * (1.0 + 0.75 / n + 2.25 / (n * n));
  if (a >= 0.6)
    return std::exp(1.2937 - 5.709 * a + 0.0186 * std::min(a, 100.0) * std::min(a, 100.0));
  if (a >= 0.34) return std::exp(0.9177 - 4.279 * a - 1.38 * a * a);
  if (a >= 0.2) return 1.0 - std::exp(-8.318 + 42.796 * a - 59.938 * a * a);
  return 1.0 - std::exp(-13.436 + 101.14 * a - 223.73 * a * a);
}

}  // namespace rondure::reports
