#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/numbers.h"
#include "core/units.h"
#include "core/utc.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/gates.h"
#include "evaluation/results/measured_cloud.h"
#include "evaluation/rotary/internal/combined_field.h"
#include "evaluation/rotary/internal/gates.h"
#include "evaluation/rotary/result.h"
#include "fit/geometry/registration.h"
#include "fit/rotary/ball_center.h"
#include "fit/rotary/ball_setup.h"
#include "fit/rotary/errors.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using core::kMicrometre;
using Eigen::Vector3d;
using fixture::kMicroradian;
using record::RotaryTask;

constexpr double kZero_rad = 1e-9;  // tolerance of a commanded angle
constexpr double kDay_s = 86'400.0;

/// The balls found in one pose.
struct VisitBalls {
  core::Pose commanded;
  core::Pose reached;
  std::map<int, fit::BallCenter> centers;  ///< By ball number.
};

struct Measurement {
  std::vector<VisitBalls> visits;
  std::vector<std::string> names;
  double touch_sigma_mm = 0.0;
  double machine_u_mm = 0.0;   ///< Of a centre, beside the touches: machine, and declared.
  double placing_u_rad = 0.0;  ///< Of the angle at which an axis really stands.
  double repeat_u_rad = 0.0;   ///< Its repeatability alone.
  std::size_t touches = 0;

  [[nodiscard]] Vector3d u_mm(const fit::BallCenter& center) const {
    const Vector3d variance = std::pow(touch_sigma_mm, 2) * center.cofactor.diagonal();
    return (variance.array() + std::pow(machine_u_mm, 2)).sqrt().matrix();
  }
  [[nodiscard]] std::vector<fit::BallCentre> balls_of(const VisitBalls& visit) const {
    std::vector<fit::BallCentre> out;
    for (const auto& [ball, center] : visit.centers) {
      out.push_back({names[static_cast<std::size_t>(ball)], center.center_mm, u_mm(center)});
    }
    return out;
  }
};

core::Result<fit::BallCenter> center_of(const std::vector<Vector3d>& tips, double radius_mm,
                                        double form_limit_mm, const std::string& name,
                                        const core::Pose& pose) {
  const std::string place = fmt::format("ball {} in the pose ({:g}, {:g}) deg", name,
                                        pose.alpha_rad / kDegree, pose.beta_rad / kDegree);
  auto center = fit::ball_center(tips, radius_mm);
  if (!center) {
    return core::fail_with(center.error().code, "{}: {}", place, center.error().what);
  }
  if (center->deviation_mm > form_limit_mm) {
    return core::fail_with(core::Code::kCalibration,
                           "{} has a form of {:.3f} um, the limit is {:g} um (form_limit_um); "
                           "clean it and check that it is tight",
                           place, center->deviation_mm / kMicrometre, form_limit_mm / kMicrometre);
  }
  return center;
}

