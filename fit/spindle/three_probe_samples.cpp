#include <algorithm>
#include <cmath>

#include "core/numbers.h"
#include "core/units.h"
#include "fit/profiles/periodic_spline.h"
#include "fit/spindle/internal/three_probe_parts.h"

namespace rondure::fit {
namespace {

using core::Code;
using core::kTwoPi;

constexpr double kUniform = 1e-6;  ///< Fraction of a step: closer to uniform is not interpolated.
constexpr double kMissingSteps = 1.5;  ///< Most samples missing at the end of a revolution.
/// Limit for all revolutions together; the separation needs some 100 bytes per sample.
constexpr double kMostProbeSamples = 1e7;

core::Result<void> check_rows(const ProbeReadings& readings, const ThreeProbeOptions& options) {
  const std::size_t rows = readings.alpha_rad.size();
  for (std::size_t i = 0; i < 3; ++i) {
    if (readings.h_mm[i].size() == rows) continue;
    return core::fail_with(
        Code::kSampling,
        "probe {} has {} readings, there are {} angles; every column needs the same length", i + 1,
        readings.h_mm[i].size(), rows);
  }
  if (!readings.beta_rad.empty() && readings.beta_rad.size() != rows) {
    return core::fail_with(Code::kSampling,
                           "{} swing angles and {} work angles; every column needs the same length",
                           readings.beta_rad.size(), rows);
  }
  const std::size_t needed = 2 * static_cast<std::size_t>(options.highest) + 2;
  if (rows < needed) {
    return core::fail_with(Code::kSampling,
                           "{} readings do not carry {} undulations; at least {} are needed", rows,
                           options.highest, needed);
  }
  for (std::size_t m = 0; m < rows; ++m) {
    bool finite = core::is_measurable(readings.alpha_rad[m]);
    for (const auto& h : readings.h_mm) finite = finite && core::is_measurable(h[m]);
    if (!readings.beta_rad.empty()) finite = finite && core::is_measurable(readings.beta_rad[m]);
    if (!finite)
      return core::fail_with(Code::kNotFinite, "row {} holds no finite number up to {:g}", m,
                             core::kGreatestNumber);
  }
  return {};
}

/// Returns theta of every row, strictly increasing; refuses work that turns backwards.
core::Result<std::vector<double>> travel(const ProbeReadings& readings, const SwingArm& arm) {
  std::vector<double> theta;
  theta.reserve(readings.alpha_rad.size());
  for (std::size_t m = 0; m < readings.alpha_rad.size(); ++m) {
    const double alpha = readings.alpha_rad[m];
    const double beta = readings.beta_rad.empty() ? arm.beta_rad(alpha) : readings.beta_rad[m];
    theta.push_back(alpha + beta);
    if (m == 0 || theta[m] > theta[m - 1]) continue;
    return core::fail_with(Code::kAngleOrder,
                           "the angle on the part does not increase in row {}: {:.6f} deg after "
                           "{:.6f} deg; give the work angle unwrapped and in order",
                           m, theta[m] / core::kDegree, theta[m - 1] / core::kDegree);
  }
  return theta;
}

/// Number of whole revolutions, and of their rows.
struct Extent {
  int revolutions = 1;
  std::size_t rows = 0;
};

core::Result<Extent> whole_revolutions(const std::vector<double>& theta,
                                       const ThreeProbeOptions& options) {
  const double covered = theta.back() - theta.front();
  const double step = covered / static_cast<double>(theta.size() - 1);
  Extent out;
  const double revolutions = std::floor((covered + kMissingSteps * step) / kTwoPi);
  const double each = static_cast<double>(theta.size()) / std::max(revolutions, 1.0);
  const double needed = 2.0 * options.highest + 2.0;
  if (each < needed) {
    return core::fail_with(Code::kSampling,
                           "{} readings over {:.0f} revolutions are {:.1f} a revolution; {} "
                           "undulations need at least {:.0f}: is the angle in deg?",
                           theta.size(), revolutions, each, options.highest, needed);
  }
  if (revolutions * options.samples > kMostProbeSamples) {
    return core::fail_with(Code::kBadOption,
                           "{:.0f} revolutions of {} samples are {:.3g}, the limit is {:g}: take "
                           "fewer samples a revolution",
                           revolutions, options.samples, revolutions * options.samples,
                           kMostProbeSamples);
  }
  out.revolutions = static_cast<int>(revolutions);
  if (out.revolutions < 1) {
    return core::fail_with(Code::kNotFullSection,
                           "the readings cover {:.3f} deg on the part; a full revolution is needed "
                           "(a work angle in radians covers 6.283)",
                           covered / core::kDegree);
  }
  const double end = theta.front() + out.revolutions * kTwoPi - 0.01 * step;
  out.rows = static_cast<std::size_t>(std::ranges::lower_bound(theta, end) - theta.begin());
  return out;
}

bool is_uniform(const std::vector<double>& theta, const Extent& extent) {
  const double step = extent.revolutions * kTwoPi / static_cast<double>(extent.rows);
  for (std::size_t m = 0; m < extent.rows; ++m) {
    if (std::abs(theta[m] - theta[0] - step * static_cast<double>(m)) > kUniform * step)
      return false;
  }
  return true;
}

void interpolate(const ProbeReadings& readings, const std::vector<double>& theta,
                 const Extent& extent, int highest, ProbeSamples& out) {
  // One period spans all revolutions, so that motion that does not repeat stays smooth inside.
  std::vector<double> scaled(extent.rows);
  for (std::size_t m = 0; m < extent.rows; ++m)
    scaled[m] = (theta[m] - theta[0]) / extent.revolutions;
  const std::size_t total = out.count * static_cast<std::size_t>(extent.revolutions);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& h = readings.h_mm[i];
    out.h_mm[i] =
        even_samples(scaled, {h.begin(), h.begin() + static_cast<std::ptrdiff_t>(extent.rows)},
                     total, static_cast<double>(highest) * extent.revolutions);
  }
  out.interpolated = true;
}

void take_rows(const ProbeReadings& readings, std::size_t rows, ProbeSamples& out) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& h = readings.h_mm[i];
    out.h_mm[i].assign(h.begin(), h.begin() + static_cast<std::ptrdiff_t>(rows));
  }
}

