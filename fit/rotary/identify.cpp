#include "fit/rotary/axes.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/rotary/ball_setup.h"
#include "fit/rotary/errors.h"
#include "fit/rotary/internal/checks.h"
#include "fit/rotary/internal/station.h"

namespace rondure::fit {
namespace {

using core::Code;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d covariance_of(const Vector3d& u_mm) { return Vector3d(u_mm.cwiseAbs2()).asDiagonal(); }

/// Mean of all references, ball by ball, in the order of their first appearance.
std::vector<BallCentre> mean_reference(const RotaryMeasurement& m) {
  std::vector<BallCentre> out;
  std::vector<double> counts;
  for (const auto& reference : m.references) {
    for (const BallCentre& ball : reference) {
      auto at = std::ranges::find(out, ball.ball, &BallCentre::ball);
      if (at == out.end()) {
        out.push_back({ball.ball, Vector3d::Zero(), Vector3d::Zero()});
        counts.push_back(0.0);
        at = out.end() - 1;
      }
      at->centre_mm += ball.centre_mm;
      at->u_mm += ball.u_mm.cwiseAbs2();
      counts[static_cast<std::size_t>(at - out.begin())] += 1.0;
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].centre_mm /= counts[i];
    out[i].u_mm = out[i].u_mm.cwiseSqrt() / counts[i];
  }
  return out;
}

/// Greatest shift of a ball between two measurements of the reference pose.
double drift_of(const RotaryMeasurement& m) {
  double out = 0.0;
  for (std::size_t i = 0; i < m.references.size(); ++i) {
    for (std::size_t j = i + 1; j < m.references.size(); ++j) {
      for (const BallCentre& a : m.references[i]) {
        for (const BallCentre& b : m.references[j]) {
          if (a.ball == b.ball) out = std::max(out, (a.centre_mm - b.centre_mm).norm());
        }
      }
    }
  }
  return out;
}

/// Greatest mean shift of the balls between two measurements of the reference pose, over its
/// standard uncertainty in a coordinate. Drift moves them together, noise does not.
double common_drift(const RotaryMeasurement& m, double u_mm) {
  double out = 0.0;
  for (std::size_t i = 0; i < m.references.size(); ++i) {
    for (std::size_t j = i + 1; j < m.references.size(); ++j) {
      Vector3d sum = Vector3d::Zero();
      double count = 0.0;
      for (const BallCentre& a : m.references[i]) {
        const auto b = std::ranges::find(m.references[j], a.ball, &BallCentre::ball);
        if (b == m.references[j].end()) continue;
        sum += b->centre_mm - a.centre_mm;
        ++count;
      }
      if (count > 0.0) out = std::max(out, sum.norm() / (u_mm * std::sqrt(2.0 * count)));
    }
  }
  return out;
}

/// Greatest uncertainty of a reference measurement in one coordinate.
double largest_reference_u(const RotaryMeasurement& m) {
  double out = 0.0;
  for (const auto& reference : m.references) {
    for (const BallCentre& ball : reference) out = std::max(out, ball.u_mm.maxCoeff());
  }
  return out;
}

StationBall station_ball(const RotaryMeasurement& m, const BallCentre& reference,
                         const BallCentre& measured, double turned_rad,
                         const Eigen::Isometry3d& carried) {
  const Matrix3d turn = m.axis.turn(turned_rad);
  StationBall out;
  out.ball = measured.ball;
  out.nominal_mm = turn * (carried * reference.centre_mm - m.axis.origin_mm);
  out.measured_mm = measured.centre_mm - m.axis.origin_mm;
  out.measured_mm2 = covariance_of(measured.u_mm);
  out.nominal_mm2 = turn * covariance_of(reference.u_mm) * turn.transpose();
  return out;
}

/// The setups of the published matrices, from the balls in the reference pose.
core::Result<PublishedSetups> published_setups(const RotaryMeasurement& m,
                                               std::span<const BallCentre> reference) {
  const bool c_axis = (m.axis.direction - Vector3d::UnitZ()).norm() < 1e-9;
  const bool a_axis = (m.axis.direction - Vector3d::UnitX()).norm() < 1e-9;
  if (reference.size() != 3 || !(c_axis || a_axis)) {
    return core::fail_with(Code::kBadOption,
                           "the published matrices are for 3 balls and an axis along +Z (C) or +X "
                           "(A); there are {} balls; take another method",
                           reference.size());
  }
  std::vector<Vector3d> p;
  for (const BallCentre& ball : reference) p.push_back(ball.centre_mm - m.axis.origin_mm);
  PublishedSetups out;
  out.l1_mm = -0.5 * (p[0].z() + p[1].z());
  out.l2_mm = -p[2].z();
  out.h1_mm = c_axis ? 0.5 * (p[0].y() + p[2].y()) : p[0].y();
  out.h2_mm = c_axis ? p[1].y() : 0.5 * (p[1].y() + p[2].y());
  const auto expected = c_axis ? out.of_c() : out.of_a();
  for (std::size_t i = 0; i < 3; ++i) {
    constexpr double kTolerance = 1.0;  // mm: a lever with this error changes results by below 1 %
    if ((p[i] - expected[i]).norm() <= kTolerance) continue;
    return core::fail_with(Code::kBadOption,
                           "ball {} stands {:.3f} mm from ({:g}, {:g}, {:g}), where the published "
                           "matrix supposes it (limit {:g} mm): in order {}; take another method",
                           reference[i].ball, (p[i] - expected[i]).norm(), expected[i].x(),
                           expected[i].y(), expected[i].z(), kTolerance,
                           c_axis ? "(L1,H1), (L1,H2), (L2,H1)" : "(L1,H1), (L1,H2), (L2,H2)");
  }
  return out;
}

core::Result<std::vector<RotaryStation>> solve_stations(const RotaryMeasurement& m,
                                                        const RotaryOptions& options,
                                                        std::span<const BallCentre> reference) {
  std::optional<PublishedSetups> setups;
  if (options.solver == RotaryOptions::Solver::kAsPublished) {
    TRY(setups, published_setups(m, reference));
  }
  const bool c_axis = m.axis.direction.z() > 0.5;
  std::vector<RotaryStation> out;
  for (const RotaryPose& pose : m.stations) {
    const double turned = pose.angle_rad - m.reference_rad;
    std::vector<StationBall> balls;
    for (const BallCentre& known : reference) {
      for (const BallCentre& ball : pose.balls) {
        if (ball.ball == known.ball) {
          balls.push_back(station_ball(m, known, ball, turned, pose.carried));
        }
      }
    }
    std::optional<PublishedMatrix> printed;
    if (setups) {
      printed = c_axis ? published_c_matrix(*setups, turned) : published_a_matrix(*setups, turned);
    }
    out.push_back(solve_station(std::move(balls), options, printed));
    out.back().angle_rad = pose.angle_rad;
    out.back().approach = pose.approach;
  }
  return out;
}

/// Covariance that the noise of the reference adds to the errors, in the reference pose: that of a
/// station there with the mean uncertainty of all stations.
Matrix6 reference_covariance(const RotaryMeasurement& m, std::span<const BallCentre> reference) {
  std::vector<StationBall> balls;
  for (const BallCentre& known : reference) {
    BallCentre measured = {known.ball, known.centre_mm, Vector3d::Zero()};
    double count = 0.0;
    for (const RotaryPose& pose : m.stations) {
      for (const BallCentre& ball : pose.balls) {
        if (ball.ball != known.ball) continue;
        measured.u_mm += ball.u_mm.cwiseAbs2();
        count += 1.0;
      }
    }
    if (count == 0.0) continue;
    measured.u_mm = (measured.u_mm / count).cwiseSqrt();
    balls.push_back(station_ball(m, known, measured, 0.0, Eigen::Isometry3d::Identity()));
  }
  const RotaryStation there = solve_station(std::move(balls), {});
  if (there.undetermined) return Matrix6::Zero();
  return there.errors.covariance - there.measured_covariance;
}

/// Computes s0 of all stations and scales their covariances by max(1, s0)^2.
void scale_uncertainties(RotaryStudy& study) {
  double chi2 = 0.0;
  for (const RotaryStation& station : study.stations) {
    if (station.undetermined) continue;
    chi2 += station.chi2;
    study.dof += station.dof;
  }
  if (study.dof > 0) study.s0 = std::sqrt(chi2 / study.dof);
  const double factor = std::pow(std::max(1.0, study.s0), 2);
  for (RotaryStation& station : study.stations) {
    station.errors.covariance *= factor;
    station.measured_covariance *= factor;
  }
  study.table.reference_covariance *= factor;
}

/// Adds the uncertainty of the readings. The scatter of the balls does not show it, so that it is
/// not scaled with them.
void add_placing(const RotaryMeasurement& m, RotaryStudy& study) {
  for (std::size_t i = 0; i < study.stations.size(); ++i) {
    RotaryStation& station = study.stations[i];
    if (station.undetermined) continue;
    const Matrix3d turn = m.axis.turn(station.angle_rad - m.reference_rad);
    station.measured_covariance += m.stations[i].placing_covariance;
    station.errors.covariance +=
        m.stations[i].placing_covariance + turned_covariance(m.reference_placing, turn);
  }
  study.table.reference_covariance += m.reference_placing;
}

/// Whether the stations cover the full circle: the remaining gap is no wider than others.
bool goes_round(const std::vector<double>& ascending_rad) {
  const double span = ascending_rad.back() - ascending_rad.front();
  if (span > core::kTwoPi - 1e-9) return true;
  double widest = 0.0;
  for (std::size_t i = 1; i < ascending_rad.size(); ++i)
    widest = std::max(widest, ascending_rad[i] - ascending_rad[i - 1]);
  const double left = core::kTwoPi - span;
  return left <= 1.5 * widest && left <= 120.0 * core::kDegree + 1e-9;
}

/// Combines the stations of one angle: both directions, and those a turn apart.
RotaryTableRow row_of(const std::vector<const RotaryStation*>& group, double angle_rad) {
  RotaryTableRow out;
  out.angle_rad = angle_rad;
  Vector6 forward = Vector6::Zero();
  Vector6 backward = Vector6::Zero();
  double forwards = 0.0;
  double backwards = 0.0;
  const auto n = static_cast<double>(group.size());
  for (const RotaryStation* station : group) {
    out.covariance += station->measured_covariance / (n * n);
    const bool back = station->approach == Approach::kBackward;
    (back ? backward : forward) += station->errors.values();
    (back ? backwards : forwards) += 1.0;
  }
  out.both_directions = forwards > 0.0 && backwards > 0.0;
  if (!out.both_directions) {
    out.errors = (forward + backward) / n;
    return out;
  }
  out.errors = 0.5 * (forward / forwards + backward / backwards);
  out.hysteresis = 0.5 * (forward / forwards - backward / backwards);
  return out;
}

/// Root mean square of the half differences, minus the contribution of noise alone.
Vector6 hysteresis_of(const std::vector<RotaryTableRow>& rows) {
  Vector6 squares = Vector6::Zero();
  double n = 0.0;
  for (const RotaryTableRow& row : rows) {
    if (!row.both_directions) continue;
    squares += row.hysteresis.cwiseAbs2() - row.covariance.diagonal();
    n += 1.0;
  }
  return n > 0.0 ? Vector6((squares / n).cwiseMax(0.0).cwiseSqrt()) : Vector6::Zero();
}

/// @param with_reference  Adds a row at the reference angle, in place of a station there.
void fill_table(bool with_reference, RotaryStudy& study) {
  std::vector<double> angles;
  if (with_reference) angles.push_back(study.reference_rad);
  for (const RotaryStation& station : study.stations) {
    if (!station.undetermined) angles.push_back(station.angle_rad);
  }
  std::ranges::sort(angles);
  RotaryTable& table = study.table;
  table.full_circle = goes_round(angles);
  const double lowest = angles.front();
  const auto place = [&](double angle) {
    if (!table.full_circle) return angle;
    const double turns = std::floor((angle - lowest + core::kSameAngle) / core::kTwoPi);
    return angle - turns * core::kTwoPi;
  };
  for (double& angle : angles) angle = place(angle);
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end(),
                           [](double a, double b) { return b - a <= core::kSameAngle; }),
               angles.end());
  for (const double angle : angles) {
    if (with_reference && std::abs(place(study.reference_rad) - angle) <= core::kSameAngle) {
      table.rows.emplace_back().angle_rad = angle;
      continue;
    }
    std::vector<const RotaryStation*> group;
    for (const RotaryStation& station : study.stations) {
      const bool here = std::abs(place(station.angle_rad) - angle) <= core::kSameAngle;
      if (here && !station.undetermined) group.push_back(&station);
    }
    table.rows.push_back(row_of(group, angle));
  }
  for (const RotaryStation& station : study.stations) {
    const double angle = place(station.angle_rad);
    const bool known = std::ranges::any_of(
        angles, [&](double a) { return std::abs(a - angle) <= core::kSameAngle; });
    if (!known) table.missing_rad.push_back(angle);
  }
  table.hysteresis_rms = hysteresis_of(table.rows);
}