/// Fits every ball of every pose, the radius held.
core::Result<Measurement> measure(const record::RunRecord& record, int index,
                                  const RotaryTask& task, double tip_mm) {
  Measurement out;
  for (const record::BallTask& ball : task.balls) out.names.push_back(ball.id);
  const record::RotaryInfluencesTask said =
      task.uncertainty.value_or(record::RotaryInfluencesTask());
  out.machine_u_mm = record::u_of(said.ball_um) * kMicrometre;
  out.repeat_u_rad = record::u_of(said.repeat_urad) * kMicroradian;
  out.placing_u_rad = std::hypot(record::u_of(said.reading_urad) * kMicroradian, out.repeat_u_rad);
  const double radius_mm = 0.5 * task.ball_diameter_mm + tip_mm;
  double squares_mm2 = 0.0;
  double sum_mm = 0.0;
  double per_radius = 0.0;
  int freedoms = -1;  // a radius of all balls
  for (const record::PoseVisit& visit : record.poses) {
    if (visit.feature != index) continue;
    std::map<int, std::vector<Vector3d>> tips;
    for (const record::Touch& touch : record.touches) {
      if (touch.purpose != record::Touch::Purpose::kMeasure || touch.pose != visit.id) continue;
      tips[touch.layer].push_back(touch.tip_mm);
      ++out.touches;
    }
    VisitBalls balls{visit.commanded, visit.reached, {}};
    for (const auto& [ball, points] : tips) {
      if (ball < 0 || static_cast<std::size_t>(ball) >= out.names.size()) {
        return core::fail_with(core::Code::kJournal, "ball {} was touched and has no name", ball);
      }
      TRY(const auto center, center_of(points, radius_mm, record.artefact.form_limit_mm,
                                       out.names[static_cast<std::size_t>(ball)], visit.commanded));
      squares_mm2 += center.sum_squares_mm2;
      sum_mm += center.sum_mm;
      per_radius += center.sum_per_radius;
      freedoms += static_cast<int>(points.size()) - 3;
      balls.centers[ball] = center;
    }
    out.visits.push_back(std::move(balls));
  }
  if (freedoms <= 0) return core::fail(core::Code::kNoPoints, "no ball was touched");
  // Touches without scatter, as in an error-free simulation, are still rounded to their digits.
  // The error of the tip radius is in all residuals alike, and is no scatter of a touch.
  if (per_radius < 0.0) squares_mm2 -= sum_mm * sum_mm / -per_radius;
  out.touch_sigma_mm = std::max(1e-9, std::sqrt(std::max(0.0, squares_mm2) / freedoms));
  return out;
}

std::vector<const record::Touch*> ball_touches(const record::RunRecord& record, int index) {
  std::vector<const record::Touch*> out;
  for (const record::Touch& touch : record.touches) {
    if (touch.purpose != record::Touch::Purpose::kMeasure || touch.pose < 0) continue;
    const auto owner =
        std::find_if(record.poses.begin(), record.poses.end(),
                     [&](const record::PoseVisit& visit) { return visit.id == touch.pose; });
    if (owner != record.poses.end() && owner->feature == index) out.push_back(&touch);
  }
  return out;
}

enum class Role { kReference, kAlpha, kBeta, kCombined };

Role role_of(const core::Pose& commanded) {
  const bool alpha = std::abs(commanded.alpha_rad) > kZero_rad;
  const bool beta = std::abs(commanded.beta_rad) > kZero_rad;
  if (alpha && beta) return Role::kCombined;
  if (alpha) return Role::kAlpha;
  return beta ? Role::kBeta : Role::kReference;
}

/// Motion of the body from one pose to another, in the frame of the machine; the identity, to the
/// last bit, for the same pose.
Eigen::Isometry3d between(const fixture::Kinematics& known, const core::Pose& from,
                          const core::Pose& to) {
  if (from == to) return Eigen::Isometry3d::Identity();
  return body_to_machine(known, to) * body_to_machine(known, from).inverse();
}

std::vector<fit::BallCentre> moved(std::vector<fit::BallCentre> balls,
                                   const Eigen::Isometry3d& motion) {
  for (fit::BallCentre& ball : balls) ball.centre_mm = motion * ball.centre_mm;
  return balls;
}

/// Covariance by which uncertain angles of both axes misplace the body at a station of the
/// base-fixed axis, about its point. At angle 0 it is that of any zero pose.
fit::Matrix6 alpha_placing(const Vector3d& offset_mm, double alpha_rad, double u_rad) {
  const Eigen::AngleAxisd turn(alpha_rad, Vector3d::UnitX());
  return fit::turn_covariance(Vector3d::UnitX(), Vector3d::Zero(), u_rad) +
         fit::turn_covariance(turn * Vector3d::UnitY(), turn * offset_mm, u_rad);
}

/// The same at a station of the carried axis, about the point of that axis.
fit::Matrix6 beta_placing(const Vector3d& offset_mm, double u_rad) {
  return fit::turn_covariance(Vector3d::UnitY(), Vector3d::Zero(), u_rad) +
         fit::turn_covariance(Vector3d::UnitX(), -offset_mm, u_rad);
}

