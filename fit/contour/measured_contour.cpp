#include "fit/contour/measured_contour.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/profiles/closed_profile.h"
#include "fit/profiles/internal/dft.h"
#include "fit/profiles/periodic_spline.h"

namespace rondure::fit {
namespace {

constexpr double kLargestGap = 1.0 * core::kDegree;
constexpr double kMissingGap = 1.6;
constexpr double kFilteredRms = 0.01 * core::kMicrometre;
constexpr double kFilteredShare = 0.01;
constexpr double kFilterTraceFrom = 3.0;  ///< Start of the range, as a multiple of the cut-off.
/// Of the undulations that the rows resolve, those that interpolation leaves as they are.
constexpr double kInterpolated = 0.75;
constexpr double kLeastRange = 0.05 * core::kMicrometre;
constexpr double kGreatestRange = 1.0;  ///< mm

core::Result<void> check(std::span<const double> angle, std::span<const double> deviation,
                         const MeasuredContourOptions& options) {
  if (angle.size() != deviation.size()) {
    return core::fail_with(core::Code::kMeaning, "{} angles and {} deviations; one of each a row",
                           angle.size(), deviation.size());
  }
  if (options.direction != 1 && options.direction != -1) {
    return core::fail_with(core::Code::kMeaning, "a direction of {}; it is 1 or -1",
                           options.direction);
  }
  if (angle.size() < kLeastContourPoints) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} points of the contour; at least {} are needed", angle.size(),
                           kLeastContourPoints);
  }
  for (std::size_t i = 0; i < angle.size(); ++i) {
    if (core::is_measurable(angle[i]) && core::is_measurable(deviation[i])) continue;
    return core::fail_with(
        core::Code::kNotFinite,
        "row {} of the contour is ({} rad, {} mm); both must be finite numbers up to {:g}", i,
        angle[i], deviation[i], core::kGreatestNumber);
  }
  return {};
}

/// Refuses angles with a step against the first step, and names the row, and more than one turn:
/// rows at the same angle would be averaged.
core::Result<void> check_order(std::span<const double> angle) {
  const double sense = std::remainder(angle[1] - angle[0], core::kTwoPi);
  double turned = 0.0;
  for (std::size_t i = 1; i < angle.size(); ++i) {
    const double step = std::remainder(angle[i] - angle[i - 1], core::kTwoPi);
    if (!(step * sense > 0.0)) {
      return core::fail_with(core::Code::kAngleOrder,
                             "the angle stands still or goes back at row {}, by {:.4g} deg; a "
                             "contour runs one way round",
                             i, std::abs(step) / core::kDegree);
    }
    turned += std::abs(step);
    if (turned <= core::kTwoPi + kLargestGap) continue;
    return core::fail_with(core::Code::kAngleOrder,
                           "the angles go on at row {}, where a turn is complete; a contour is "
                           "one turn of one part: give each a file of its own",
                           i);
  }
  return {};
}

core::Result<void> check_contour_gap(const AngularProfile& profile, std::size_t rows) {
  if (profile.largest_gap_rad <= kLargestGap * (1.0 + 1e-9)) return {};
  const double span_deg = (core::kTwoPi - profile.largest_gap_rad) / core::kDegree;
  return core::fail_with(
      core::Code::kNotFullSection,
      "{} rows leave a gap of {:.4g} deg; the whole contour is needed with gaps of at most 1 deg{}",
      rows, profile.largest_gap_rad / core::kDegree,
      std::abs(span_deg - core::kTwoPi) < 0.2
          ? " (the angles fill one turn in radians: give degrees)"
          : "");
}

/// Examines the content of a contour at uniform angles above the cut-off.
/// @param resolved_upr  Undulations that the rows of the gauge resolve, half their number; below 4
///                      times the cut-off no statement is possible.
FilterTrace filter_trace(std::span<const double> deviation_mm, double cutoff_upr,
                         double resolved_upr) {
  const auto f = spectrum(deviation_mm);
  std::vector<double> amplitude(f.size());
  const auto known = static_cast<std::size_t>(kInterpolated * resolved_upr);
  double form = 0.0;
  double upper = 0.0;
  for (std::size_t k = 2; k < f.size(); ++k) {
    amplitude[k] = 2.0 * std::abs(f[k]) / static_cast<double>(deviation_mm.size());
    const double square = 0.5 * amplitude[k] * amplitude[k];
    form += square;
    if (static_cast<double>(k) > kFilterTraceFrom * cutoff_upr) upper += square;
  }
  FilterTrace out;
  out.upper_rms_mm = std::sqrt(upper);
  out.filtered = resolved_upr > 4.0 * cutoff_upr && out.upper_rms_mm < kFilteredRms &&
                 out.upper_rms_mm < kFilteredShare * std::sqrt(form);
  out.passed = passed_filter(std::span(amplitude).first(std::min(known, amplitude.size())));
  return out;
}

void warn(MeasuredContour& out, core::Code code, std::string what) {
  out.warnings.push_back({code, std::move(what)});
}