void warn(RotaryStudy& study, Code code, std::string what) {
  study.warnings.push_back({code, std::move(what)});
}

void warn_of_stations(RotaryStudy& study) {
  for (const RotaryStation& s : study.stations) {
    const double angle = s.angle_rad / core::kDegree;
    if (s.undetermined) {
      warn(study, Code::kRank,
           fmt::format("station {:g} deg is undetermined: the balls measured there do "
                       "not give six errors; neighbours bridge it",
                       angle));
      continue;
    }
    for (const std::string& ball : s.removed) {
      warn(study, Code::kOutliers,
           fmt::format("ball {} at {:g} deg left out as an outlier", ball, angle));
    }
    if (!s.flagged) continue;
    warn(study, Code::kInconsistent,
         fmt::format("station {:g} deg: chi2 {:.1f} of {} degrees of freedom, limit {:.1f}; the "
                     "wrong ball cannot be told with {} balls",
                     angle, s.chi2, s.dof, s.chi2_limit, s.balls.size()));
  }
}

void warn_of_study(const RotaryMeasurement& m, RotaryStudy& study) {
  double condition = 0.0;
  double least_redundancy = 1.0;
  for (const RotaryStation& station : study.stations) {
    if (station.undetermined) continue;
    condition = std::max(condition, station.condition);
    for (const Vector3d& r : station.redundancy)
      least_redundancy = std::min(least_redundancy, r.minCoeff());
  }
  if (condition > kConditionWarning) {
    warn(study, Code::kRank,
         fmt::format("condition {:.1f} (limit for good work {:g}): the balls lie nearly on a line",
                     condition, kConditionWarning));
  }
  if (least_redundancy < 0.05) {
    warn(study, Code::kRank,
         fmt::format("least redundancy {:.2f}: there is a coordinate whose error no other ball "
                     "would show; use 4 balls or more",
                     std::abs(least_redundancy)));
  }
  // The limit is for the greatest of all shifts, some dozens of normal numbers.
  const double limit = 4.0 * std::sqrt(2.0) * largest_reference_u(m) * std::sqrt(2.0);
  if (m.references.size() > 1 && study.drift_mm > limit && limit > 0.0) {
    warn(
        study, Code::kInconsistent,
        fmt::format("the reference pose drifts by {:.2f} um between its measurements (limit {:.2f} "
                    "um)",
                    study.drift_mm / core::kMicrometre, limit / core::kMicrometre));
  }
  constexpr double kTogether = 5.0;  // of three coordinates and some pairs: one in 10 000
  if (study.drift_mm <= limit && limit > 0.0) {
    const double sigmas = common_drift(m, largest_reference_u(m));
    if (sigmas > kTogether) {
      warn(
          study, Code::kInconsistent,
          fmt::format("all balls together drift between the measurements of the reference pose, "
                      "by {:.1f} standard uncertainties (limit {:g}): the place of the axis drifts "
                      "with them",
                      sigmas, kTogether));
    }
  }
  if (m.references.size() < 3 && largest_reference_u(m) > 0.0) {
    warn(study, Code::kSparse,
         fmt::format("the reference pose was measured {} time{}; its noise is in every station: "
                     "measure it at start, middle and end",
                     m.references.size(), m.references.size() == 1 ? "" : "s"));
  }
}