/// A visit as a station of an axis: the nominal place of the balls follows from both readings.
/// @param known  With the errors of the other axis, as far as they are known.
fit::RotaryPose station_of(const Measurement& measured, const VisitBalls& visit, Role role,
                           const fixture::Kinematics& known) {
  const core::Pose& at = visit.reached;
  fit::RotaryPose out;
  out.balls = measured.balls_of(visit);
  if (role == Role::kAlpha) {
    out.angle_rad = at.alpha_rad;
    out.carried = between(known, {}, {0.0, at.beta_rad});
    out.placing_covariance =
        alpha_placing(known.axis_offset_mm, at.alpha_rad, measured.placing_u_rad);
  } else {
    out.angle_rad = at.beta_rad;
    out.balls = moved(std::move(out.balls), between(known, at, {0.0, at.beta_rad}));
    out.placing_covariance = beta_placing(known.axis_offset_mm, measured.placing_u_rad);
  }
  return out;
}

core::Result<fit::RotaryStudy> study_of(const Measurement& measured, Role role,
                                        const fixture::Kinematics& known) {
  const bool of_alpha = role == Role::kAlpha;
  fit::RotaryMeasurement task;
  if (of_alpha) {
    task.axis = {Vector3d::UnitX(), known.axis_point_W_mm};
  } else {
    task.axis = {Vector3d::UnitY(), known.axis_point_W_mm + known.axis_offset_mm};
  }
  for (const VisitBalls& visit : measured.visits) {
    const Role here = role_of(visit.commanded);
    if (here == Role::kReference) {
      task.references.push_back(moved(measured.balls_of(visit), between(known, visit.reached, {})));
    } else if (here == role) {
      task.stations.push_back(station_of(measured, visit, role, known));
    }
  }
  const fit::Matrix6 placing =
      of_alpha ? alpha_placing(known.axis_offset_mm, 0.0, measured.placing_u_rad)
               : beta_placing(known.axis_offset_mm, measured.placing_u_rad);
  // The zero pose between the axes is the station at 0 for both.
  if (task.references.size() > 2) {
    fit::RotaryPose zero;
    zero.balls = task.references[task.references.size() / 2];
    zero.placing_covariance = placing;
    task.stations.push_back(std::move(zero));
  }
  if (!task.references.empty()) {
    task.reference_placing = placing / static_cast<double>(task.references.size());
  }
  return fit::identify_rotary_axis(task);
}

core::Result<std::shared_ptr<const fixture::StationMotion>> motion_of(
    const fit::RotaryStudy& study) {
  TRY(const auto model, fit::RotaryModel::of(study.table));
  std::vector<fixture::AxisStation> stations;
  for (const fit::RotaryTableRow& row : study.table.rows) {
    TRY(const auto errors, model.at(row.angle_rad));
    stations.push_back({row.angle_rad, {errors.t_mm, errors.w_rad}, errors.covariance});
  }
  return fixture::StationMotion::through(std::move(stations));
}

/// One mode for each direction in which the mean of the zero poses is uncertain. It turns with the
/// body, and is the same for both axes, since both refer to these poses. The split of the
/// covariance of the carried axis is turned to fit that of the base-fixed one.
std::vector<fixture::CommonMode> zero_pose_modes(const RotaryResult& facts,
                                                 const Vector3d& offset_mm) {
  const fit::RotaryTable& of_alpha = facts.alpha.table;
  const fit::RotaryTable& of_beta = facts.beta.table;
  const Eigen::LLT<fit::Matrix6> alpha(of_alpha.reference_covariance);
  const Eigen::LLT<fit::Matrix6> beta(of_beta.reference_covariance);
  if (alpha.info() != Eigen::Success || beta.info() != Eigen::Success) return {};
  const fit::Matrix6 alpha_root = alpha.matrixL();
  fit::Matrix6 to_beta = fit::Matrix6::Identity();  // t + w x d
  to_beta.topRightCorner<3, 3>() = -fit::cross_matrix(offset_mm);
  const Eigen::MatrixXd alike = beta.matrixL().solve(to_beta * alpha_root);
  const core::SingularVectors split = core::singular_vectors(alike);
  const fit::Matrix6 beta_root = fit::Matrix6(beta.matrixL()) * split.u * split.v.transpose();
  const auto turned = [](const fit::RotaryTable& table, const fit::Vector6& mode) {
    std::vector<fixture::ErrorVector> out;
    for (const fit::RotaryTableRow& row : table.rows) {
      const Eigen::Matrix3d turn = table.axis.turn(row.angle_rad - table.reference_rad);
      fixture::ErrorVector& station = out.emplace_back();
      station << turn * mode.head<3>(), turn * mode.tail<3>();
    }
    return out;
  };
  std::vector<fixture::CommonMode> out;
  for (Eigen::Index k = 0; k < 6; ++k) {
    out.push_back({fmt::format("zero-poses-{}", k + 1), turned(of_alpha, alpha_root.col(k)),
                   turned(of_beta, beta_root.col(k))});
  }
  return out;
}

