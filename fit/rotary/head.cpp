#include "fit/rotary/head.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/rotary/errors.h"

namespace rondure::fit {
namespace {

using core::Code;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kZero_rad = 1e-9;

/// Whether a reading is one of the reference pose: also a station at 0 is.
bool at_reference(const HeadReading& reading) {
  return std::abs(reading.pose.c_rad) <= kZero_rad && std::abs(reading.pose.a_rad) <= kZero_rad;
}

/// The mean reading of each ball at C = A = 0, and how many there are.
struct References {
  std::vector<Vector3d> mean_mm;
  std::vector<double> counts;
};

core::Result<References> references_of(const HeadMeasurement& m, HeadStudy& study) {
  References out;
  std::vector<std::vector<Vector3d>> all(m.balls.size());
  for (const HeadReading& reading : m.readings) {
    if (at_reference(reading)) all[reading.ball].push_back(reading.d_mm);
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].size() < 2) {
      return core::fail_with(Code::kMissingKey,
                             "ball {} has {} readings of the reference pose, C = A = 0: read it "
                             "there before and after the others",
                             m.balls[k].ball, all[k].size());
    }
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& d : all[k]) {
      sum += d;
      for (const Vector3d& other : all[k]) {
        study.reference_step_mm =
            std::max(study.reference_step_mm, (d - other).cwiseAbs().maxCoeff());
      }
    }
    const auto count = static_cast<double>(all[k].size());
    out.mean_mm.emplace_back(sum / count);
    out.counts.push_back(count);
  }
  return out;
}

/// Place of the ball of a reading, from the pivot, with the first ball as origin.
BallCentre place_of(const HeadMeasurement& m, const HeadReading& reading, const Vector3d& origin) {
  const BallCentre& ball = m.balls[reading.ball];
  return {ball.ball, head_motion(reading.pose) * ball.centre_mm + reading.d_mm - origin,
          Vector3d::Constant(m.u_mm)};
}

/// The readings as the measurement of one axis.
core::Result<RotaryMeasurement> measurement_of(const HeadMeasurement& m, HeadStep step,
                                               const References& references) {
  const bool of_c = step == HeadStep::kC;
  RotaryMeasurement out;
  out.axis = of_c ? head_axis_c() : head_axis_a();
  out.reference_is_station = true;
  std::vector<std::size_t> seen(m.balls.size(), 0);
  for (const HeadReading& reading : m.readings) {
    const BallCentre ball = place_of(m, reading, references.mean_mm.front());
    if (at_reference(reading)) {
      const std::size_t set = seen[reading.ball]++;
      if (out.references.size() <= set) out.references.resize(set + 1);
      out.references[set].push_back(ball);
      continue;
    }
    if (reading.step != step) continue;
    const double angle = of_c ? reading.pose.c_rad : reading.pose.a_rad;
    const double other = of_c ? reading.pose.a_rad : reading.pose.c_rad;
    if (std::abs(other) > kZero_rad) {
      return core::fail_with(Code::kMeaning,
                             "a station of {} at {:g} deg is read with {} at {:g} deg, not at 0; "
                             "check whether c_deg and a_deg are exchanged",
                             of_c ? "C" : "A", angle / core::kDegree, of_c ? "A" : "C",
                             other / core::kDegree);
    }
    auto at = std::ranges::find_if(out.stations, [&](const RotaryPose& pose) {
      return std::abs(pose.angle_rad - angle) <= kZero_rad;
    });
    if (at == out.stations.end()) {
      out.stations.emplace_back().angle_rad = angle;
      at = out.stations.end() - 1;
    }
    at->balls.push_back(ball);
  }
  return out;
}