/// Computes the results that follow from the stations.
core::Result<void> conclude(const RotaryMeasurement& m, const RotaryOptions& options,
                            RotaryStudy& study) {
  const bool none = std::ranges::all_of(study.stations, &RotaryStation::undetermined);
  if (none) {
    return core::fail(Code::kRank,
                      "no station has three balls off one line, so that no error is determined");
  }
  study.table.axis = m.axis;
  study.table.reference_rad = m.reference_rad;
  study.table.curve = options.curve;
  study.table.reference_covariance = reference_covariance(m, study.reference);
  scale_uncertainties(study);
  add_placing(m, study);
  TRY(study.warnings, check_neighbours(study.stations, m.axis, m.reference_rad));
  TRY(study.periodicity_checked, check_periodicity(study.stations));
  fill_table(m.reference_is_station, study);
  warn_of_stations(study);
  warn_of_study(m, study);
  auto offset = axis_offset(study.table);
  if (offset) {
    study.offset = *std::move(offset);
  } else {
    study.warnings.push_back(offset.error());
  }
  return {};
}

}  // namespace

core::Result<RotaryStudy> identify_rotary_axis(const RotaryMeasurement& measurement,
                                               const RotaryOptions& options) {
  if (!(options.outlier_probability >= 0.5 && options.outlier_probability < 1.0)) {
    return core::fail_with(Code::kBadOption, "outlier probability {:g} is not in 0.5..1",
                           options.outlier_probability);
  }
  TRY_DO(check_measurement(measurement));
  RotaryStudy study;
  study.reference_rad = measurement.reference_rad;
  study.reference = mean_reference(measurement);
  study.drift_mm = drift_of(measurement);
  std::vector<Vector3d> places;
  std::vector<std::string> names;
  for (const BallCentre& ball : study.reference) {
    places.push_back(ball.centre_mm - measurement.axis.origin_mm);
    names.push_back(ball.ball);
  }
  TRY_DO(check_setup(places, names));
  for (const auto check : {check_sizes, check_sense, check_distances}) {
    TRY_DO(check(measurement, study.reference));
  }
  TRY(study.stations, solve_stations(measurement, options, study.reference));
  TRY_DO(conclude(measurement, options, study));
  return study;
}

}  // namespace rondure::fit
