#include "fit/spindle/three_probe.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/spindle/internal/three_probe_parts.h"

namespace rondure::fit {
namespace {

using core::Code;

constexpr double kSecondOrderFrom_mm = 0.010;
constexpr int kSecondOrderPasses = 5;
constexpr double kSecondOrderDone_mm = 1e-9;
/// Change in the last pass relative to the correction.
constexpr double kSecondOrderSettled = 0.01;
constexpr double kPhaseFrom = 3.0;     ///< In standard uncertainties of an amplitude.
constexpr double kBelowProbes = 1e-5;  ///< Fraction of the readings; no probe is that linear.

core::Result<void> check_options(const ThreeProbeOptions& options, double part_radius_mm) {
  const auto refuse = [](std::string what) {
    return core::fail(Code::kBadOption, std::move(what));
  };
  if (options.highest < 2) {
    return refuse(fmt::format("the highest harmonic {} is below 2", options.highest));
  }
  if (!(options.greatest_gain >= 1.0)) {
    return refuse(fmt::format("a greatest gain of {} recovers nothing; give at least 1",
                              options.greatest_gain));
  }
  if (options.noise_mm && !(*options.noise_mm >= 0.0)) return refuse("probe noise is negative");
  if (options.samples < 0) return refuse("the number of samples is negative");
  if (options.tip_width_mm > 0.0 && !(part_radius_mm > 0.0)) {
    return refuse("the width of the tips is taken out by the radius of the part; state it");
  }
  return {};
}

/// Increase of each probe from one revolution to the next.
std::array<double, 3> drift_per_turn(const ProbeSamples& samples) {
  std::array<double, 3> out = {0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& h = samples.h_mm[i];
    const std::size_t last = h.size() - samples.count;
    for (std::size_t n = 0; n < samples.count; ++n) out[i] += h[last + n] - h[n];
    out[i] /= static_cast<double>(samples.count) * std::max(1, samples.revolutions - 1);
  }
  return out;
}

/// Spectrum of the weighted sum of the mean revolution. Its increase from one revolution to the
/// next is drift of a probe, or growth of the part. This ramp in time, and so in the work angle, is
/// removed, as it would appear in every harmonic.
Spectrum weighted_spectrum(const ProbeSamples& samples, const ProbeLayout& layout) {
  const auto& w = layout.weights();
  const std::array<double, 3> drift = drift_per_turn(samples);
  std::vector<double> sum(samples.count, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t n = 0; n < samples.count; ++n) {
      const double turned = (samples.alpha_rad[n] - samples.alpha_rad[0]) / core::kTwoPi;
      sum[n] += w[i] * (samples.mean_mm[i][n] - drift[i] * turned);
    }
  }
  return spectrum(sum);
}

/// Decides on the recovery of a harmonic.
struct Guard {
  const ThreeProbeOptions& options;
  const ProbeLayout& layout;
  double noise_mm = 0.0;
  double values = 1.0;  ///< Readings per probe that enter an amplitude.