void warn_of_filter(MeasuredContour& out, const MeasuredContourOptions& options) {
  const FilterTrace& trace = out.filter;
  const double upper_um = trace.upper_rms_mm / core::kMicrometre;
  const double from = kFilterTraceFrom * options.error.filter.cutoff_upr;
  if (trace.filtered && !options.error.filtered_already) {
    warn(out, core::Code::kFilteredTwice,
         fmt::format("above {} UPR only {:.2g} um rms are left{}: the gauge seems to have filtered "
                     "already, and the filter is applied twice; if so, say prefiltered",
                     from, upper_um,
                     trace.passed ? fmt::format(", falling as behind a Gaussian filter of {:.0f} "
                                                "UPR",
                                                trace.passed->cutoff_upr)
                                  : ""));
  }
  if (options.error.filtered_already && trace.other_than(options.error.filter.cutoff_upr)) {
    warn(
        out, core::Code::kInconsistent,
        fmt::format("noise and roughness fall as behind a Gaussian filter of {:.0f} UPR, the gauge "
                    "is said to have filtered at {:g} UPR: state the cut-off of the gauge",
                    trace.passed->cutoff_upr, options.error.filter.cutoff_upr));
  } else if (!trace.filtered && options.error.filtered_already) {
    warn(out, core::Code::kFilteredTwice,
         fmt::format("the contour is said to be filtered, but {:.2g} um rms stand above {} UPR; "
                     "without prefiltered the filter would be applied",
                     upper_um, from));
  }
}

/// Warns of content lost by sampling: without a filter, the samples themselves act as one.
void warn_of_loss(MeasuredContour& out, std::span<const double> all_rows,
                  const MeasuredContourOptions& options) {
  if (options.error.filter.filter != ProfileFilter::kNone && !options.error.filtered_already)
    return;
  const double untouched = last_untouched(options.samples, 0.0);
  const double lost = filter_trace(all_rows, untouched / kFilterTraceFrom, 0.0).upper_rms_mm;
  if (all_rows.size() <= options.samples || lost < kFilteredRms) return;
  warn(out, core::Code::kUndersampled,
       fmt::format(
           "{:.2g} um rms of the contour lie above {:.0f} UPR, which {} samples do not carry "
           "whole; ask for more samples, or filter",
           lost / core::kMicrometre, untouched, options.samples));
}

void warn_of_rows(MeasuredContour& out, const AngularProfile& profile) {
  const double even = core::kTwoPi / static_cast<double>(profile.theta_rad.size());
  if (profile.largest_gap_rad > kMissingGap * even) {
    warn(out, core::Code::kSparse,
         fmt::format("a gap of {:.4g} deg where the mean step is {:.4g} deg: samples are missing "
                     "and were interpolated",
                     profile.largest_gap_rad / core::kDegree, even / core::kDegree));
  }
  const double range = out.contour.peak_to_valley_mm;
  if (range < kLeastRange || range > kGreatestRange) {
    warn(out, core::Code::kUnits,
         fmt::format("the contour runs over {:.3g} um; that is {}: is the unit right?",
                     range / core::kMicrometre,
                     range < kLeastRange ? "less than 0.05 um" : "more than 1 mm"));
  }
}

/// A gauge that drifts over the turn leaves a step between its last row and its first.
void measure_seam(std::span<const double> angle_rad, std::span<const double> rows_mm,
                  MeasuredContour& out) {
  const std::size_t n = rows_mm.size();
  std::vector<double> bends(n);
  for (std::size_t i = 0; i < n; ++i) {
    bends[i] = rows_mm[(i + 1) % n] - 2.0 * rows_mm[i] + rows_mm[(i + n - 1) % n];
  }
  const double apart = std::abs(std::remainder(angle_rad[0] - angle_rad[n - 1], core::kTwoPi)) *
                       static_cast<double>(n) / core::kTwoPi;
  if (apart < 0.1) out.seam_mm = std::abs(rows_mm[0] - rows_mm[n - 1]);  // the turn is closed
  if (std::abs(apart - 1.0) < 0.5) out.seam_mm = 0.5 * std::abs(bends[n - 1] - bends[0]);
  for (double& bend : bends) bend = std::abs(bend);
  out.rough_mm = core::kSigmaPerMedianDeviation * core::median(std::move(bends));
}

}  // namespace

core::Result<MeasuredContour> measured_contour(std::span<const double> angle_rad,
                                               std::span<const double> deviation_mm,
                                               const MeasuredContourOptions& options) {
  TRY_DO(check(angle_rad, deviation_mm, options));
  TRY_DO(check_order(angle_rad));
  std::vector<double> beta(angle_rad.size());
  std::ranges::transform(angle_rad, beta.begin(), [&](double angle) {
    return options.direction * (angle - options.phase_offset_rad);
  });
  TRY(const auto profile, ordered_profile(beta, deviation_mm));
  TRY_DO(check_contour_gap(profile, angle_rad.size()));
  if (!options.error.filtered_already) {
    TRY_DO(check_sampling(angle_rad.size(), options.error.filter));
  }
  const std::vector<double> even = even_samples(profile.theta_rad, profile.r_mm, options.samples);
  TRY(auto contour, contour_error(even, options.nominal_mm, options.error));
  MeasuredContour out;
  out.contour = std::move(contour);
  out.rows = angle_rad.size();
  out.largest_gap_rad = profile.largest_gap_rad;
  measure_seam(angle_rad, deviation_mm, out);
  // A filter of the gauge shows in all rows; fewer samples would hide the upper harmonics.
  const std::vector<double> all_rows =
      even_samples(profile.theta_rad, profile.r_mm, std::max(options.samples, profile.r_mm.size()));
  out.filter =
      filter_trace(all_rows, options.error.filter.cutoff_upr, 0.5 * static_cast<double>(out.rows));
  warn_of_filter(out, options);
  warn_of_loss(out, all_rows, options);
  warn_of_rows(out, profile);
  return out;
}

}  // namespace rondure::fit