/// Covariance of the motion (t; w) that a calibration predicts for a pose, about the base-fixed
/// axis: the stations of both axes, and the readings of the pose.
fit::Matrix6 predicted_covariance(const fixture::Calibration& c, const core::Pose& pose,
                                  double placing_u_rad) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(pose.alpha_rad, Vector3d::UnitX()).toRotationMatrix();
  // Errors of the carried axis refer to its own point: t = R t2 + (R d) x (R w2).
  fit::Matrix6 to_base = fit::Matrix6::Zero();
  to_base.topLeftCorner<3, 3>() = turn;
  to_base.topRightCorner<3, 3>() = fit::cross_matrix(turn * c.axis_offset_mm) * turn;
  to_base.bottomRightCorner<3, 3>() = turn;
  return c.alpha->covariance_at(pose.alpha_rad) +
         to_base * c.beta->covariance_at(pose.beta_rad) * to_base.transpose() +
         alpha_placing(c.axis_offset_mm, pose.alpha_rad, placing_u_rad);
}

/// Checks that every ball touched in a combined pose has a place from the zero poses.
core::Result<void> check_balls(const Measurement& measured, const RotaryResult& facts) {
  const auto& reference = facts.alpha.reference;
  for (const VisitBalls& visit : measured.visits) {
    for (const auto& [ball, center] : visit.centers) {
      const std::string& name = measured.names[static_cast<std::size_t>(ball)];
      const bool known = std::any_of(reference.begin(), reference.end(),
                                     [&](const fit::BallCentre& at) { return at.ball == name; });
      if (known) continue;
      return core::fail_with(core::Code::kInconsistent, "ball {} was touched in no zero pose",
                             name);
    }
  }
  return {};
}

/// Sums over the points of the combined poses.
struct Sums {
  double after_mm2 = 0.0;
  double before_mm2 = 0.0;
  double expected_mm2 = 0.0;
};

/// Residual at one combined pose; its points are added to the sums and the largest distances.
CombinedPose verify_pose(const Measurement& measured, const VisitBalls& visit,
                         const std::map<std::string, Vector3d>& body_mm, RotaryResult& facts,
                         Sums& sums) {
  fixture::Verification& v = facts.calibration.verification;
  const fixture::Kinematics nominal{facts.calibration.axis_point_mm,
                                    facts.calibration.axis_offset_mm};
  const Eigen::Isometry3d real =
      body_to_machine(fixture::compensated(nominal, facts.calibration), visit.reached);
  const Eigen::Isometry3d ideal = body_to_machine(nominal, visit.reached);
  CombinedPose out;
  out.pose = visit.reached;
  out.covariance = predicted_covariance(facts.calibration, visit.reached, measured.placing_u_rad);
  std::vector<Vector3d> predicted;
  std::vector<Vector3d> found;
  double after_mm2 = 0.0;
  double before_mm2 = 0.0;
  for (const auto& [ball, center] : visit.centers) {
    const Vector3d& p0 = body_mm.at(measured.names[static_cast<std::size_t>(ball)]);
    predicted.emplace_back(real * p0);
    found.push_back(center.center_mm);
    const double left_mm = (found.back() - predicted.back()).norm();
    const double whole_mm = (found.back() - ideal * p0).norm();
    after_mm2 += left_mm * left_mm;
    before_mm2 += whole_mm * whole_mm;
    out.max_mm = std::max(out.max_mm, left_mm);
    v.before_max_mm = std::max(v.before_max_mm, whole_mm);
    out.at_mm.emplace_back(predicted.back() - facts.calibration.axis_point_mm);
    out.residual_mm.emplace_back(found.back() - predicted.back());
    sums.expected_mm2 += fit::point_covariance_mm2(out.covariance, out.at_mm.back()).trace() +
                         measured.u_mm(center).squaredNorm();
  }
  out.points = predicted.size();
  out.rms_mm = std::sqrt(after_mm2 / static_cast<double>(out.points));
  out.before_rms_mm = std::sqrt(before_mm2 / static_cast<double>(out.points));
  if (const auto moved = fit::rigid_registration(predicted, found)) {
    out.tilt_rad = fixture::errors_of(moved->motion).tilt_rad.norm();
  }
  sums.after_mm2 += after_mm2;
  sums.before_mm2 += before_mm2;
  return out;
}

