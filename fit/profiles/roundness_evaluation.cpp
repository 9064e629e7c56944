#include "fit/profiles/roundness_evaluation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/least_squares/circle.h"

namespace rondure::fit {
namespace {

constexpr double kLeastArcDeg = 20.0;
constexpr double kFullCircleGapDeg = 90.0;
constexpr std::size_t kSparsePoints = 7;

void warn(RoundnessEvaluation& out, core::Code code, std::string what) {
  out.warnings.push_back({code, std::move(what)});
}

void warn_of_order(RoundnessEvaluation& out) {
  const AngularProfile& profile = out.measured;
  if (profile.reversals > 0) {
    warn(out, core::Code::kAngleOrder,
         fmt::format("{} angles go back against the others; the rows were sorted by angle",
                     profile.reversals));
  }
  if (profile.merged > 0) {
    warn(out, core::Code::kAngleOrder,
         fmt::format("{} values repeat an angle; each such angle carries the mean of its values",
                     profile.merged));
  }
  if (profile.turns > 1.0 + 1e-6) {
    warn(out, core::Code::kAngleOrder,
         fmt::format("the angles run through {:.2f} turns; the turns were laid over each other",
                     profile.turns));
  }
}

/// Checks the gaps of the profile: an arc gets a warning, a very short arc an error.
core::Result<void> check_coverage(RoundnessEvaluation& out) {
  const double gap_deg = out.measured.largest_gap_rad / core::kDegree;
  if (360.0 - gap_deg < kLeastArcDeg) {
    return core::fail_with(
        core::Code::kNotFullSection,
        "the points cover {:.2f} deg; a circle with free radius needs at least 20 deg",
        360.0 - gap_deg);
  }
  if (gap_deg >= kFullCircleGapDeg) {
    warn(out, core::Code::kNotFullSection,
         fmt::format("the points cover {:.1f} deg; the free circle follows part of the form, so "
                     "RONt is a lower bound",
                     360.0 - gap_deg));
  }
  if (out.measured.r_mm.size() < kSparsePoints) {
    warn(
        out, core::Code::kSparse,
        fmt::format("{} points; RONt is a lower bound of the section's", out.measured.r_mm.size()));
  }
  return {};
}

/// Checks that no gap can hide undulations that the filter should pass.
core::Result<void> check_gap(RoundnessEvaluation& out) {
  if (out.filter.filter == ProfileFilter::kNone) return {};
  auto checked = check_gaps(out.measured, out.filter.highest_cutoff_upr());
  if (checked || !out.filter.override_sampling) return checked;
  out.sampling.overridden = true;
  return {};
}

/// Fills in the filtered profile of `measured`; without a filter, the profile itself.
core::Result<void> fill_filtered(RoundnessEvaluation& out) {
  TRY(const auto sampling, check_sampling(out.measured.r_mm.size(), out.filter));
  if (out.filter.filter == ProfileFilter::kNone) {
    out.theta_rad = out.measured.theta_rad;
    out.r_mm = out.measured.r_mm;
    return {};
  }
  out.sampling = sampling;
  if (auto checked = check_gap(out); !checked) return checked;
  if (out.sampling.overridden) {
    warn(
        out, core::Code::kUndersampled,
        fmt::format("filtered by option although {} points ({:.2f} per undulation, largest gap "
                    "{:.4g} deg) do not carry {} UPR",
                    out.measured.r_mm.size(), out.sampling.points_per_undulation,
                    out.measured.largest_gap_rad / core::kDegree, out.filter.highest_cutoff_upr()));
  }
  TRY(const auto even, resampled(out.measured));
  TRY(auto filtered, filter_closed(even.profile.r_mm, out.filter));
  out.interpolated = even.interpolated;
  out.resampling_error_mm = even.error_mm;
  out.filter_iterations = filtered.iterations;
  if (filtered.scale_floored) {
    warn(out, core::Code::kNotConverged,
         "the median scale of the robust filter did not settle: the profile is smoother than the "
         "filter's own attenuation; the scale was kept above that (docs/filters.md)");
  }
  for (std::size_t i = 0; i < filtered.r_mm.size(); ++i) {
    out.theta_rad.push_back(even.profile.angle_rad(i));
  }
  out.r_mm = std::move(filtered.r_mm);
  return {};
}

/// Fills in the requested harmonics, as far as the points determine them.
core::Result<void> fill_harmonics(RoundnessEvaluation& out, int asked) {
  const double gap = out.measured.largest_gap_rad;
  const auto carried = std::min(static_cast<double>(out.measured.r_mm.size() / 7),
                                std::floor(0.5 * std::numbers::pi / gap));
  HarmonicOptions options;
  options.highest = static_cast<int>(std::min(static_cast<double>(asked), carried));
  if (options.highest < 1 || gap >= kFullCircleGapDeg * core::kDegree) return {};
  TRY(out.harmonics, out.measured.uniform()
                         ? harmonics({out.measured.theta_rad[0], out.measured.r_mm}, options)
                         : harmonic_fit(out.measured, options));
  return {};
}

/// The steps common to profiles and points, up to the values to be fitted.
core::Result<RoundnessEvaluation> prepared(std::span<const double> theta, std::span<const double> r,
                                           const RoundnessOptions& options) {
  TRY(auto measured, ordered_profile(theta, r));
  RoundnessEvaluation out;
  out.points = r.size();
  out.filter = options.filter;
  out.measured = std::move(measured);
  TRY_DO(check_coverage(out));
  TRY_DO(fill_filtered(out));
  TRY_DO(fill_harmonics(out, options.highest_harmonic));
  return out;
}

/// Points of the filtered profile about the circle from which its deviations were taken.
std::vector<Eigen::Vector2d> points_of(const RoundnessEvaluation& out, const LsCircle& circle) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(out.r_mm.size());
  for (std::size_t i = 0; i < out.r_mm.size(); ++i) {
    const Eigen::Vector2d n(std::cos(out.theta_rad[i]), std::sin(out.theta_rad[i]));
    points.emplace_back(circle.center_mm + (circle.radius_mm + out.r_mm[i]) * n);
  }
  return points;
}

/// The cell of every row, see angular_cells(), in the order of the rows.
std::vector<double> cells_of_rows(std::span<const double> theta) {
  std::vector<std::size_t> order(theta.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t row) { return theta[row]; });
  std::vector<double> sorted;
  for (const std::size_t row : order) sorted.push_back(theta[row]);
  const auto cells = angular_cells(sorted);
  std::vector<double> out(theta.size());
  for (std::size_t i = 0; i < order.size(); ++i) out[order[i]] = cells[i];
  return out;
}

