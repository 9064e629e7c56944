#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "core/units.h"
#include "core/utc.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/rotary/result.h"
#include "fit/geometry/registration.h"
#include "fit/rotary/ball_center.h"
#include "fit/rotary/ball_setup.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using core::kMicrometre;
using Eigen::Vector3d;
using record::RotaryTask;

constexpr double kZero_rad = 1e-9;  // tolerance of a commanded angle
// tolerance of the other axis at a station: 0.1 um at a lever of 100 mm
constexpr double kBeside_rad = 1e-6;
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
  double machine_u_mm = 0.0;
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
    return core::fail(center.error().code, fmt::format("{}: {}", place, center.error().what));
  }
  if (center->deviation_mm > form_limit_mm) {
    return core::fail(
        core::Code::kCalibration,
        fmt::format("{} has a form of {:.3f} um, the limit is {:g} um (form_limit_um); clean it "
                    "and check that it is tight",
                    place, center->deviation_mm / kMicrometre, form_limit_mm / kMicrometre));
  }
  return center;
}

/// Fits every ball of every pose, the radius held.
core::Result<Measurement> measure(const record::RunRecord& record, int index,
                                  const RotaryTask& task, double tip_mm) {
  Measurement out;
  for (const record::BallTask& ball : task.balls) out.names.push_back(ball.id);
  out.machine_u_mm = task.machine_uncertainty_um * kMicrometre;
  const double radius_mm = 0.5 * task.ball_diameter_mm + tip_mm;
  double squares_mm2 = 0.0;
  int freedoms = 0;
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
        return core::fail(core::Code::kJournal,
                          fmt::format("ball {} was touched and has no name", ball));
      }
      const auto center = center_of(points, radius_mm, record.artefact.form_limit_mm,
                                    out.names[static_cast<std::size_t>(ball)], visit.commanded);
      if (!center) return core::fail(center.error());
      squares_mm2 += center->sum_squares_mm2;
      freedoms += static_cast<int>(points.size()) - 3;
      balls.centers[ball] = *center;
    }
    out.visits.push_back(std::move(balls));
  }
  if (freedoms <= 0) return core::fail(core::Code::kNoPoints, "no ball was touched");
  // Touches without scatter, as in an error-free simulation, are still rounded to their digits.
  out.touch_sigma_mm = std::max(1e-9, std::sqrt(squares_mm2 / freedoms));
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

/// Checks that the axis that is not measured is at 0.
core::Result<void> check_other_axis(const VisitBalls& visit, Role role) {
  const bool of_alpha = role == Role::kAlpha;
  const double other_rad = of_alpha ? visit.reached.beta_rad : visit.reached.alpha_rad;
  if (role == Role::kCombined || std::abs(other_rad) <= kBeside_rad) return {};
  return core::fail(
      core::Code::kInconsistent,
      fmt::format("in the pose ({:g}, {:g}) deg {} reads {:.6f} deg and must be 0 within {:.6f}; a "
                  "fixture that cannot hold 0 cannot be calibrated in this way",
                  visit.commanded.alpha_rad / kDegree, visit.commanded.beta_rad / kDegree,
                  of_alpha ? "beta" : "alpha", other_rad / kDegree, kBeside_rad / kDegree));
}

core::Result<fit::RotaryStudy> study_of(const Measurement& measured, Role role,
                                        const Vector3d& direction, const Vector3d& origin_mm) {
  fit::RotaryMeasurement task;
  task.axis = {direction, origin_mm};
  std::vector<const VisitBalls*> references;
  for (const VisitBalls& visit : measured.visits) {
    const Role here = role_of(visit.commanded);
    if (auto other = check_other_axis(visit, here); !other) return core::fail(other.error());
    if (here == Role::kReference) {
      task.references.push_back(measured.balls_of(visit));
      references.push_back(&visit);
    } else if (here == role) {
      const double angle_rad =
          role == Role::kAlpha ? visit.reached.alpha_rad : visit.reached.beta_rad;
      task.stations.push_back({angle_rad, fit::Approach::kUnknown, measured.balls_of(visit)});
    }
  }
  // The zero pose between the axes is the station at 0 for both.
  if (references.size() > 2) {
    task.stations.push_back(
        {0.0, fit::Approach::kUnknown, measured.balls_of(*references[references.size() / 2])});
  }
  return fit::identify_rotary_axis(task);
}

core::Result<std::shared_ptr<const fixture::StationMotion>> motion_of(
    const fit::RotaryStudy& study) {
  const auto model = fit::RotaryModel::of(study.table);
  if (!model) return core::fail(model.error());
  std::vector<fixture::AxisStation> stations;
  for (const fit::RotaryTableRow& row : study.table.rows) {
    const auto errors = model->at(row.angle_rad);
    if (!errors) return core::fail(errors.error());
    stations.push_back({row.angle_rad, {errors->t_mm, errors->w_rad}, errors->covariance});
  }
  return fixture::StationMotion::through(std::move(stations));
}

