#include "fit/profiles/roundness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/numbers.h"
#include "fit/least_squares/circle.h"
#include "fit/references/min_zone_circle.h"
#include "fit/references/one_sided_center.h"
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

}  // namespace rondure::fit