/// (t; w) of rigidly moved balls per displacement of each coordinate, times the uncertainty of its
/// mean reference; and the origin, which goes with the first ball.
void reference_modes(const HeadMeasurement& m, const References& references, HeadStudy& study) {
  constexpr double kLength_mm = 100.0;  // brings rotations to the size of shifts
  const auto n = static_cast<Eigen::Index>(m.balls.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> rows(3 * n, 6);
  Eigen::VectorXd u(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    rows.middleRows<3>(3 * k) << Matrix3d::Identity(),
        -cross_matrix(m.balls[i].centre_mm) / kLength_mm;
    u.segment<3>(3 * k).setConstant(m.u_mm / std::sqrt(references.counts[i]));
  }
  const Matrix6 normal = rows.transpose() * rows;
  study.reference_modes = core::inverse_ldlt(normal) * rows.transpose() * u.asDiagonal();
  study.reference_modes.bottomRows<3>() /= kLength_mm;
  study.origin_modes.setZero(3, 3 * n);
  study.origin_modes.leftCols<3>() = u(0) * Matrix3d::Identity();
}

/// The location of an axis with its uncertainty: of the stations, of the reference pose, and of the
/// origin. A table of what one noise does to the errors gives what it does to the location.
core::Result<AxisOffset> location_of(const HeadStudy& study, const RotaryStudy& axis) {
  RotaryTable table = axis.table;
  table.reference_covariance.setZero();
  TRY(auto out, axis_offset(table));
  Vector3d d_mm2 = out.d_u_mm.cwiseAbs2();
  Vector3d e_rad2 = out.e_u_rad.cwiseAbs2();
  const double factor = std::pow(std::max(1.0, axis.s0), 2);
  for (Eigen::Index k = 0; k < study.reference_modes.cols(); ++k) {
    for (RotaryTableRow& row : table.rows) {
      row.errors = study.modes_at(table.axis, row.angle_rad).col(k);
    }
    TRY(const auto by_one, axis_offset(table));
    d_mm2 += factor * by_one.d_mm.cwiseAbs2();
    e_rad2 += factor * by_one.e_rad.cwiseAbs2();
  }
  out.d_u_mm = d_mm2.cwiseSqrt();
  out.e_u_rad = e_rad2.cwiseSqrt();
  return out;
}

/// One axis.
core::Result<RotaryStudy> study_of(const HeadMeasurement& m, HeadStep step,
                                   const References& references, const HeadStudy& study) {
  TRY(const auto task, measurement_of(m, step, references));
  TRY(auto out, identify_rotary_axis(task));
  if (out.offset) {
    TRY(out.offset, location_of(study, out));
  }
  return out;
}

void add(const std::vector<Vector3d>& vectors, HeadRms& sums) {
  for (const Vector3d& v : vectors) {
    sums.rms_mm += v.squaredNorm();
    sums.max_mm = std::max(sums.max_mm, v.norm());
  }
}

core::Result<void> verify(const HeadMeasurement& m, const References& references,
                          HeadStudy& study) {
  TRY(const auto c, RotaryModel::of(study.c.table));
  TRY(const auto a, RotaryModel::of(study.a.table));
  std::map<std::pair<double, double>, std::vector<const HeadReading*>> poses;
  for (const HeadReading& reading : m.readings) {
    if (reading.step != HeadStep::kVerification) continue;
    poses[{reading.pose.c_rad, reading.pose.a_rad}].push_back(&reading);
  }
  double points = 0.0;
  for (const auto& [key, readings] : poses) {
    HeadVerification out;
    out.pose = {key.first, key.second};
    const auto at = [&](const RotaryModel& model, const char* name, double angle) {
      auto found = model.at(angle);
      if (!found) found.error().what = fmt::format("axis {}: {}", name, found.error().what);
      return found;
    };
    TRY(const auto of_c, at(c, "C", out.pose.c_rad));
    TRY(const auto of_a, at(a, "A", out.pose.a_rad));
    const Matrix3d turn = head_axis_c().turn(out.pose.c_rad);
    out.covariance = of_c.covariance + turned_covariance(of_a.covariance, turn);
    const Eigen::Isometry3d motion = head_motion(out.pose, of_c, of_a);
    for (const HeadReading* const reading : readings) {
      const Vector3d origin = references.mean_mm.front();
      const Vector3d p0 =
          m.balls[reading->ball].centre_mm + references.mean_mm[reading->ball] - origin;
      const Vector3d found = place_of(m, *reading, origin).centre_mm;
      out.at_mm.emplace_back(motion * p0);
      out.left_mm.emplace_back(found - out.at_mm.back());
      out.before_mm.emplace_back(found - head_motion(out.pose) * p0);
      study.expected_mm += 3.0 * m.u_mm * m.u_mm * (1.0 + 1.0 / references.counts[reading->ball]) +
                           point_covariance_mm2(out.covariance, out.at_mm.back()).trace();
    }
    points += static_cast<double>(readings.size());
    add(out.left_mm, study.left);
    add(out.before_mm, study.before);
    study.poses.push_back(std::move(out));
  }
  for (double* const sum : {&study.left.rms_mm, &study.before.rms_mm, &study.expected_mm}) {
    *sum = std::sqrt(*sum / std::max(1.0, points));
  }
  return {};
}

}  // namespace

