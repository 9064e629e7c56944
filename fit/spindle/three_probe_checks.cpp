#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/statistics.h"
#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/profiles/periodic_spline.h"
#include "fit/spindle/internal/three_probe_parts.h"

namespace rondure::fit {
namespace {

using core::Code;

constexpr double kSwingTolerance_rad = 0.05 * core::kDegree;
/// Deviation of a reading from its neighbours, in standard deviations.
constexpr double kGross = 8.0;
constexpr double kGrossFloor = 1e-5;    ///< Fraction of the range of a probe.
constexpr std::size_t kGrossReach = 4;  ///< Rows affected by one gross reading.
constexpr double kSamePlace = 2.5;      ///< Rows within which two probes see the same edge.
constexpr std::size_t kNamedReadings = 5;
constexpr double kLeastNoise_mm = 1e-3 * core::kMicrometre;  ///< Better than any probe.

/// Weighted sum of every revolution.
std::vector<std::vector<double>> sums_of_turns(const ProbeSamples& samples,
                                               const ProbeLayout& layout) {
  const auto& w = layout.weights();
  std::vector<std::vector<double>> out(static_cast<std::size_t>(samples.revolutions));
  for (std::size_t j = 0; j < out.size(); ++j) {
    for (std::size_t n = j * samples.count; n < (j + 1) * samples.count; ++n) {
      out[j].push_back(samples.h_mm[0][n] + w[1] * samples.h_mm[1][n] + w[2] * samples.h_mm[2][n]);
    }
  }
  return out;
}

/// Transmission of a harmonic by the spline, which attenuates noise as it does undulations of few
/// readings.
double kept(const ProbeSamples& samples, std::size_t order) {
  const double readings = static_cast<double>(samples.rows) / samples.revolutions;
  return samples.interpolated ? spline_transmission(static_cast<double>(order) / readings) : 1.0;
}

/// Standard deviation of a reading from the mean |F(k)|^2 of the mean revolution, which is
/// N^2 s^2 W^2 over the number of readings.
double noise_of(double power, const ProbeSamples& samples, const ProbeLayout& layout) {
  return std::sqrt(power * static_cast<double>(samples.rows)) /
         (static_cast<double>(samples.count) * layout.weight_norm());
}

/// |F(k)|^2 of the differences of the revolutions from their mean, summed over the revolutions, for
/// k = 2..highest.
std::vector<double> power_of_differences(const ProbeSamples& samples,
                                         const std::vector<std::vector<double>>& sums,
                                         int highest) {
  const auto turns = static_cast<double>(sums.size());
  std::vector<double> mean(samples.count, 0.0);
  for (const auto& turn : sums) {
    for (std::size_t n = 0; n < mean.size(); ++n) mean[n] += turn[n] / turns;
  }
  std::vector<double> power(static_cast<std::size_t>(highest - 1), 0.0);
  for (const auto& turn : sums) {
    std::vector<double> apart(mean.size());
    std::ranges::transform(turn, mean, apart.begin(), std::minus<>());
    const Spectrum f = spectrum(apart);
    for (std::size_t k = 2; k <= static_cast<std::size_t>(highest); ++k)
      power[k - 2] += std::norm(f[k] / kept(samples, k));
  }
  return power;
}

/// Standard deviation of a reading from the differences between revolutions in the requested
/// harmonics.
double scatter_mm(const ProbeSamples& samples, const std::vector<std::vector<double>>& sums,
                  const ProbeLayout& layout, int highest) {
  const auto turns = static_cast<double>(sums.size());
  double power = 0.0;
  for (const double one : power_of_differences(samples, sums, highest)) power += one;
  // The variance of the mean revolution is that of one revolution divided by their number.
  return noise_of(power / ((turns - 1.0) * turns * (highest - 1)), samples, layout);
}

/// A reading that deviates from its neighbours.
struct LoneReading {
  std::size_t probe = 0;
  std::size_t row = 0;
  double score = 0.0;   ///< Distance from the prediction, relative to unit white noise.
  double off_mm = 0.0;  ///< Distance from the cubic through its four nearest neighbours.
};

LoneReading against_neighbours(std::span<const double> h, std::span<const double> theta,
                               std::size_t row) {
  const std::size_t first = row - 2;
  double predicted = 0.0;
  double norm = 1.0;
  for (std::size_t i = first; i < first + 5; ++i) {
    if (i == row) continue;
    double share = 1.0;  // Lagrange
    for (std::size_t j = first; j < first + 5; ++j) {
      if (j != row && j != i) share *= (theta[row] - theta[j]) / (theta[i] - theta[j]);
    }
    predicted += share * h[i];
    norm += share * share;
  }
  const double off = h[row] - predicted;
  return {0, row, off / std::sqrt(norm), off};
}

/// Standard deviation of the scores: by the greater of their median and their 95 % quantile, so
/// that heavy tails and undulations near the limit of the sampling do not all seem gross.
double scale_of(const std::vector<double>& distances) {
  const auto quantile = [&](double share) {
    return core::order_statistic(
        distances, static_cast<std::size_t>(share * static_cast<double>(distances.size() - 1)));
  };
  return std::max(core::kSigmaPerMedianDeviation * quantile(0.5), quantile(0.95) / 1.96);
}

/// Rows of one probe beyond the limit, the largest first.
std::vector<LoneReading> lone_readings(std::span<const double> h, std::span<const double> theta,
                                       std::size_t probe) {
  std::vector<LoneReading> all;
  std::vector<double> distances;
  // A gross reading at either end shows two rows away.
  for (std::size_t m = 2; m + 2 < theta.size(); ++m) {
    all.push_back(against_neighbours(h, theta, m));
    all.back().probe = probe;
    distances.push_back(std::abs(all.back().score));
  }
  const double limit =
      std::max(kGross * scale_of(distances), kGrossFloor * column_extremes(h).width());
  std::vector<LoneReading> out;
  std::ranges::copy_if(all, std::back_inserter(out),
                       [&](const LoneReading& one) { return std::abs(one.score) > limit; });
  std::ranges::sort(out, std::greater<>(),
                    [](const LoneReading& one) { return std::abs(one.score); });
  return out;
}

bool near_in_time(const LoneReading& a, const LoneReading& b) {
  return a.probe == b.probe && std::max(a.row, b.row) - std::min(a.row, b.row) <= kGrossReach;
}

/// Gross readings: they deviate from their neighbours, and no other probe or revolution shows a
/// jump at the same place of the part. One for each neighbourhood.
std::vector<LoneReading> gross_readings(const ProbeReadings& readings, const ProbeSamples& samples,
                                        const ProbeLayout& layout) {
  const std::span<const double> theta(samples.theta_rad);
  std::vector<LoneReading> found;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto rows = lone_readings(std::span(readings.h_mm[i]).first(theta.size()), theta, i);
    found.insert(found.end(), rows.begin(), rows.end());
  }
  const auto angles = layout.angles_rad();
  const double step = samples.revolutions * core::kTwoPi / static_cast<double>(theta.size());
  std::vector<LoneReading> out;
  for (const LoneReading& one : found) {
    const bool known = std::ranges::any_of(
        out, [&](const LoneReading& other) { return near_in_time(one, other); });
    const bool on_part = std::ranges::any_of(found, [&](const LoneReading& other) {
      if (near_in_time(one, other)) return false;
      const double apart = std::remainder(
          theta[one.row] + angles[one.probe] - theta[other.row] - angles[other.probe],
          core::kTwoPi);
      return std::abs(apart) <= kSamePlace * step;
    });
    if (!known && !on_part) out.push_back(one);
  }
  return out;
}

void contradict(ThreeProbeResult& result, Code code, std::string what) {
  result.contradictions.push_back({code, what});
  result.warnings.push_back({code, std::move(what)});
}

void name_gross_readings(const std::vector<LoneReading>& gross, ThreeProbeResult& result) {
  if (gross.empty()) return;
  std::string rows;
  for (std::size_t i = 0; i < std::min(gross.size(), kNamedReadings); ++i) {
    rows += fmt::format("{}probe {} row {} ({:+.3g} um)", i > 0 ? ", " : "", gross[i].probe + 1,
                        gross[i].row, gross[i].off_mm / core::kMicrometre);
  }
  contradict(
      result, Code::kOutliers,
      fmt::format(
          "{} reading{} more than {:g} standard deviations off the neighbours, "
          "where no other probe sees the part do so, at or beside {}{}; they stand in part and "
          "motion. Leave such rows out (a gap is bridged) or measure again",
          gross.size(), gross.size() == 1 ? " is" : "s are", kGross, rows,
          gross.size() > kNamedReadings ? ", ..." : ""));
}

/// Checks a stated noise against the scatter of the revolutions.
void check_stated_noise(const ProbeSamples& samples, const ThreeProbeOptions& options,
                        ThreeProbeResult& result) {
  if (!options.noise_mm || samples.revolutions < 2) return;
  const auto sums = sums_of_turns(samples, result.layout);
  const double found = scatter_mm(samples, sums, result.layout, options.highest);
  // 3 standard deviations of a root mean square of this many values.
  const double values = 2.0 * (options.highest - 1) * (samples.revolutions - 1);
  if (found <= *options.noise_mm * (1.0 + 3.0 / std::sqrt(2.0 * values)) ||
      found < kLeastNoise_mm) {
    return;
  }
  result.warnings.push_back(
      {Code::kInconsistent,
       fmt::format("the revolutions scatter as with {:.3g} um a reading, {:.3g} um are stated: "
                   "every uncertainty is too small by that ratio",
                   found / core::kMicrometre, *options.noise_mm / core::kMicrometre)});
}

}  // namespace

