#include "fit/contour/axis_trace.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/profiles/internal/dft.h"
#include "fit/profiles/periodic_spline.h"

namespace rondure::fit {
namespace {

constexpr double kMargin = 0.2;  ///< Margin beside the turn, for the ends of the spline [rad].
/// Least step at a missing sample, as a multiple of the neighbouring steps.
constexpr double kMissingStep = 1.6;
constexpr double kLargeX = 0.5;  ///< mm
constexpr double kLargeC = 0.5 * core::kDegree;
constexpr double kLargeMeanX = 0.1;  ///< mm

core::Result<void> check(const AxisTrace& trace, const AxisTraceOptions& options) {
  const std::size_t n = trace.c_rad.size();
  if (trace.c_error_rad.size() != n || trace.x_error_mm.size() != n ||
      (!trace.x_mm.empty() && trace.x_mm.size() != n)) {
    return core::fail_with(core::Code::kMeaning,
                           "{} positions of C, {} errors of C, {} errors and {} positions of X; "
                           "one row each for all that are given",
                           n, trace.c_error_rad.size(), trace.x_error_mm.size(), trace.x_mm.size());
  }
  for (const int sign : {options.error_sign, options.c_direction}) {
    if (sign == 1 || sign == -1) continue;
    return core::fail_with(core::Code::kMeaning, "a sign or direction of {}; it is 1 or -1", sign);
  }
  if (n < kLeastTurnSamples) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} samples of the axes; at least {} are needed", n, kLeastTurnSamples);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double x = trace.x_mm.empty() ? 0.0 : trace.x_mm[i];
    if (core::is_measurable(trace.c_rad[i]) && core::is_measurable(trace.c_error_rad[i]) &&
        core::is_measurable(trace.x_error_mm[i]) && core::is_measurable(x)) {
      continue;
    }
    return core::fail_with(core::Code::kNotFinite,
                           "row {} of the axes is (C {} rad, error of C {} rad, X {} mm, error of "
                           "X {} mm); all must be finite numbers up to {:g}",
                           i, trace.c_rad[i], trace.c_error_rad[i], x, trace.x_error_mm[i],
                           core::kGreatestNumber);
  }
  return {};
}

/// The trace with the sense and sign of the method, continuous, alpha ascending.
struct Oriented {
  AxisTrace rows;
  bool reversed = false;  ///< The row recorded last is the first.
};

Oriented oriented(const AxisTrace& trace, const AxisTraceOptions& options) {
  AxisTrace out = trace;
  const double sense = options.c_direction;
  const double sign = options.error_sign;
  for (double& c : out.c_rad) c *= sense;
  for (double& c : out.c_error_rad) c *= sense * sign;
  for (double& x : out.x_error_mm) x *= sign;
  for (std::size_t i = 1; i < out.c_rad.size(); ++i) {
    const double step = out.c_rad[i] - out.c_rad[i - 1];
    // A jump by more than half a turn means wrapping, as no trace has true steps of that size.
    if (std::abs(step) > 0.5 * core::kTwoPi) {
      out.c_rad[i] = out.c_rad[i - 1] + std::remainder(step, core::kTwoPi);
    }
  }
  const bool reversed = out.c_rad.back() < out.c_rad.front();
  if (reversed) {
    for (auto* column : {&out.c_rad, &out.c_error_rad, &out.x_error_mm, &out.x_mm}) {
      std::reverse(column->begin(), column->end());
    }
  }
  return {std::move(out), reversed};
}