RotaryAxis head_axis_c() { return {Vector3d::UnitZ(), Vector3d::Zero()}; }
RotaryAxis head_axis_a() { return {Vector3d::UnitX(), Vector3d::Zero()}; }

Eigen::Isometry3d head_motion(const HeadPose& pose, const RotaryErrors& c, const RotaryErrors& a) {
  return rotary_motion(head_axis_c(), pose.c_rad, c) * rotary_motion(head_axis_a(), pose.a_rad, a);
}

Eigen::Matrix<double, 6, Eigen::Dynamic> HeadStudy::modes_at(const RotaryAxis& axis,
                                                             double angle_rad) const {
  Eigen::Matrix<double, 6, Eigen::Dynamic> out(6, reference_modes.cols());
  if (std::abs(std::remainder(angle_rad, core::kTwoPi)) <= kZero_rad) return out.setZero();
  const Matrix3d turn = axis.turn(angle_rad);
  out.topRows<3>() =
      turn * reference_modes.topRows<3>() + (Matrix3d::Identity() - turn) * origin_modes;
  out.bottomRows<3>() = turn * reference_modes.bottomRows<3>();
  return out;
}

namespace {

/// Two places of the ball whose readings differ by no more than noise, in a sentence; empty without
/// any. The ball may not have been moved between them, or the head has no errors of rotation.
std::string read_alike(const HeadMeasurement& m, const References& references) {
  constexpr double kChance = 0.001;
  constexpr int kLeastPoses = 4;
  for (std::size_t i = 0; i < m.balls.size(); ++i) {
    for (std::size_t k = i + 1; k < m.balls.size(); ++k) {
      double square_mm2 = 0.0;
      int poses = 0;
      for (const HeadReading& one : m.readings) {
        if (one.ball != i || at_reference(one)) continue;
        const auto other = std::ranges::find_if(m.readings, [&](const HeadReading& reading) {
          return reading.ball == k && reading.step == one.step &&
                 std::abs(reading.pose.c_rad - one.pose.c_rad) <= kZero_rad &&
                 std::abs(reading.pose.a_rad - one.pose.a_rad) <= kZero_rad;
        });
        if (other == m.readings.end()) continue;
        const Vector3d from_i = one.d_mm - references.mean_mm[i];
        const Vector3d from_k = other->d_mm - references.mean_mm[k];
        square_mm2 += (from_i - from_k).squaredNorm();
        ++poses;
      }
      const double variance_mm2 =
          m.u_mm * m.u_mm * (2.0 + 1.0 / references.counts[i] + 1.0 / references.counts[k]);
      if (poses < kLeastPoses ||
          square_mm2 > variance_mm2 * core::chi_square_quantile(1.0 - kChance, 3.0 * poses)) {
        continue;
      }
      return fmt::format(
          "{} and {} read alike in all {} poses, within noise: was the ball moved from the one "
          "place "
          "to the other? If not, move it and read again",
          m.balls[i].ball, m.balls[k].ball, poses);
    }
  }
  return {};
}

}  // namespace