void verify_combined(const Measurement& measured, RotaryResult& facts) {
  fixture::Verification& v = facts.calibration.verification;
  std::map<std::string, Vector3d> body_mm;
  for (const fit::BallCentre& ball : facts.alpha.reference) {
    body_mm[ball.ball] =
        ball.centre_mm - facts.calibration.axis_point_mm - facts.calibration.axis_offset_mm;
  }
  Sums sums;
  for (const VisitBalls& visit : measured.visits) {
    if (role_of(visit.commanded) != Role::kCombined || visit.centers.empty()) continue;
    facts.combined.push_back(verify_pose(measured, visit, body_mm, facts, sums));
    v.points += static_cast<int>(facts.combined.back().points);
    v.max_mm = std::max(v.max_mm, facts.combined.back().max_mm);
    v.max_tilt_rad = std::max(v.max_tilt_rad, facts.combined.back().tilt_rad);
  }
  v.poses = static_cast<int>(facts.combined.size());
  if (v.points == 0) return;
  v.rms_mm = std::sqrt(sums.after_mm2 / v.points);
  v.before_rms_mm = std::sqrt(sums.before_mm2 / v.points);
  v.expected_mm = std::sqrt(sums.expected_mm2 / v.points);
}

core::Result<void> date_calibration(const record::RunRecord& record, const RotaryTask& task,
                                    fixture::Calibration& out) {
  TRY(const auto fixture, record::task_of<record::FixtureSettings>(record.settings, "fixture/"));
  out.id = record.header.run_id;
  out.fixture_id = fixture.id;
  out.measured_utc = record.header.started_utc;
  const auto start = core::parse_utc(out.measured_utc);
  if (!start) {
    return core::fail_with(
        core::Code::kMeaning,
        "the run states no time, but \"{}\": a calibration without a date cannot expire",
        out.measured_utc);
  }
  out.expires_utc =
      core::utc_text(*start + static_cast<std::int64_t>(task.valid_for_days * kDay_s));
  out.axis_point_mm = Vector3d::Map(fixture.axis_point_mm.data());
  out.axis_offset_mm = Vector3d::Map(fixture.axis_offset_mm.data());
  return {};
}

/// Condition of all balls about the base-fixed axis, and the uncertainty of a centre.
void judge_balls(const Measurement& measured, RotaryResult& facts) {
  std::vector<Vector3d> balls;
  for (const fit::BallCentre& ball : facts.alpha.reference) {
    balls.emplace_back(ball.centre_mm - facts.calibration.axis_point_mm);
  }
  facts.condition = fit::setup_condition(balls);
  double variance = 0.0;
  double count = 0.0;
  for (const VisitBalls& visit : measured.visits) {
    for (const auto& [ball, center] : visit.centers) {
      variance += measured.u_mm(center).squaredNorm() / 3.0;
      count += 1.0;
    }
  }
  facts.center_u_mm = std::sqrt(variance / count);
}

