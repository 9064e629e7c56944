#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "core/utc.h"
#include "evaluation/five_axis/result.h"
#include "evaluation/results/chain.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/rotary/internal/gates.h"
#include "fit/geometry/registration.h"
#include "fit/rotary/ball_setup.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
namespace {

using core::Code;
using core::kDegree;
using core::kMicrometre;
using Eigen::Vector3d;
using record::FiveAxisTask;

constexpr double kSecondsOfDay = 86'400.0;
constexpr double kLeastReading_mm = 1e-6;  // of the digits of readings
constexpr double kMostDeviation_mm = 5.0;  // the control holds the ball: no more is left
constexpr double kHeadSigmas = 4.0;
constexpr double kHeadPoses = 5.0;
constexpr double kMostOfBefore_1 = 1.5;  // a table of the other sign leaves twice as much

/// Pooled standard deviation of the readings at C = A = 0.
double reference_scatter_mm(const fit::HeadMeasurement& m) {
  double squares = 0.0;
  double freedoms = 0.0;
  for (std::size_t k = 0; k < m.balls.size(); ++k) {
    Vector3d sum = Vector3d::Zero();
    double squares_of_ball = 0.0;
    double count = 0.0;
    for (const fit::HeadReading& r : m.readings) {
      if (r.ball != k || r.step != fit::HeadStep::kReference) continue;
      sum += r.d_mm;
      squares_of_ball += r.d_mm.squaredNorm();
      count += 1.0;
    }
    if (count < 2.0) continue;
    squares += squares_of_ball - sum.squaredNorm() / count;
    freedoms += 3.0 * (count - 1.0);
  }
  return freedoms > 0.0 ? std::sqrt(std::max(0.0, squares) / freedoms) : 0.0;
}

core::Result<fit::HeadMeasurement> measurement_of(const record::Series& series,
                                                  const FiveAxisTask& task) {
  fit::HeadMeasurement out;
  for (const record::HeadBallTask& ball : task.balls) {
    out.balls.push_back({ball.id, Vector3d::Map(ball.place_mm().data()), Vector3d::Zero()});
  }
  const auto column = [&](const char* name) {
    return series.column(name).value_or(std::vector<double>(series.rows(), 0.0));
  };
  const auto step = column("step");
  const auto c_deg = column("c_deg");
  const auto a_deg = column("a_deg");
  const auto setup = column("setup");
  const auto dx = column("dx_um");
  const auto dy = column("dy_um");
  const auto dz = column("dz_um");
  for (std::size_t i = 0; i < series.rows(); ++i) {
    const auto balls = static_cast<double>(task.balls.size());
    if (!(setup[i] >= 1.0 && setup[i] <= balls) || setup[i] != std::floor(setup[i])) {
      return core::fail_with(Code::kUnknownKey,
                             "row {}: set-up {:g} is none of the {} balls of the plan; give the "
                             "number of the ball, from 1",
                             i + 1, setup[i], task.balls.size());
    }
    if (!(step[i] >= 0.0 && step[i] <= 3.0)) {
      return core::fail_with(Code::kMeaning, "row {}: step {:g} is not known", i + 1, step[i]);
    }
    out.readings.push_back(
        {static_cast<fit::HeadStep>(static_cast<int>(step[i])),
         {task.c_sign() * c_deg[i] * kDegree, task.a_sign() * a_deg[i] * kDegree},
         static_cast<std::size_t>(setup[i]) - 1,
         kMicrometre * Vector3d(dx[i], dy[i], dz[i])});
  }
  if (task.uncertainty && task.uncertainty->ball_um) {
    out.u_mm = record::u_of(task.uncertainty->ball_um) * kMicrometre;
  } else if (const auto u_um = series.column("u_um"); u_um && !u_um->empty()) {
    double squares = 0.0;
    for (const double u : *u_um) squares += u * u / static_cast<double>(u_um->size());
    out.u_mm = std::sqrt(squares) * kMicrometre;
  } else {
    out.u_mm = reference_scatter_mm(out);
  }
  out.u_mm = std::max(kLeastReading_mm, out.u_mm);
  return out;
}

/// Refuses deviations that no head under its control leaves.
/// @param loaded  A repeat: a table may leave less than a reading is uncertain by.
core::Result<void> check_deviations(const fit::HeadMeasurement& m, bool loaded) {
  double largest = 0.0;
  for (const fit::HeadReading& r : m.readings) largest = std::max(largest, r.d_mm.norm());
  if (largest > kMostDeviation_mm) {
    return core::fail_with(Code::kUnits,
                           "a deviation of {:.3f} mm is more than a control leaves that holds the "
                           "ball (limit {:g} mm); give dx_um, dy_um, dz_um in um, with its "
                           "transformation on",
                           largest, kMostDeviation_mm);
  }
  // The largest of so many readings lies beyond the uncertainty of one, whatever the head leaves.
  if (!loaded && largest < m.u_mm) {
    return core::fail_with(Code::kUnits,
                           "no deviation is above {} um, less than the {} um that one "
                           "reading is uncertain by; give dx_um, dy_um, dz_um in um, or the "
                           "ball_um of this nest",
                           core::um(largest), core::um(m.u_mm));
  }
  return {};
}

fixture::AxisStation station_of(double angle_rad, const fit::Vector6& errors,
                                const fit::Vector6& u) {
  fixture::AxisStation out;
  out.angle_rad = angle_rad;
  out.errors = {errors.head<3>(), errors.tail<3>()};
  out.covariance.diagonal() = u.cwiseAbs2();
  return out;
}

/// An angle of a table as the control counts it: a full circle runs from 0 to 360 deg in its sense.
double counted_rad(double angle_rad, double sense, bool full_circle) {
  if (sense > 0.0) return angle_rad;
  if (full_circle) return (360.0 - core::stated_degrees(angle_rad)) * kDegree;
  return 0.0 - angle_rad;  // 0, not -0
}

/// The table of an axis in steps, and the curve through its stations.
core::Result<void> fill_axis(const FiveAxisResult& facts, const fit::RotaryStudy& study,
                             double step_deg, double sense,
                             std::shared_ptr<const fixture::StationMotion>& motion,
                             std::vector<fixture::AxisStation>& table) {
  const record::HeadTableTask& asked = facts.task.compensation;
  TRY(auto rows, fit::head_table(facts.study, study, step_deg * kDegree));
  fit::round_table(asked.resolution_um * kMicrometre, asked.resolution_urad * core::kMicroradian,
                   rows);
  for (const fit::HeadTableRow& row : rows) {
    table.push_back(
        station_of(counted_rad(row.angle_rad, sense, study.table.full_circle), row.errors, row.u));
  }
  std::ranges::sort(table, {}, &fixture::AxisStation::angle_rad);
  std::vector<double> angles_rad;
  for (const fit::RotaryTableRow& row : study.table.rows) angles_rad.push_back(row.angle_rad);
  if (study.table.full_circle) {
    // After the last station as the control counts.
    const double closed_rad =
        sense > 0.0 ? angles_rad.front() + core::kTwoPi : angles_rad.back() - core::kTwoPi;
    if (std::abs(closed_rad) <= core::kTwoPi) angles_rad.push_back(closed_rad);
  }
  std::vector<fixture::AxisStation> stations;
  TRY(const auto at_stations, fit::head_errors(facts.study, study, angles_rad));
  for (const fit::HeadTableRow& row : at_stations) {
    stations.push_back(station_of(counted_rad(row.angle_rad, sense, false), row.errors, row.u));
  }
  std::ranges::sort(stations, {}, &fixture::AxisStation::angle_rad);
  TRY(motion, fixture::StationMotion::through(std::move(stations)));
  return {};
}

/// @param loaded  A repeat: what is left is what was read.
CombinedPose combined_of(const fit::HeadVerification& pose, bool loaded) {
  CombinedPose out;
  out.pose = {pose.pose.c_rad, pose.pose.a_rad};
  out.points = pose.at_mm.size();
  out.at_mm = pose.at_mm;
  out.residual_mm = loaded ? pose.before_mm : pose.left_mm;
  out.covariance = pose.covariance;
  const auto n = static_cast<double>(out.points);
  for (std::size_t i = 0; i < out.points; ++i) {
    out.rms_mm += out.residual_mm[i].squaredNorm() / n;
    out.before_rms_mm += pose.before_mm[i].squaredNorm() / n;
    out.max_mm = std::max(out.max_mm, out.residual_mm[i].norm());
  }
  std::vector<Vector3d> found;
  for (std::size_t i = 0; i < out.points; ++i) {
    found.emplace_back(out.at_mm[i] + out.residual_mm[i]);
  }
  if (const auto moved = fit::rigid_registration(out.at_mm, found)) {
    out.tilt_rad = fit::rotation_vector(moved->motion.linear()).norm();
  }
  out.rms_mm = std::sqrt(out.rms_mm);
  out.before_rms_mm = std::sqrt(out.before_rms_mm);
  return out;
}

/// Controls differ in the sign of the errors that they expect.
Gate sign_of_table(const HeadGain& gain, double loaded_mm) {
  const double times = loaded_mm / gain.before.rms_mm;
  Gate out{
      "sense", core::phrase("rms at combined poses with the table loaded over that without it"),
      times,   kMostOfBefore_1,
      {},      Gate::Outcome::kPassed,
      {}};
  if (times <= kMostOfBefore_1) return out;
  out.outcome = Gate::Outcome::kVoids;
  out.reason = core::phrase(
      "with the table of {} loaded the balls deviate by {} um rms, {:.1f} times the {} um without "
      "it: the control takes it with the other sign; negate its errors, load it and read again",
      gain.with, core::um(loaded_mm), times, core::um(gain.before.rms_mm));
  return out;
}

std::vector<Gate> head_gates(const FiveAxisResult& facts) {
  std::vector<Gate> out;
  if (facts.gain && facts.gain->before.rms_mm > 0.0) {  // before those that it explains
    out.push_back(sign_of_table(*facts.gain, facts.study.before.rms_mm));
  }
  for (Gate& gate : station_gates(axes_of(facts), facts.condition)) out.push_back(std::move(gate));
  const double sigmas = facts.study.reference_step_mm / (std::sqrt(2.0) * facts.u_mm);
  Gate references{"references",
                  core::phrase("difference of two readings of a ball at C = A = 0 over its "
                               "uncertainty"),
                  sigmas,
                  kHeadSigmas,
                  {},
                  Gate::Outcome::kPassed,
                  {}};
  if (sigmas > kHeadSigmas) {
    references.outcome = Gate::Outcome::kVoids;
    references.reason = core::phrase(
        "a ball differs between two readings at C = A = 0 by {:.1f} times the uncertainty of the "
        "difference, the limit is {:g}: nest, ball or machine drifted; read the step between them "
        "again",
        sigmas, kHeadSigmas);
  }
  out.push_back(std::move(references));
  const auto poses = static_cast<double>(facts.combined.size());
  Gate verified{"combined-poses",
                core::phrase("poses of both axes"),
                poses,
                kHeadPoses,
                {},
                Gate::Outcome::kPassed,
                {}};
  if (poses < kHeadPoses) {
    verified.outcome = Gate::Outcome::kVoids;
    verified.reason = core::phrase(
        "{:g} poses do not verify both axes; read the balls at {:g} with both of them turned",
        poses, kHeadPoses);
  }
  out.push_back(std::move(verified));
  if (!facts.combined.empty() && !facts.gain) {
    out.push_back(residual_gate(facts.study.left.rms_mm, facts.study.expected_mm));
  }
  return out;
}

}  // namespace

