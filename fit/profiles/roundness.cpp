#include "fit/profiles/roundness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/numbers.h"
#include "core/units.h"
#include "fit/least_squares/circle.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {
namespace {

/// Half side of the first box as a multiple of the deviation of the profile; grown where it binds.
constexpr double kFirstBox = 4.0;
constexpr double kBoxGrowth = 16.0;
constexpr int kBoxes = 12;

/// Parameters of the deviations from the circle (center, radius), with peaks positive.
template <class Radius>
FormParameters parameters_of(std::size_t count, const Radius& deviation,
                             const RoundnessSide& side) {
  std::vector<double> deviations(count);
  for (std::size_t i = 0; i < count; ++i) {
    deviations[i] = side.inside ? -deviation(i) : deviation(i);
  }
  return form_parameters(deviations, side.cells);
}

std::vector<std::size_t> rows_of(std::span<const Contact> contacts) {
  std::vector<std::size_t> rows;
  for (const Contact& c : contacts) rows.push_back(c.index);
  return rows;
}

core::Result<Roundness> ls_points(PlanePoints points, const RoundnessSide& side) {
  TRY(const auto circle, ls_circle(points));
  Roundness out;
  out.center_mm = circle.center_mm;
  out.radius_mm = circle.radius_mm;
  out.parameters = parameters_of(
      points.size(),
      [&](std::size_t i) { return (points[i] - circle.center_mm).norm() - circle.radius_mm; },
      side);
  out.total_mm = out.parameters->total_mm;
  return out;
}

core::Result<Roundness> mz_points(PlanePoints points) {
  TRY(const auto zone, min_zone_circle(points));
  Roundness out;
  out.reference = CircleReference::kMz;
  out.center_mm = zone.center_mm;
  out.radius_mm = 0.5 * (zone.inner_radius_mm + zone.outer_radius_mm);
  out.total_mm = zone.width_mm();
  out.outer = rows_of(zone.outer);
  out.inner = rows_of(zone.inner);
  out.certificate = zone.certificate;
  return out;
}

core::Result<Roundness> one_sided_points(PlanePoints points, CircleReference reference) {
  const bool outside = reference == CircleReference::kMc;
  TRY(const auto circle, outside ? min_circumscribed_circle(points) : max_inscribed_circle(points));
  Roundness out;
  out.reference = reference;
  out.center_mm = circle.center_mm;
  out.radius_mm = circle.radius_mm;
  out.total_mm = circle.deviation_mm;
  (outside ? out.outer : out.inner) = rows_of(circle.contacts);
  out.certificate = circle.certificate;
  out.range = circle.range;
  return out;
}

core::Result<void> check_profile(std::span<const double> theta, std::span<const double> r,
                                 std::size_t least) {
  if (theta.size() != r.size() || theta.empty()) {
    return core::fail_with(core::Code::kNoPoints,
                           "{} angles and {} radii; a profile needs as many of both", theta.size(),
                           r.size());
  }
  if (theta.size() < least) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} points; this reference circle needs at least {}", theta.size(),
                           least);
  }
  for (std::size_t i = 0; i < theta.size(); ++i) {
    if (core::is_measurable(theta[i]) && core::is_measurable(r[i])) continue;
    return core::fail_with(core::Code::kNotFinite,
                           "row {} is ({} rad, {} mm); finite numbers up to {:g} are needed", i,
                           theta[i], r[i], core::kGreatestNumber);
  }
  return {};
}

double mean_of(std::span<const double> r) {
  double sum = 0.0;
  for (const double value : r) sum += value - r.front();
  return r.front() + sum / static_cast<double>(r.size());
}