/// @param reversed  The rows of the caller are in the opposite order.
core::Result<void> check_steps(const std::vector<double>& alpha, bool reversed) {
  const std::size_t n = alpha.size();
  const auto row = [&](std::size_t i) { return reversed ? n - 1 - i : i; };
  for (std::size_t i = 1; i < n; ++i) {
    if (alpha[i] > alpha[i - 1]) continue;
    return core::fail_with(
        core::Code::kAngleOrder,
        "C stands still or goes back at row {}, by {:.4g} deg; it must turn one way all the time",
        std::max(row(i), row(i - 1)), (alpha[i - 1] - alpha[i]) / core::kDegree);
  }
  for (std::size_t i = 1; i < n; ++i) {
    const double step = alpha[i] - alpha[i - 1];
    const double before = i > 1 ? alpha[i - 1] - alpha[i - 2] : 0.0;
    const double after = i + 1 < n ? alpha[i + 1] - alpha[i] : 0.0;
    if (step <= kMissingStep * std::max(before, after)) continue;
    return core::fail_with(
        core::Code::kSampling,
        "C steps {:.4g} deg at row {} and {:.4g} deg beside it: samples are missing",
        step / core::kDegree, std::max(row(i), row(i - 1)),
        std::max(before, after) / core::kDegree);
  }
  return {};
}

/// The step between two rows as recorded; a return to zero is not a step.
double recorded_step(const std::vector<double>& c_rad) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < c_rad.size(); ++i) {
    steps.push_back(std::abs(c_rad[i] - c_rad[i - 1]));
  }
  return core::upper_median(std::move(steps));
}

/// Rows [first, end) of one turn, and whether rows on both sides of it are included.
struct Cut {
  double start_rad = 0.0;
  std::size_t first = 0;
  std::size_t end = 0;
  bool margins = false;
};

std::size_t first_at(const std::vector<double>& alpha, double angle) {
  return static_cast<std::size_t>(std::ranges::lower_bound(alpha, angle - core::kSameAngle) -
                                  alpha.begin());
}

/// @param reversed  The turn recorded last is the one with the least angles.
core::Result<Cut> cut_of(const std::vector<double>& alpha, bool reversed) {
  const double span = alpha.back() - alpha.front();
  const double step = span / static_cast<double>(alpha.size() - 1);
  if (span + 1.5 * step < core::kTwoPi) {
    return core::fail_with(
        core::Code::kNotFullSection,
        "C turns by {:.4f} deg altogether; one whole turn of 360 deg is needed{}",
        span / core::kDegree,
        std::abs(span / core::kDegree - core::kTwoPi) < 0.2
            ? " (that is one turn in radians: give degrees)"
            : "");
  }
  Cut cut;
  // A turn is whole if the sample after the last recorded one would close it.
  const double lowest = alpha.front() - core::kSameAngle - (reversed ? step : 0.0);
  const double highest = alpha.back() + core::kSameAngle + (reversed ? 0.0 : step);
  cut.start_rad = reversed ? core::kTwoPi * std::ceil(lowest / core::kTwoPi)
                           : core::kTwoPi * (std::floor(highest / core::kTwoPi) - 1.0);
  if (cut.start_rad >= lowest && cut.start_rad + core::kTwoPi <= highest) {
    cut.margins = cut.start_rad - kMargin >= alpha.front() &&
                  cut.start_rad + core::kTwoPi + kMargin <= alpha.back();
  } else {
    // No turn from 0 to 0: the last 360 deg, closed.
    const double start = alpha.back() + step - core::kTwoPi;
    cut.start_rad = reversed
                        ? alpha.front()
                        : alpha[std::min(first_at(alpha, start - 0.5 * step), alpha.size() - 1)];
  }
  const double reserve = cut.margins ? kMargin : 0.0;
  // Where both ends of the turn have a row, use the one recorded first.
  const double open = reversed && cut.start_rad < alpha.front() ? 2.0 * core::kSameAngle : 0.0;
  cut.first = first_at(alpha, cut.start_rad - reserve + open);
  cut.end = first_at(alpha, cut.start_rad + core::kTwoPi + reserve + open);
  return cut;
}

