#include "evaluation/rotary/internal/axis_extreme.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "core/statistics.h"
#include "evaluation/results/feature_values.h"
#include "evaluation/uncertainty/angular_curve.h"
#include "evaluation/uncertainty/curve_trials.h"

namespace rondure::evaluation {
namespace {

using record::Indication;

constexpr double kReferencePose_rad = 1e-9;
constexpr double kMilliradian = 1e3;        ///< Of a rad: angles are held in mrad.
constexpr double kLeastStationU_mm = 1e-9;  ///< An error of 0 leaves no distribution.

/// The three independent parts of a covariance of shifts or tilts, as columns.
Eigen::Matrix3d independent_parts(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(covariance);
  return solved.eigenvectors() * solved.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

double least_redundancy(const fit::RotaryStudy& study, double angle_rad) {
  double least = 1.0;
  for (const fit::RotaryStation& station : study.stations) {
    if (std::abs(station.angle_rad - angle_rad) > kReferencePose_rad) continue;
    for (const Eigen::Vector3d& ball : station.redundancy) least = std::min(least, ball.minCoeff());
  }
  return std::max(0.0, least);
}

namespace {

/// The errors of the stations in their own uncertainties, as a curve over the angle: an axis errs
/// smoothly, and what all stations have in common shows where it is less than the noise of one.
class StationCurve {
 public:
  explicit StationCurve(const AxisCurve& curve)
      : angular_(curve.angle_rad),
        u_mm_(Eigen::VectorXd::Map(curve.u_mm.data(), std::ssize(curve.u_mm))),
        found_mm_(Eigen::VectorXd::Map(curve.found_mm.data(), std::ssize(curve.found_mm))) {}

  [[nodiscard]] MeasuredCurve measured() const {
    constexpr std::size_t kSlow = 5;  // offset, once and twice a turn
    return angular_.measured(angular_.coefficients(found_mm_.cwiseQuotient(u_mm_)), 1.0, kSlow);
  }
  [[nodiscard]] std::vector<double> errors_mm(const std::vector<double>& coefficients) const {
    const Eigen::VectorXd out =
        angular_.values(Eigen::VectorXd::Map(coefficients.data(), std::ssize(coefficients)))
            .cwiseProduct(u_mm_);
    return {out.begin(), out.end()};
  }

 private:
  AngularCurve angular_;
  Eigen::VectorXd u_mm_;
  Eigen::VectorXd found_mm_;
};

/// The errors of one trial: those of the stations, with the common noise of the reference pose.
std::vector<double> with_common(std::vector<double> errors_mm, const AxisCurve& curve,
                                const Eigen::VectorXd& draw) {
  for (std::size_t s = 0; s < errors_mm.size(); ++s) errors_mm[s] += curve.common_mm[s].dot(draw);
  return errors_mm;
}

}  // namespace

AxisCurve axis_curve(const RotaryResult& result, const record::Characteristic& characteristic) {
  const Indication& asked = characteristic.indication;
  const bool beta = asked.axis == Indication::Axis::kBeta;
  const AxisFacts axis = axes_of(result)[beta ? 1 : 0];
  const auto error = asked.error.value_or(Indication::AxisError::kX);
  const bool angle = record::is_angle(error);
  const auto place = static_cast<Eigen::Index>(error);  // in (t; w), the order of the covariances
  const Eigen::Index k = place % 3;
  const double scale = angle ? kMilliradian : 1.0;
  // The combined poses may have scaled the covariances of the stations.
  const double factor = result.scale_low > 1.0 ? result.scale * result.scale : 1.0;
  const fit::RotaryTable& table = axis.study->table;
  const Eigen::Matrix3d of_reference = table.reference_covariance.block<3, 3>(place - k, place - k);
  const Eigen::Matrix3d parts = scale * independent_parts(factor * of_reference);
  AxisCurve out;
  out.noises = {{"zero-pose", 3}, {kTipRadius, 1}};
  const auto& modes = result.calibration.common_modes;
  const auto tip = std::ranges::find(modes, kTipRadius, &fixture::CommonMode::name);
  for (std::size_t s = 0; s < axis.motion->stations().size(); ++s) {
    const fixture::AxisStation& station = axis.motion->stations()[s];
    const double turned_rad = station.angle_rad - table.reference_rad;
    if (std::abs(turned_rad) <= kReferencePose_rad) continue;
    const double by_tip = tip == modes.end() ? 0.0 : (beta ? tip->beta : tip->alpha)[s](place);
    Eigen::VectorXd common(4);
    common << (table.axis.turn(turned_rad) * parts).row(k).transpose(), scale * by_tip;
    const double alone_mm2 =
        scale * scale * station.covariance(place, place) - common.squaredNorm();
    out.angle_rad.push_back(station.angle_rad);
    out.found_mm.push_back(scale * (angle ? station.errors.tilt_rad : station.errors.shift_mm)(k));
    out.u_mm.push_back(std::max(kLeastStationU_mm, std::sqrt(std::max(0.0, alone_mm2))));
    out.common_mm.push_back(common);
    out.redundancy.push_back(least_redundancy(*axis.study, station.angle_rad));
  }
  return out;
}

AxisExtreme axis_extreme(std::span<const double> errors_mm, double middle_mm) {
  AxisExtreme out;
  for (std::size_t s = 0; s < errors_mm.size(); ++s) {
    const double off_mm = errors_mm[s] - middle_mm;
    if (s > 0 && std::abs(off_mm) <= out.from_middle_mm) continue;
    out = {s, std::abs(off_mm), off_mm >= 0.0};
  }
  return out;
}

double middle_of(const record::Characteristic& characteristic) {
  const std::optional<double>& upper_mm = characteristic.tolerance_mm;
  const std::optional<double>& lower_mm = characteristic.lower_mm;
  return upper_mm && lower_mm ? 0.5 * (*upper_mm + *lower_mm) : 0.0;
}

double axis_value_mm(const record::Characteristic& characteristic, const AxisExtreme& extreme) {
  if (!characteristic.lower_mm) return extreme.from_middle_mm;
  const double off_mm = extreme.above ? extreme.from_middle_mm : -extreme.from_middle_mm;
  return middle_of(characteristic) + off_mm;
}

UncertaintyStatus axis_error_interval(const AxisCurve& curve,
                                      const record::Characteristic& characteristic,
                                      std::vector<InfluenceStatement> declaration,
                                      const UncertaintyOptions& options) {
  if (curve.found_mm.empty()) {
    return UncertaintyStatus::none(core::phrase("no station was measured beside the zero pose"));
  }
  const double middle_mm = middle_of(characteristic);
  const AxisExtreme measured = axis_extreme(curve.found_mm, middle_mm);
  const StationCurve stations(curve);
  const Indication& asked = characteristic.indication;
  const std::string id =
      fmt::format("rotary.{}.{}", record::name_of(asked.axis.value_or(Indication::Axis::kAlpha)),
                  record::name_of(asked.error.value_or(Indication::AxisError::kX)));
  const CurveDraws draws(stations.measured(), options.seed, id);
  const double core_center_mm =
      axis_extreme(stations.errors_mm(draws.core_mm()), middle_mm).from_middle_mm;
  const int trials = std::max(2000, options.least_trials);
  std::vector<AxisExtreme> drawn;
  std::vector<double> core_mm;
  for (int t = 0; t < trials; ++t) {
    Eigen::VectorXd common(curve.common_mm.front().size());
    for (Eigen::Index i = 0; i < common.size(); ++i) {
      common(i) = normal_draw(options.seed, "rotary.zero-pose", static_cast<std::uint64_t>(i), t);
    }
    const auto extreme_of = [&](const std::vector<double>& draw) {
      return axis_extreme(with_common(stations.errors_mm(draw), curve, common), middle_mm);
    };
    drawn.push_back(extreme_of(draws.draw(t)));
    core_mm.push_back(extreme_of(draws.core_draw(t)).from_middle_mm);
  }
  // The distance from the middle is convex: the largest of many grows with noise. It is turned
  // here, before it gets its sign.
  const double inflation_mm = std::max(0.0, core::mean(core_mm) - core_center_mm);
  TrialValues values;
  values.signed_value = characteristic.lower_mm.has_value();
  values.unit = unit_of(characteristic);
  values.as_measured_mm = axis_value_mm(characteristic, measured);
  for (AxisExtreme& one : drawn) {
    one.from_middle_mm = std::max(0.0, one.from_middle_mm - 2.0 * inflation_mm);
    values.values_mm.push_back(axis_value_mm(characteristic, one));
  }
  const std::size_t s = measured.station;
  std::vector<LinearTerm> budget = {{"axis-station", curve.u_mm[s]}};
  Eigen::Index at = 0;
  for (const CommonNoise& noise : curve.noises) {
    budget.push_back({noise.name, curve.common_mm[s].segment(at, noise.columns).norm()});
    at += noise.columns;
  }
  auto stated =
      statement_of_trials(std::move(values), std::move(budget), std::move(declaration), options);
  return stated ? UncertaintyStatus::stated(*std::move(stated), options.coverage)
                : UncertaintyStatus::none(stated.error().said());
}

}  // namespace rondure::evaluation