std::vector<AxisFacts> axes_of(const FiveAxisResult& facts) {
  return {{"c", &facts.study.c, facts.c_motion.get()}, {"a", &facts.study.a, facts.a_motion.get()}};
}

core::Result<FiveAxisResult> evaluate_five_axis(const record::RunRecord& record, int index,
                                                const HeadOf& earlier, FeatureResult& result) {
  FiveAxisResult facts;
  TRY(facts.task, record::task_of<FiveAxisTask>(result.feature.settings));
  const record::Series& series = *record.data_of(index, "data");
  TRY(const auto measured, measurement_of(series, facts.task));
  TRY_DO(check_deviations(measured, facts.task.repeat.has_value()));
  TRY(facts.study, fit::identify_head(measured));
  facts.readings = measured.readings.size();
  facts.u_mm = measured.u_mm;
  const fit::RotaryStudy& c = facts.study.c;
  const fit::RotaryStudy& a = facts.study.a;
  const double dof = c.dof + a.dof;
  const double chi2 = c.s0 * c.s0 * c.dof + a.s0 * a.s0 * a.dof;
  facts.noise_mm = facts.u_mm * (dof > 0.0 ? std::max(1.0, std::sqrt(chi2 / dof)) : 1.0);
  std::vector<Vector3d> places;
  for (const fit::BallCentre& ball : measured.balls) {
    places.push_back(ball.centre_mm);
    facts.lever_mm = std::max(facts.lever_mm, ball.centre_mm.norm());
  }
  facts.condition = fit::setup_condition(places);
  TRY_DO(fill_axis(facts, c, facts.task.compensation.c_step_deg, facts.task.c_sign(),
                   facts.c_motion, facts.c_table));
  TRY_DO(fill_axis(facts, a, facts.task.compensation.a_step_deg, facts.task.a_sign(),
                   facts.a_motion, facts.a_table));
  for (const fit::HeadVerification& pose : facts.study.poses) {
    facts.combined.push_back(combined_of(pose, facts.task.repeat.has_value()));
  }
  if (facts.task.repeat) {
    auto gain = earlier(facts.task.repeat->with.feature);
    result.gates.push_back(chain_gate(facts.task.repeat->with.feature,
                                      gain ? std::nullopt : std::optional(gain.error().said())));
    facts.gain = gain ? *std::move(gain) : HeadGain{facts.task.repeat->with.feature, {}, 0.0};
  }
  if (const auto start = core::parse_utc(record.header.started_utc)) {
    facts.expires_utc = core::utc_text(
        *start + static_cast<std::int64_t>(facts.task.valid_for_days * kSecondsOfDay));
  }
  for (Gate& gate : head_gates(facts)) result.gates.push_back(std::move(gate));
  facts.withheld = voided_by(result.gates);
  result.warnings = facts.study.warnings;
  for (const AxisFacts& axis : axes_of(facts)) {
    for (const core::Error& warning : axis.study->warnings) {
      result.warnings.push_back(
          {warning.code, fmt::format("axis {}: {}", axis.key, warning.what), warning.where});
    }
  }
  return facts;
}

}  // namespace rondure::evaluation