core::Result<Roundness> ls_profile(std::span<const double> theta, std::span<const double> r,
                                   const RoundnessSide& side) {
  TRY_DO(check_profile(theta, r, 3));
  const double mean = mean_of(r);
  const auto n = static_cast<Eigen::Index>(r.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> basis(n, 3);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    basis.row(i) << 1.0, std::cos(theta[row]), std::sin(theta[row]);
    right(i) = r[row] - mean;
  }
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 3>> qr(basis);
  if (qr.rank() < 3) {
    return core::fail(core::Code::kRank,
                      "fewer than 3 different angles; the centre is undetermined");
  }
  const Eigen::Vector3d x = qr.solve(right);
  const Eigen::VectorXd residual = right - basis * x;
  Roundness out;
  out.center_mm = x.tail<2>();
  out.radius_mm = mean + x(0);
  out.parameters = parameters_of(
      r.size(), [&](std::size_t i) { return residual(static_cast<Eigen::Index>(i)); }, side);
  out.total_mm = out.parameters->total_mm;
  return out;
}

ZoneRows<2> zone_rows(std::span<const double> theta, std::span<const double> r, double mean) {
  ZoneRows<2> rows;
  for (std::size_t i = 0; i < r.size(); ++i) {
    rows.push_back(r[i] - mean, {-std::cos(theta[i]), -std::sin(theta[i])});
  }
  return rows;
}

/// Solves the programme in a box that its optimum does not touch, if there is such a box.
std::optional<ZoneStep<2>> solved(const ZoneRows<2>& rows, const ZoneWeights& weights) {
  double box = std::max(kFirstBox * column_extremes(rows.distances()).width(), 1e-12);
  for (int k = 0; k < kBoxes; ++k, box *= kBoxGrowth) {
    auto step = solve_zone_program<2>(rows, box, weights);
    if (step.solved && step.inside_box) return step;
  }
  return std::nullopt;
}

ZoneWeights weights_of(CircleReference reference) {
  if (reference == CircleReference::kMc) return kMinimumCircumscribed;
  return reference == CircleReference::kMi ? kMaximumInscribed : kMinimumZone;
}

core::Error no_center(CircleReference reference) {
  if (reference == CircleReference::kMz) {
    return {core::Code::kNotConverged,
            "the minimum zone of the profile has no centre within reach; the arc is too short for "
            "it"};
  }
  return {core::Code::kReferenceAbsent,
          fmt::format(
              "the {} circle of the profile does not exist: its values leave a gap of 180 "
              "deg or more, into which the centre runs away",
              reference == CircleReference::kMc ? "minimum circumscribed" : "maximum inscribed")};
}

core::Result<Roundness> program_profile(std::span<const double> theta, std::span<const double> r,
                                        CircleReference reference) {
  const bool zone = reference == CircleReference::kMz;
  TRY_DO(check_profile(theta, r, zone ? 4 : 3));
  const double mean = mean_of(r);
  const auto rows = zone_rows(theta, r, mean);
  const ZoneWeights weights = weights_of(reference);
  const auto step = solved(rows, weights);
  if (!step) return core::fail(no_center(reference));
  const Extremes reach = rows.moved(step->step);
  Roundness out;
  out.reference = reference;
  out.center_mm = step->step;
  out.radius_mm = mean + (zone ? 0.5 * (reach.low + reach.high)
                               : weights.outer * reach.high + weights.inner * reach.low);
  out.total_mm = reach.width();
  out.outer = rows_of(step->outer);
  out.inner = rows_of(step->inner);
  // The dual value of the programme is a lower bound for every centre in the linear model.
  const double reached = weights.value(reach);
  out.certificate = {Certificate::Kind::kGlobal,
                     core::Phrase("all centres, limacon model"),
                     std::max(0.0, reached - step->value),
                     {}};
  if (!zone) out.range = deviation_range(rows, step->step, weights);
  return out;
}

}  // namespace

core::Result<Roundness> roundness_of_points(PlanePoints points_mm, CircleReference reference,
                                            const RoundnessSide& side) {
  if (reference == CircleReference::kLs) return ls_points(points_mm, side);
  if (reference == CircleReference::kMz) return mz_points(points_mm);
  return one_sided_points(points_mm, reference);
}

core::Result<Roundness> roundness_of_profile(std::span<const double> theta_rad,
                                             std::span<const double> r_mm,
                                             CircleReference reference, const RoundnessSide& side) {
  if (reference == CircleReference::kLs) return ls_profile(theta_rad, r_mm, side);
  return program_profile(theta_rad, r_mm, reference);
}

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