/// Identifies both axes.
/// @param known  Kinematics with which the readings are taken into account.
core::Result<void> identify(const Measurement& measured, const fixture::Kinematics& known,
                            RotaryResult& facts) {
  auto alpha = study_of(measured, Role::kAlpha, known);
  if (!alpha) return core::fail_with(alpha.error().code, "axis alpha: {}", alpha.error().what);
  auto beta = study_of(measured, Role::kBeta, known);
  if (!beta) return core::fail_with(beta.error().code, "axis beta: {}", beta.error().what);
  TRY(auto alpha_motion, motion_of(*alpha));
  TRY(auto beta_motion, motion_of(*beta));
  facts.alpha = *std::move(alpha);
  facts.beta = *std::move(beta);
  facts.calibration.alpha = std::move(alpha_motion);
  facts.calibration.beta = std::move(beta_motion);
  facts.calibration.common_modes = zero_pose_modes(facts, known.axis_offset_mm);
  return {};
}

/// Largest reading of the axis that is not measured, at stations and zero poses.
double largest_off_rad(const Measurement& measured) {
  double out = 0.0;
  for (const VisitBalls& visit : measured.visits) {
    const Role role = role_of(visit.commanded);
    if (role == Role::kAlpha || role == Role::kReference) {
      out = std::max(out, std::abs(visit.reached.beta_rad));
    }
    if (role == Role::kBeta || role == Role::kReference) {
      out = std::max(out, std::abs(visit.reached.alpha_rad));
    }
  }
  return out;
}

/// Largest difference of a ball coordinate between two zero poses, in its standard uncertainty.
double reference_sigmas(const Measurement& measured, const fixture::Kinematics& known) {
  const fit::Matrix6 placing = alpha_placing(known.axis_offset_mm, 0.0, measured.placing_u_rad);
  std::vector<std::vector<fit::BallCentre>> all;
  for (const VisitBalls& visit : measured.visits) {
    if (role_of(visit.commanded) != Role::kReference) continue;
    all.push_back(moved(measured.balls_of(visit), between(known, visit.reached, {})));
  }
  double out = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      for (const fit::BallCentre& a : all[i]) {
        for (const fit::BallCentre& b : all[j]) {
          if (a.ball != b.ball) continue;
          const Vector3d p = a.centre_mm - known.axis_point_W_mm;
          const Vector3d variance = a.u_mm.cwiseAbs2() + b.u_mm.cwiseAbs2() +
                                    2.0 * fit::point_covariance_mm2(placing, p).diagonal();
          const Vector3d apart = (a.centre_mm - b.centre_mm).cwiseAbs();
          out = std::max(out, apart.cwiseQuotient(variance.cwiseSqrt()).maxCoeff());
        }
      }
    }
  }
  return out;
}

PlacingFacts placing_of(const record::RunRecord& record, const RotaryTask& task,
                        const Measurement& measured, const fixture::Kinematics& known) {
  PlacingFacts out;
  std::vector<Vector3d> balls;
  for (const record::BallTask& ball : task.balls) {
    balls.emplace_back(Vector3d::Map(ball.center_mm.data()));
  }
  out.off_rad = largest_off_rad(measured);
  out.off_limit_rad = fit::station_gate_rad(fit::largest_lever_mm(balls, known.axis_offset_mm));
  for (const VisitBalls& visit : measured.visits) {
    out.missed_rad =
        std::max({out.missed_rad, std::abs(visit.reached.alpha_rad - visit.commanded.alpha_rad),
                  std::abs(visit.reached.beta_rad - visit.commanded.beta_rad)});
    if (role_of(visit.commanded) == Role::kReference) ++out.references;
  }
  const auto fixture = record::task_of<record::FixtureSettings>(record.settings, "fixture/");
  if (fixture && fixture->resolution_deg) {
    out.missed_limit_rad =
        fit::drive_gate_rad(*fixture->resolution_deg * kDegree, measured.repeat_u_rad,
                            fixture->setting_uncertainty_deg.value_or(0.0) * kDegree) +
        kZero_rad;
  }
  out.reference_sigmas = reference_sigmas(measured, known);
  return out;
}

/// The same motion with its covariances multiplied by `factor`.
core::Result<std::shared_ptr<const fixture::StationMotion>> scaled(
    const fixture::StationMotion& motion, double factor) {
  std::vector<fixture::AxisStation> stations = motion.stations();
  for (fixture::AxisStation& station : stations) station.covariance *= factor;
  return fixture::StationMotion::through(std::move(stations));
}