  [[nodiscard]] RecoveredHarmonic look_at(int order) const {
    RecoveredHarmonic out;
    out.order = order;
    out.transfer = std::abs(layout.transfer(order));
    out.gain = layout.gain(order);
    out.sigma_mm = out.gain * noise_mm * std::sqrt(2.0 / values);
    out.recovered = out.gain <= options.greatest_gain;
    return out;
  }
};

/// The harmonics above the highest that a filter may still pass.
std::vector<RecoveredHarmonic> beyond_of(const Spectrum& sum, const Guard& guard,
                                         std::size_t count) {
  std::vector<RecoveredHarmonic> out;
  const int last = std::min(2 * guard.options.highest,
                            static_cast<int>(last_untouched(count, guard.options.highest)));
  for (int order = guard.options.highest + 1; order <= last; ++order) {
    RecoveredHarmonic& harmonic = out.emplace_back(guard.look_at(order));
    if (!harmonic.recovered) continue;
    const Complex part = sum[static_cast<std::size_t>(order)] / guard.layout.transfer(order);
    harmonic.amplitude_mm = 2.0 * std::abs(part) / static_cast<double>(count);
  }
  return out;
}

/// The low pass that the readings have passed, from all probes together.
std::optional<PassedFilter> passed_by(const ProbeSamples& samples, int highest) {
  std::vector<double> amplitude(static_cast<std::size_t>(last_untouched(samples.count, highest)));
  for (const auto& h : samples.mean_mm) {
    const Spectrum of_probe = spectrum(h);
    for (std::size_t k = 0; k < amplitude.size(); ++k) {
      const double now = 2.0 * std::abs(of_probe[k]) / static_cast<double>(samples.count);
      amplitude[k] = std::hypot(amplitude[k], now);
    }
  }
  return passed_filter(amplitude);
}

/// Divides the part by what the mean over tips leaves of it: 2 J1(x)/x. The motion, for which
/// counts what the probes see, is separated before. Source: methods, analyses_uncertainty 2.1.
void take_out_tips(double width_mm, double part_radius_mm, Spectrum part,
                   ThreeProbeResult& result) {
  constexpr double kWidest = 2.5;
  result.tip_width_mm = width_mm;
  double power = 0.0;
  for (auto* const table : {&result.harmonics, &result.beyond}) {
    for (RecoveredHarmonic& h : *table) {
      const double x = h.order * 0.5 * width_mm / part_radius_mm;
      h.tip = x > kWidest ? 0.0 : 2.0 * std::cyl_bessel_j(1.0, x) / x;
      const double raised = h.tip > 0.0 ? 1.0 / h.tip : 0.0;
      h.amplitude_mm *= raised;
      h.sigma_mm *= raised;
      if (h.tip == 0.0) h.phase_rad.reset();
      if (table == &result.beyond) continue;
      part[static_cast<std::size_t>(h.order)] *= raised;
      if (h.recovered) power += h.sigma_mm * h.sigma_mm;
    }
  }
  result.profile_sigma_mm = std::sqrt(power);
  result.profile.r_mm = series_of(part, result.profile.r_mm.size());
}

/// Computes the half spectrum of the part, and its harmonics as a table.
Spectrum recover(const Spectrum& sum, const Guard& guard, std::size_t count, double start_rad,
                 ThreeProbeResult& result) {
  Spectrum part(sum.size());
  result.harmonics.clear();
  result.unrecovered.clear();
  double power = 0.0;
  for (int order = 2; order <= guard.options.highest; ++order) {
    RecoveredHarmonic harmonic = guard.look_at(order);
    const auto k = static_cast<std::size_t>(order);
    if (harmonic.recovered) {
      part[k] = sum[k] / guard.layout.transfer(order);
      harmonic.amplitude_mm = 2.0 * std::abs(part[k]) / static_cast<double>(count);
      if (harmonic.amplitude_mm > kPhaseFrom * harmonic.sigma_mm) {
        harmonic.phase_rad = std::remainder(-std::arg(part[k]) + order * start_rad, core::kTwoPi);
      }
      power += harmonic.sigma_mm * harmonic.sigma_mm;
    } else {
      result.unrecovered.push_back(order);
    }
    result.harmonics.push_back(harmonic);
  }
  result.profile_sigma_mm = std::sqrt(power);
  result.profile = {start_rad, series_of(part, count)};
  return part;
}

void judge_residual(const Spectrum& sum, const Spectrum& part, const ProbeSamples& samples,
                    ThreeProbeResult& result) {
  const auto n = static_cast<double>(samples.count);
  const double norm = result.layout.weight_norm();
  double power = 0.0;
  double largest = 0.0;
  for (std::size_t k = 1; 2 * k < samples.count; ++k) {
    const bool recovered = part[k] != Complex();
    const Complex left =
        recovered ? sum[k] - part[k] * result.layout.transfer(static_cast<int>(k)) : sum[k];
    power += 2.0 * std::norm(left) / (n * n);
  }
  for (const auto& h : samples.mean_mm) {  // the zero of a probe is not a displacement
    largest = std::max(largest, 0.5 * column_extremes(h).width());
  }
  result.residual_rms_mm = std::sqrt(power) / norm;
  result.first_harmonic_mm = 2.0 * std::abs(sum[1]) / n / norm;
  result.first_harmonic_limit_mm =
      std::max(3.0 * result.noise_mm * std::sqrt(2.0 / static_cast<double>(samples.rows)),
               kBelowProbes * largest);
  // A gain error g of probe i leaves |c w_i g| there; twice the limit exceeds any noise.
  const auto& w = result.layout.weights();
  const double least_weight = std::min({w[0], std::abs(w[1]), std::abs(w[2])});
  if (result.eccentricity_mm > 0.0) {
    result.least_error_shown =
        2.0 * result.first_harmonic_limit_mm * norm / (result.eccentricity_mm * least_weight);
  }
}

double largest_motion_mm(const CentreMotion& motion) {
  return std::max(largest_magnitude(motion.x_mm), largest_magnitude(motion.y_mm));
}

void add(ThreeProbeResult& result, Code code, std::string what) {
  result.warnings.push_back({code, std::move(what)});
}

std::string orders_in_words(const std::vector<int>& orders) {
  std::string out;
  for (const int order : orders) out += fmt::format("{}{}", out.empty() ? "" : ", ", order);
  return out;
}

/// Adds warnings for harmonics that are lost or weak.
void warn_of_loss(const ThreeProbeOptions& options, ThreeProbeResult& result) {
  if (!result.unrecovered.empty()) {
    add(result, Code::kHarmonicLoss,
        fmt::format("harmonics {} are not recovered: their noise gain is above {:g}; the part may "
                    "hold more, and the motion holds it with the opposite sign",
                    orders_in_words(result.unrecovered), options.greatest_gain));
  }
  std::vector<int> weak;
  for (const RecoveredHarmonic& h : result.harmonics) {
    if (h.recovered && h.gain > options.warn_gain) weak.push_back(h.order);
  }
  if (weak.empty()) return;
  add(result, Code::kHarmonicLoss,
      fmt::format("harmonics {} are weak: their noise gain is above {:g}", orders_in_words(weak),
                  options.warn_gain));
}

void warn_of_sampling(const ProbeSamples& samples, const ThreeProbeOptions& options,
                      ThreeProbeResult& result) {
  if (samples.rows < static_cast<std::size_t>(7 * options.highest * samples.revolutions)) {
    add(result, Code::kSampling,
        fmt::format("{} readings a revolution are fewer than 7 an undulation at harmonic {}; "
                    "higher undulations of the part fold into the result",
                    samples.rows / static_cast<std::size_t>(samples.revolutions), options.highest));
  }
  if (samples.largest_gap_rad > core::kTwoPi / (2.0 * options.highest)) {
    add(result, Code::kSampling,
        fmt::format("a gap of {:.3f} deg between readings is wider than half an undulation of "
                    "harmonic {}",
                    samples.largest_gap_rad / core::kDegree, options.highest));
  }
}

/// A.8, if the options require it: repeats recovery and motion with corrected readings.
/// @return kUnits if the motion is too large compared with the part for A.8 to converge.
core::Result<void> refine_second_order(double part_radius_mm, const Guard& guard,
                                       ProbeSamples& samples, Spectrum& sum, Spectrum& part,
                                       ThreeProbeResult& result) {
  using SecondOrder = ThreeProbeOptions::SecondOrder;
  const SecondOrder asked = guard.options.second_order;
  const double motion = largest_motion_mm(motion_without_zeros(result));
  const bool large = motion > kSecondOrderFrom_mm;
  if (asked == SecondOrder::kOff || (asked == SecondOrder::kAuto && !large)) return {};
  if (!(part_radius_mm > 0.0)) {
    add(result, Code::kInconsistent,
        "motion above 10 um needs the second-order correction, and that the radius of the part; it "
        "is not stated");
    return {};
  }
  const ProbeSamples measured = samples;
  double before = 0.0;
  double change = 0.0;
  for (int pass = 0; pass < kSecondOrderPasses; ++pass) {
    const double now = correct_second_order(measured, part, result, part_radius_mm, samples);
    change = std::abs(now - before);
    before = now;
    if (!std::isfinite(now)) break;
    sum = weighted_spectrum(samples, guard.layout);
    part = recover(sum, guard, samples.count, samples.start_rad, result);
    separate_motion(samples, part, guard.options, result);
    ++result.second_order_passes;
    if (change < kSecondOrderDone_mm) return {};
  }
  if (change <= kSecondOrderSettled * before) return {};
  return core::fail_with(Code::kUnits,
                         "the readings say that the axis moves by {:.4g} mm; for a part of radius "
                         "{:g} mm that is too much to be corrected to the second order: look at "
                         "the unit of the columns (um) and for marks of missing values",
                         motion, part_radius_mm);
}

/// Names motion against the work, which is no eccentricity, and what the probes would say with
/// their angles counted in the other sense: the weights, and so all checks of them, are the same.
void judge_sense(const ProbeSamples& samples, const Guard& guard, ThreeProbeResult& result) {
  if (!result.turns_against_work()) return;
  const auto layout = ProbeLayout::of(-guard.layout.phi2_rad(), -guard.layout.phi3_rad());
  assert(layout);
  ThreeProbeResult other{.layout = *layout};
  other.revolutions = result.revolutions;
  other.alpha_rad = result.alpha_rad;
  other.beta_rad = result.beta_rad;
  const Guard turned{guard.options, *layout, guard.noise_mm, guard.values};
  const Spectrum part =
      recover(weighted_spectrum(samples, *layout), turned, samples.count, samples.start_rad, other);
  separate_motion(samples, part, guard.options, other);
  const auto um = [](double mm) { return fmt::format("{:.3g} um", core::micrometres(mm)); };
  result.contradictions.push_back(
      {Code::kInconsistent,
       fmt::format("once a turn, {} turn against the work and {} with it, as an eccentricity does; "
                   "with the probe angles counted in the other sense, {} and {}: {}",
                   um(result.against_work_mm), um(result.eccentricity_mm),
                   um(other.against_work_mm), um(other.eccentricity_mm),
                   other.turns_against_work()
                       ? "look at the order of the columns and at the angles of the probes"
                       : "state the angles with the other sign")});
  result.warnings.push_back(result.contradictions.back());
}

}  // namespace