/// Sets work angle and swing of the samples of the first revolution, from the measured columns if
/// there are any, else from the arm.
void place_samples(const ProbeReadings& readings, const std::vector<double>& theta,
                   const SwingArm& arm, ProbeSamples& out) {
  out.alpha_rad.resize(out.count);
  out.beta_rad.resize(out.count);
  std::size_t at = 0;
  for (std::size_t n = 0; n < out.count; ++n) {
    const double angle =
        out.start_rad + kTwoPi * static_cast<double>(n) / static_cast<double>(out.count);
    if (readings.beta_rad.empty()) {
      out.alpha_rad[n] = arm.alpha_of_theta_rad(angle);
      out.beta_rad[n] = arm.beta_of_theta_rad(angle);
      continue;
    }
    while (at + 2 < theta.size() && theta[at + 1] < angle) ++at;
    const double share = (angle - theta[at]) / (theta[at + 1] - theta[at]);
    out.beta_rad[n] =
        readings.beta_rad[at] + share * (readings.beta_rad[at + 1] - readings.beta_rad[at]);
    out.alpha_rad[n] = angle - out.beta_rad[n];
  }
}

void average(ProbeSamples& out) {
  const auto turns = static_cast<std::size_t>(out.revolutions);
  for (std::size_t i = 0; i < 3; ++i) {
    auto& mean = out.mean_mm[i];
    mean.assign(out.h_mm[i].begin(), out.h_mm[i].begin() + static_cast<std::ptrdiff_t>(out.count));
    for (std::size_t j = 1; j < turns; ++j) {
      for (std::size_t n = 0; n < out.count; ++n) mean[n] += out.h_mm[i][j * out.count + n];
    }
    if (turns > 1) {
      for (double& value : mean) value /= static_cast<double>(turns);
    }
  }
}

}  // namespace

core::Result<ProbeSamples> sample_readings(const ProbeReadings& readings, const SwingArm& arm,
                                           const ThreeProbeOptions& options) {
  TRY_DO(check_rows(readings, options));
  TRY(const auto theta, travel(readings, arm));
  TRY(const auto extent, whole_revolutions(theta, options));
  const auto turns = static_cast<std::size_t>(extent.revolutions);
  ProbeSamples out;
  out.revolutions = extent.revolutions;
  out.rows = extent.rows;
  out.start_rad = theta.front();
  const std::size_t each = extent.rows / turns;
  out.count = options.samples == 0 ? each : static_cast<std::size_t>(options.samples);
  for (std::size_t m = 1; m < extent.rows; ++m) {
    out.largest_gap_rad = std::max(out.largest_gap_rad, theta[m] - theta[m - 1]);
  }
  if (out.count * turns == extent.rows && is_uniform(theta, extent)) {
    take_rows(readings, extent.rows, out);
  } else {
    interpolate(readings, theta, extent, options.highest, out);
  }
  place_samples(readings, theta, arm, out);
  average(out);
  out.theta_rad.assign(theta.begin(), theta.begin() + static_cast<std::ptrdiff_t>(extent.rows));
  return out;
}

}  // namespace rondure::fit