/// Compares the combined poses with what the calibration explains. Where they show more, its
/// covariances grow by the square of the scale.
core::Result<void> weigh_combined(RotaryResult& facts) {
  double chi2 = 0.0;
  double dof = 0.0;
  for (const AxisFacts& axis : axes_of(facts)) {
    chi2 += axis.study->s0 * axis.study->s0 * axis.study->dof;
    dof += axis.study->dof;
  }
  facts.noise_mm = facts.center_u_mm * (dof > 0.0 ? std::max(1.0, std::sqrt(chi2 / dof)) : 1.0);
  if (facts.combined.empty()) return {};
  const CombinedField field(facts.combined, facts.noise_mm);
  facts.scale_low = field.scale_at(0.025);
  facts.scale = field.scale_at(0.5);
  facts.scale_high = field.scale_at(0.975);
  if (facts.scale_low <= 1.0) return {};
  const double factor = facts.scale * facts.scale;
  TRY(auto alpha, scaled(*facts.calibration.alpha, factor));
  TRY(auto beta, scaled(*facts.calibration.beta, factor));
  facts.calibration.alpha = std::move(alpha);
  facts.calibration.beta = std::move(beta);
  for (fixture::CommonMode& mode : facts.calibration.common_modes) {
    for (auto* const stations : {&mode.alpha, &mode.beta}) {
      for (fixture::ErrorVector& station : *stations) station *= facts.scale;
    }
  }
  return {};
}

/// A tip of another radius shifts every ball to the side on which it is touched, whatever the pose;
/// the zero poses turn their shift with the body. What is left is common to all stations. At the
/// combined poses both axes together cancel it.
core::Result<void> add_tip_radius(const Measurement& measured, RotaryResult& facts) {
  constexpr double kLeast_mm = 1e-9;
  if (facts.tip_u_mm < kLeast_mm) return {};
  Vector3d side = Vector3d::Zero();
  double count = 0.0;
  for (const VisitBalls& visit : measured.visits) {
    for (const auto& [ball, center] : visit.centers) side += center.per_radius;
    count += static_cast<double>(visit.centers.size());
  }
  side *= facts.tip_u_mm / count;
  const auto add = [&](const fit::RotaryTable& table, auto& motion,
                       std::vector<fixture::ErrorVector>& mode) -> core::Result<void> {
    std::vector<fixture::AxisStation> stations = motion->stations();
    for (fixture::AxisStation& station : stations) {
      fixture::ErrorVector& by = mode.emplace_back(fixture::ErrorVector::Zero());
      by.head<3>() = side - table.axis.turn(station.angle_rad - table.reference_rad) * side;
      station.covariance += by * by.transpose();
    }
    TRY(motion, fixture::StationMotion::through(std::move(stations)));
    return {};
  };
  fixture::Calibration& c = facts.calibration;
  fixture::CommonMode mode{kTipRadius, {}, {}};
  TRY_DO(add(facts.alpha.table, c.alpha, mode.alpha));
  TRY_DO(add(facts.beta.table, c.beta, mode.beta));
  c.common_modes.push_back(std::move(mode));
  return {};
}

core::Result<RotaryResult> facts_of(const record::RunRecord& record, int index,
                                    const fit::ProbeTip& probe, std::vector<Gate>& gates) {
  TRY(const auto task,
      record::task_of<RotaryTask>(record.features[static_cast<std::size_t>(index)].settings));
  TRY(auto measured, measure(record, index, task, probe.radius_mm));
  RotaryResult facts;
  fixture::Calibration& c = facts.calibration;
  TRY_DO(date_calibration(record, task, c));
  const fixture::Kinematics nominal{c.axis_point_mm, c.axis_offset_mm};
  TRY_DO(identify(measured, nominal, facts));
  // Once more with the errors that the other axis has where it stood: its place alone, some 25 um
  // off, turns by more than the limit of that angle allows for.
  if (largest_off_rad(measured) > 0.0) {
    const fixture::Kinematics known = fixture::compensated(nominal, c);
    TRY_DO(identify(measured, known, facts));
  }
  facts.declared = task.uncertainty;
  if (facts.declared && facts.declared->expansion_per_K) {
    c.expansion_1_K = record::u_of(facts.declared->expansion_per_K);
  }
  facts.balls = measured.names;
  facts.poses = measured.visits.size();
  facts.touches = measured.touches;
  facts.touch_sigma_mm = measured.touch_sigma_mm;
  facts.tip_u_mm = probe.radius_per_touch * measured.touch_sigma_mm;
  TRY_DO(check_balls(measured, facts));
  judge_balls(measured, facts);
  verify_combined(measured, facts);
  TRY_DO(weigh_combined(facts));
  TRY_DO(add_tip_radius(measured, facts));
  gates = rotary_gates(facts, placing_of(record, task, measured, nominal));
  return facts;
}