std::optional<double> estimated_noise_mm(const ProbeSamples& samples, const Spectrum& sum,
                                         const ProbeLayout& layout, int highest) {
  if (samples.revolutions > 1) {
    return scatter_mm(samples, sums_of_turns(samples, layout), layout, highest);
  }
  const auto n = static_cast<double>(samples.count);
  const auto readings = static_cast<double>(samples.rows);
  double end = 0.5 * std::min(n, readings);
  if (samples.interpolated && readings > n) {
    end = std::min(end, last_untouched(samples.count, highest) + 1.0);
  }
  std::vector<double> power;
  for (auto k = static_cast<std::size_t>(highest) + 1; static_cast<double>(k) < end; ++k)
    power.push_back(std::norm(sum[k] / kept(samples, k)));
  if (power.empty()) return std::nullopt;
  // The median keeps chatter in some of the harmonics from being taken for noise; for chi square
  // with two degrees of freedom it is ln 2 times the mean.
  return noise_of(core::upper_median(std::move(power)) / std::numbers::ln2, samples, layout);
}

std::vector<double> scatter_by_order_mm(const ProbeSamples& samples, const ProbeLayout& layout,
                                        int highest) {
  if (samples.revolutions < 2) return {};
  const auto turns = static_cast<double>(samples.revolutions);
  std::vector<double> out = power_of_differences(samples, sums_of_turns(samples, layout), highest);
  for (double& one : out) one = noise_of(one / ((turns - 1.0) * turns), samples, layout);
  return out;
}