core::Result<HeadStudy> identify_head(const HeadMeasurement& measurement) {
  HeadStudy out;
  if (measurement.balls.size() < 3) {
    return core::fail_with(Code::kTooFewPoints,
                           "{} balls do not show six errors; at least 3 not on one line are needed",
                           measurement.balls.size());
  }
  TRY(const auto references, references_of(measurement, out));
  reference_modes(measurement, references, out);
  const std::string alike = read_alike(measurement, references);
  for (const HeadStep step : {HeadStep::kC, HeadStep::kA}) {
    auto study = study_of(measurement, step, references, out);
    const char* const name = step == HeadStep::kC ? "C" : "A";
    if (!study) {
      return core::fail_with(study.error().code, "axis {}: {}{}{}", name, study.error().what,
                             alike.empty() ? "" : "; ", alike);
    }
    (step == HeadStep::kC ? out.c : out.a) = *std::move(study);
  }
  TRY_DO(verify(measurement, references, out));
  if (!alike.empty()) out.warnings.push_back({Code::kInconsistent, alike});
  return out;
}

core::Result<std::vector<HeadTableRow>> head_errors(const HeadStudy& study, const RotaryStudy& axis,
                                                    const std::vector<double>& angles_rad) {
  RotaryTable table = axis.table;
  table.reference_covariance.setZero();  // in the modes
  TRY(const auto model, RotaryModel::of(std::move(table)));
  std::vector<HeadTableRow> out;
  for (const double angle_rad : angles_rad) {
    TRY(const auto errors, model.at(angle_rad));
    const auto modes = study.modes_at(axis.table.axis, angle_rad);
    HeadTableRow row;
    row.angle_rad = angle_rad;
    row.errors = errors.values();
    row.u = (errors.covariance.diagonal() +
             std::pow(std::max(1.0, axis.s0), 2) * modes.rowwise().squaredNorm())
                .cwiseMax(0.0)
                .cwiseSqrt();
    out.push_back(row);
  }
  return out;
}

core::Result<std::vector<HeadTableRow>> head_table(const HeadStudy& study, const RotaryStudy& axis,
                                                   double step_rad) {
  constexpr double kPerDegree = 1e9;  // whole steps of degrees stay what they are
  const auto& rows = axis.table.rows;
  const bool round = axis.table.full_circle;
  const double first = round ? 0.0 : rows.front().angle_rad;
  const double last = round ? core::kTwoPi : rows.back().angle_rad;
  const auto steps = static_cast<int>(std::ceil((last - first) / step_rad - 1e-6));
  const double first_deg = core::stated_degrees(first);
  const double step_deg = core::stated_degrees(step_rad);
  std::vector<double> angles_rad = {first};
  for (int i = 1; i < steps; ++i) {
    angles_rad.push_back(core::on_grid(first_deg + i * step_deg, kPerDegree) * core::kDegree);
  }
  if (!round) angles_rad.push_back(last);
  TRY(auto out, head_errors(study, axis, angles_rad));
  if (round) {
    out.push_back(out.front());
    out.back().angle_rad = last;
  }
  return out;
}

void round_table(double shift_mm, double tilt_rad, std::vector<HeadTableRow>& rows) {
  for (HeadTableRow& row : rows) {
    for (Eigen::Index k = 0; k < 6; ++k) {
      const double step = k < 3 ? shift_mm : tilt_rad;
      if (step > 0.0) row.errors(k) = step * std::round(row.errors(k) / step);
    }
  }
}

RotaryErrors table_error(const std::vector<HeadTableRow>& rows, double angle_rad) {
  const double span = rows.back().angle_rad - rows.front().angle_rad;
  double angle = angle_rad;
  if (span > core::kTwoPi - kZero_rad) {
    angle -= std::floor((angle - rows.front().angle_rad) / core::kTwoPi) * core::kTwoPi;
  }
  auto after = std::ranges::upper_bound(rows, angle, {}, &HeadTableRow::angle_rad);
  after = std::clamp(after, rows.begin() + 1, rows.end() - 1);
  const HeadTableRow& low = *(after - 1);
  const double share =
      std::clamp((angle - low.angle_rad) / (after->angle_rad - low.angle_rad), 0.0, 1.0);
  const Vector6 errors = low.errors + share * (after->errors - low.errors);
  RotaryErrors out;
  out.t_mm = errors.head<3>();
  out.w_rad = errors.tail<3>();
  return out;
}

}  // namespace rondure::fit