/// Values of a turn at uniform command angles. With margins the rows extend beyond one turn; the
/// spline then has the longer period, so that its seam lies outside the turn.
std::vector<double> on_uniform(const std::vector<double>& alpha, const std::vector<double>& values,
                               const Cut& cut, std::size_t samples) {
  const double period = core::kTwoPi + (cut.margins ? 2.0 * kMargin + 0.05 : 0.0);
  const double scale = core::kTwoPi / period;
  const double origin = cut.margins ? cut.start_rad - kMargin - 0.025 : 0.0;
  std::vector<std::pair<double, double>> rows;
  for (std::size_t i = cut.first; i < cut.end; ++i) {
    const double turned = scale * (alpha[i] - origin);
    const double within = turned - core::kTwoPi * std::floor(turned / core::kTwoPi + 1e-12);
    rows.emplace_back(std::max(0.0, within), values[i]);
  }
  std::ranges::sort(rows);
  std::vector<double> angle;
  std::vector<double> value;
  for (const auto& [a, v] : rows) {
    angle.push_back(a);
    value.push_back(v);
  }
  const PeriodicSpline spline(std::move(angle), std::move(value));
  const double step =
      (alpha[cut.end - 1] - alpha[cut.first]) / static_cast<double>(cut.end - cut.first - 1);
  const auto each_turn = static_cast<std::size_t>(std::lround(core::kTwoPi / step));
  std::vector<double> fine(finer_count(each_turn, samples));
  for (std::size_t m = 0; m < fine.size(); ++m) {
    const double at = core::kTwoPi * static_cast<double>(m) / static_cast<double>(fine.size());
    fine[m] = spline(cut.margins ? scale * (at + cut.start_rad - origin) : at);
  }
  return decimated(fine, samples);
}

void warn_of_units(AxisTurn& turn) {
  const double x = largest_magnitude(turn.errors.x_mm);
  const double c = largest_magnitude(turn.errors.c_rad);
  const double mean = core::mean(turn.errors.x_mm);
  const auto warn = [&](std::string what) {
    turn.warnings.push_back({core::Code::kUnits, std::move(what)});
  };
  if (x > kLargeX) {
    warn(fmt::format("errors of X reach {:.4g} mm, above {} mm: is the unit right?", x, kLargeX));
  }
  if (c > kLargeC) {
    warn(fmt::format("errors of C reach {:.4g} deg, above {} deg: is the unit right?",
                     c / core::kDegree, kLargeC / core::kDegree));
  }
  if (std::abs(mean) > kLargeMeanX) {
    warn(fmt::format("the mean error of X is {:.4g} mm, above {} mm: an offset or another unit?",
                     mean, kLargeMeanX));
  }
}

}  // namespace

core::Result<AxisTurn> last_turn(const AxisTrace& trace, const AxisTraceOptions& options) {
  TRY_DO(check(trace, options));
  if (options.samples < kLeastTurnSamples) {
    return core::fail_with(core::Code::kBadOption,
                           "the axes on {} angles are asked for; at least {} are needed",
                           options.samples, kLeastTurnSamples);
  }
  const auto [rows, reversed] = oriented(trace, options);
  TRY_DO(check_steps(rows.c_rad, reversed));
  TRY(const auto cut, cut_of(rows.c_rad, reversed));
  AxisTurn out;
  const double span = rows.c_rad.back() - rows.c_rad.front();
  const double step = span / static_cast<double>(rows.c_rad.size() - 1);
  // A closed turn and one with margins may differ by a few; a spline needs three.
  if (2 * (cut.end - cut.first) < kLeastTurnSamples) {
    return core::fail_with(core::Code::kSampling,
                           "C steps by {:.4g} deg: the last turn has {} samples; at least {} are "
                           "needed; C is in degrees",
                           recorded_step(trace.c_rad) / core::kDegree, cut.end - cut.first,
                           kLeastTurnSamples);
  }
  out.samples_per_turn = core::kTwoPi / step;
  out.turns = (span + step) / core::kTwoPi;
  out.errors.c_rad = on_uniform(rows.c_rad, rows.c_error_rad, cut, options.samples);
  out.errors.x_mm = on_uniform(rows.c_rad, rows.x_error_mm, cut, options.samples);
  if (!rows.x_mm.empty()) out.x_mm = on_uniform(rows.c_rad, rows.x_mm, cut, options.samples);
  warn_of_units(out);
  return out;
}

}  // namespace rondure::fit