/// The gate of the growth of the fixture while it was calibrated; none where its expansion is not
/// declared or the temperature is not known.
std::optional<Gate> growth_gate(const RotaryResult& facts, const FeatureResult& result) {
  if (!facts.declared || !facts.declared->expansion_per_K || !result.temperatures) {
    return std::nullopt;
  }
  double lever_mm = 0.0;
  for (const fit::BallCentre& ball : facts.alpha.reference) {
    lever_mm = std::max(lever_mm, (ball.centre_mm - facts.calibration.axis_point_mm).norm());
  }
  const double range_K = result.temperatures->greatest_degC - result.temperatures->least_degC;
  const double growth_mm = record::u_of(facts.declared->expansion_per_K) * lever_mm * range_K;
  const double limit_mm = fit::StationGateOptions().point_u_mm / 3.0;
  Gate out;
  out.code = "growth";
  out.condition = core::phrase("growth of the fixture while it was calibrated");
  out.found = growth_mm / kMicrometre;
  out.limit = limit_mm / kMicrometre;
  out.unit = "um";
  if (growth_mm > limit_mm) {
    out.outcome = Gate::Outcome::kWarns;
    out.reason = core::phrase(
        "the temperature changed by {:.2f} K, by which the fixture grows {} um at its balls (limit "
        "{} um): calibrate at a steadier temperature",
        range_K, core::um(growth_mm), core::um(limit_mm));
  }
  return out;
}

void warn_rotary(const RotaryResult& facts, const std::vector<Gate>& gates,
                 std::vector<core::Error>& warnings) {
  for (const AxisFacts& axis : axes_of(facts)) {
    for (const core::Error& warning : axis.study->warnings) {
      warnings.push_back(
          {warning.code, fmt::format("axis {}: {}", axis.key, warning.what), warning.where});
    }
  }
  for (const Gate& gate : gates) {
    if (gate.outcome == Gate::Outcome::kPassed) continue;
    warnings.push_back({core::Code::kInconsistent, gate.reason.english(), {}});
  }
}

}  // namespace

core::Result<RotaryResult> evaluate_rotary(const record::RunRecord& record, int index,
                                           const std::optional<fit::ProbeTip>& probe,
                                           FeatureResult& result) {
  result.temperatures = temperatures_of(record, ball_touches(record, index));
  if (!is_complete(record, static_cast<std::size_t>(index))) {
    return core::fail(core::Code::kNoPoints,
                      record.failure
                          ? fmt::format("not measured to its end: {}", record.failure->what)
                          : "the run ended before all poses were measured");
  }
  if (!probe) return core::fail(core::Code::kCalibration, "the probe was not qualified");
  TRY(auto facts, facts_of(record, index, *probe, result.gates));
  if (auto growth = growth_gate(facts, result)) result.gates.push_back(*std::move(growth));
  // Those of the temperature are listed with the gates of every analysis.
  facts.withheld = voided_by(temperature_gates(record, result));
  if (!facts.withheld) facts.withheld = voided_by(result.gates);
  if (result.temperatures && !result.temperatures->declared) {
    facts.calibration.temperature_degC = result.temperatures->mean_degC;
  }
  warn_rotary(facts, result.gates, result.warnings);
  return facts;
}

}  // namespace rondure::evaluation