core::Result<ThreeProbeResult> separate_three_probe(const ProbeReadings& readings,
                                                    const SwingArm& arm, const ProbeLayout& layout,
                                                    const ThreeProbeOptions& options) {
  TRY_DO(check_options(options, arm.pin_radius_mm));
  TRY_DO(check_swing_arm(arm));
  TRY(auto sampled, sample_readings(readings, arm, options));
  ProbeSamples samples = std::move(sampled);
  if (samples.count < static_cast<std::size_t>(2 * options.highest + 2)) {
    return core::fail_with(
        Code::kSampling,
        "{} samples a revolution do not carry {} undulations; at least {} are needed",
        samples.count, options.highest, 2 * options.highest + 2);
  }
  ThreeProbeResult result{.layout = layout};
  result.revolutions = samples.revolutions;
  result.readings = samples.rows;
  result.interpolated = samples.interpolated;
  result.alpha_rad = samples.alpha_rad;
  result.beta_rad = samples.beta_rad;
  Spectrum sum = weighted_spectrum(samples, layout);
  const auto noise = options.noise_mm ? options.noise_mm
                                      : estimated_noise_mm(samples, sum, layout, options.highest);
  if (!noise) {
    return core::fail_with(
        Code::kSampling,
        "one revolution of {} samples holds no harmonic above {} from which the noise of a reading "
        "could be estimated: state it, record a second revolution or take at least {} samples",
        samples.count, options.highest, 4 * options.highest);
  }
  result.noise_estimated = !options.noise_mm;
  result.noise_mm = *noise;
  const Guard guard{options, layout, result.noise_mm, static_cast<double>(samples.rows)};
  Spectrum part = recover(sum, guard, samples.count, samples.start_rad, result);
  separate_motion(samples, part, options, result);
  TRY_DO(refine_second_order(arm.pin_radius_mm, guard, samples, sum, part, result));
  judge_residual(sum, part, samples, result);
  result.beyond = beyond_of(sum, guard, samples.count);
  result.passed = passed_by(samples, options.highest);
  result.mean_readings_mm = samples.mean_mm;
  result.drift_mm = drift_per_turn(samples);
  result.scatter_mm = scatter_by_order_mm(samples, layout, options.highest);
  warn_of_loss(options, result);
  warn_of_sampling(samples, options, result);
  find_contradictions(readings, samples, arm, options, result);
  judge_sense(samples, guard, result);
  if (options.tip_width_mm > 0.0) {
    take_out_tips(options.tip_width_mm, arm.pin_radius_mm, std::move(part), result);
  }
  return result;
}

}  // namespace rondure::fit