void find_contradictions(const ProbeReadings& readings, const ProbeSamples& samples,
                         const SwingArm& arm, const ThreeProbeOptions& options,
                         ThreeProbeResult& result) {
  name_gross_readings(gross_readings(readings, samples, result.layout), result);
  if (options.judge_first_harmonic && result.first_harmonic_mm > result.first_harmonic_limit_mm) {
    contradict(result, Code::kInconsistent,
               fmt::format("the weighted sum holds {:.4g} um at one undulation, where it must "
                           "vanish (limit {:.4g} um): a probe angle, a probe gain or the angle on "
                           "the part is wrong, or a probe drifts within the revolution",
                           result.first_harmonic_mm / core::kMicrometre,
                           result.first_harmonic_limit_mm / core::kMicrometre));
  }
  check_stated_noise(samples, options, result);
  double swing = 0.0;
  for (std::size_t m = 0; m < readings.beta_rad.size(); ++m)
    swing = std::max(swing, std::abs(readings.beta_rad[m] - arm.beta_rad(readings.alpha_rad[m])));
  if (swing > kSwingTolerance_rad) {
    contradict(result, Code::kInconsistent,
               fmt::format("the measured swing differs from that of the stated radii by up to "
                           "{:.3f} deg (limit 0.05 deg)",
                           swing / core::kDegree));
  }
}

}  // namespace rondure::fit