/// Variance of a point at a combined pose, from the stations of both axes and its own ball.
double variance_mm2(const fixture::Calibration& c, const core::Pose& pose, const Vector3d& p_W_mm,
                    const Vector3d& u_mm) {
  const Vector3d about_alpha = p_W_mm - c.axis_point_mm;
  const Vector3d about_beta =
      Eigen::AngleAxisd(-pose.alpha_rad, Vector3d::UnitX()) * about_alpha - c.axis_offset_mm;
  return fit::point_covariance_mm2(c.alpha->covariance_at(pose.alpha_rad), about_alpha).trace() +
         fit::point_covariance_mm2(c.beta->covariance_at(pose.beta_rad), about_beta).trace() +
         u_mm.squaredNorm();
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
      return core::fail(core::Code::kInconsistent,
                        fmt::format("ball {} was touched in no zero pose", name));
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
    sums.expected_mm2 +=
        variance_mm2(facts.calibration, visit.reached, predicted.back(), measured.u_mm(center));
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
  const auto fixture = record::task_of<record::FixtureSettings>(record.settings, "fixture/");
  if (!fixture) return core::fail(fixture.error());
  out.id = record.header.run_id;
  out.fixture_id = fixture->id;
  out.measured_utc = record.header.started_utc;
  const auto start = core::parse_utc(out.measured_utc);
  if (!start) {
    return core::fail(
        core::Code::kMeaning,
        fmt::format("the run states no time, but \"{}\": a calibration without a date "
                    "cannot expire",
                    out.measured_utc));
  }
  out.expires_utc =
      core::utc_text(*start + static_cast<std::int64_t>(task.valid_for_days * kDay_s));
  out.axis_point_mm = Vector3d::Map(fixture->axis_point_mm.data());
  out.axis_offset_mm = Vector3d::Map(fixture->axis_offset_mm.data());
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

core::Result<RotaryResult> facts_of(const record::RunRecord& record, int index, double tip_mm) {
  const auto task =
      record::task_of<RotaryTask>(record.features[static_cast<std::size_t>(index)].settings);
  if (!task) return core::fail(task.error());
  auto measured = measure(record, index, *task, tip_mm);
  if (!measured) return core::fail(measured.error());
  RotaryResult facts;
  fixture::Calibration& c = facts.calibration;
  if (auto dated = date_calibration(record, *task, c); !dated) return core::fail(dated.error());
  auto alpha = study_of(*measured, Role::kAlpha, Vector3d::UnitX(), c.axis_point_mm);
  if (!alpha)
    return core::fail(alpha.error().code, fmt::format("axis alpha: {}", alpha.error().what));
  auto beta =
      study_of(*measured, Role::kBeta, Vector3d::UnitY(), c.axis_point_mm + c.axis_offset_mm);
  if (!beta) return core::fail(beta.error().code, fmt::format("axis beta: {}", beta.error().what));
  auto alpha_motion = motion_of(*alpha);
  if (!alpha_motion) return core::fail(alpha_motion.error());
  auto beta_motion = motion_of(*beta);
  if (!beta_motion) return core::fail(beta_motion.error());
  facts.alpha = *std::move(alpha);
  facts.beta = *std::move(beta);
  c.alpha = *std::move(alpha_motion);
  c.beta = *std::move(beta_motion);
  facts.balls = measured->names;
  facts.poses = measured->visits.size();
  facts.touches = measured->touches;
  facts.touch_sigma_mm = measured->touch_sigma_mm;
  if (auto placed = check_balls(*measured, facts); !placed) return core::fail(placed.error());
  judge_balls(*measured, facts);
  verify_combined(*measured, facts);
  return facts;
}

void warn_rotary(const RotaryResult& facts, std::vector<core::Error>& warnings) {
  for (const AxisFacts& axis : axes_of(facts)) {
    for (const core::Error& warning : axis.study->warnings) {
      warnings.push_back(
          {warning.code, fmt::format("axis {}: {}", axis.key, warning.what), warning.where});
    }
  }
  constexpr double kExplained = 3.0;
  const fixture::Verification& v = facts.calibration.verification;
  if (v.rms_mm > kExplained * v.expected_mm) {
    warnings.push_back(
        {core::Code::kInconsistent,
         fmt::format("the combined poses leave {:.3f} um rms, the uncertainty "
                     "explains {:.3f} um: errors depend on both angles (gravity), or "
                     "something moved; measure axis beta at several alpha",
                     v.rms_mm / kMicrometre, v.expected_mm / kMicrometre),
         {}});
  }
}

}  // namespace

core::Result<RotaryResult> evaluate_rotary(const record::RunRecord& record, int index,
                                           FeatureResult& result) {
  result.temperatures = temperatures_of(record, ball_touches(record, index));
  if (record.ending != "finished") {
    return core::fail(core::Code::kNoPoints,
                      record.failure
                          ? fmt::format("not measured to its end: {}", record.failure->what)
                          : "the run ended before all poses were measured");
  }
  if (!result.tip_radius_mm) {
    return core::fail(core::Code::kCalibration, "the probe was not qualified");
  }
  auto facts = facts_of(record, index, *result.tip_radius_mm);
  if (!facts) return tl::unexpected(facts.error());
  if (result.temperatures && !result.temperatures->declared) {
    facts->calibration.temperature_degC = result.temperatures->mean_degC;
  }
  warn_rotary(*facts, result.warnings);
  return *std::move(facts);
}

}  // namespace rondure::evaluation