/// Adds the value of one reference, or a warning if the reference does not exist.
core::Result<void> add_value(RoundnessEvaluation& out, CircleReference reference,
                             core::Result<Roundness> value) {
  if (value) {
    if (value->range) {
      warn(
          out, core::Code::kSeveralOptima,
          fmt::format(
              "the {} circle is not unique: about circles whose radius agrees to 1 nm RONt "
              "is anything from {:.4f} to {:.4f} um",
              reference == CircleReference::kMc ? "minimum circumscribed" : "maximum inscribed",
              value->range->low_mm / core::kMicrometre, value->range->high_mm / core::kMicrometre));
    }
    out.values.push_back(*std::move(value));
    return {};
  }
  if (value.error().code != core::Code::kReferenceAbsent) return core::fail(value.error());
  out.absent.push_back(reference);
  out.warnings.push_back(value.error());
  return {};
}

}  // namespace

core::Result<RoundnessEvaluation> evaluate_profile(std::span<const double> theta_rad,
                                                   std::span<const double> r_mm,
                                                   const RoundnessOptions& options) {
  auto out = prepared(theta_rad, r_mm, options);
  if (!out) return out;
  warn_of_order(*out);
  out->samples = out->r_mm.size();
  const auto cells = angular_cells(out->theta_rad);
  for (const CircleReference reference : options.references) {
    auto value =
        roundness_of_profile(out->theta_rad, out->r_mm, reference, {cells, options.inside});
    TRY_DO(add_value(*out, reference, std::move(value)));
  }
  return out;
}

core::Result<RoundnessEvaluation> evaluate_section(PlanePoints points_mm,
                                                   const RoundnessOptions& options) {
  TRY(const auto circle, ls_circle(points_mm));
  std::vector<double> theta;
  std::vector<double> r;
  for (const Eigen::Vector2d& p : points_mm) {
    const Eigen::Vector2d v = p - circle.center_mm;
    theta.push_back(std::atan2(v.y(), v.x()));
    r.push_back(v.norm() - circle.radius_mm);
  }
  auto out = prepared(theta, r, options);
  if (!out) return out;
  std::vector<Eigen::Vector2d> points(points_mm.begin(), points_mm.end());
  if (options.filter.filter == ProfileFilter::kNone) {  // every point, also those of one angle
    out->theta_rad = theta;
    out->r_mm = r;
  } else {
    points = points_of(*out, circle);
  }
  out->samples = points.size();
  const auto cells = cells_of_rows(out->theta_rad);
  for (const CircleReference reference : options.references) {
    auto value = roundness_of_points(points, reference, {cells, options.inside});
    TRY_DO(add_value(*out, reference, std::move(value)));
  }
  return out;
}

}  // namespace rondure::fit
