// What the calibration of the fixture leaves in a form value: nothing in one pose, the motion of
// the poses against each other in a cloud of several.
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/decompositions.h"
#include "core/noise.h"
#include "core/units.h"
#include "evaluation/evaluate.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "fixture/calibration.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using ::testing::HasSubstr;

constexpr double kAxleRadius_mm = 25.0;
constexpr int kAxleLayers = 4;
constexpr int kAxlePoints = 24;

/// Two poses of an axle that leans to one side and to the other; each reaches half of it.
std::vector<core::Pose> leaning() { return {{75.0 * kDegree, 0.0}, {-75.0 * kDegree, 0.0}}; }

/// Two and three lobes and a taper, 10 um together.
double axle_form_mm(double angle_rad, double height_mm) {
  return 2.5e-3 * std::cos(2.0 * angle_rad + 0.01 * height_mm) +
         1.5e-3 * std::cos(3.0 * angle_rad + 1.0) + 1e-3 * height_mm / 60.0;
}

/// An axle in the frame of the body, touched with 0.05 um; the first pose touches the half with y <
/// 0.
FormCloud axle_cloud() {
  FormCloud cloud;
  core::KeyedNoise noise(5, {1});
  cloud.reference = record::Reference::kLeastSquares;
  cloud.radius_mm = kAxleRadius_mm;
  for (int layer = 0; layer < kAxleLayers; ++layer) {
    for (int i = 0; i < kAxlePoints; ++i) {
      FormPoint p;
      p.angle_rad = core::kTwoPi * (i + 0.5) / kAxlePoints;
      p.height_mm = 40.0 * layer - 60.0;
      p.deviation_mm = axle_form_mm(p.angle_rad, p.height_mm) + 0.05e-3 * noise.normal();
      p.pose = std::sin(p.angle_rad) < 0.0 ? 0 : 1;
      cloud.points.push_back(p);
    }
  }
  const MatrixXd rigid = rigid_basis(cloud);
  VectorXd deviations(rigid.rows());
  for (Index i = 0; i < deviations.size(); ++i) {
    deviations[i] = cloud.points[static_cast<std::size_t>(i)].deviation_mm;
  }
  deviations -= rigid * (rigid.transpose() * deviations);
  for (Index i = 0; i < deviations.size(); ++i) {
    cloud.points[static_cast<std::size_t>(i)].deviation_mm = deviations[i];
  }
  return cloud;
}

/// Where the body stands in the machine in a pose.
Eigen::Isometry3d axle_frame(const core::Pose& pose) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = (Eigen::AngleAxisd(pose.alpha_rad, Vector3d::UnitX()) *
                  Eigen::AngleAxisd(pose.beta_rad, Vector3d::UnitY()))
                     .toRotationMatrix();
  out.translation() = Vector3d(0.0, 0.0, 250.0);
  return out;
}

FormCloud axle_in_two_poses() {
  FormCloud cloud = axle_cloud();
  for (const core::Pose& pose : leaning()) cloud.frames.push_back(axle_frame(pose));
  return cloud;
}

Influences axle_probe() {
  Influences out;
  out.probe.emplace();
  out.probe->repeatability_mm = 0.05e-3;
  return out;
}

UncertaintyOptions axle_trials(int most = 1000, int budget = 4000) {
  UncertaintyOptions out;
  out.least_trials = 100;
  out.most_trials = most;
  out.budget_trials = budget;
  out.threads = 2;
  return out;
}

UncertaintyResult stated_of(const FormCloud& cloud, const Influences& influences,
                            const UncertaintyOptions& options = axle_trials()) {
  const auto out = measurement_uncertainty(cloud, influences, std::nullopt, options);
  EXPECT_TRUE(out) << out.error().what;
  return out.value_or(UncertaintyResult());
}

const BudgetLine& budget_line(const UncertaintyResult& result, const std::string& name) {
  static const BudgetLine none;
  for (const BudgetLine& line : result.budget) {
    if (line.name == name) return line;
  }
  ADD_FAILURE() << "no line " << name;
  return none;
}

const InfluenceStatement& statement_named(const UncertaintyResult& result,
                                          const std::string& name) {
  static const InfluenceStatement none;
  for (const InfluenceStatement& statement : result.declaration) {
    if (statement.name == name) return statement;
  }
  ADD_FAILURE() << "no statement " << name;
  return none;
}

TEST(CalibrationInfluence, OfOnePoseMovesNoForm) {
  for (const FormKind kind : {FormKind::kCylindricity, FormKind::kRoundness}) {
    FormCloud cloud = axle_cloud();
    cloud.kind = kind;
    for (FormPoint& point : cloud.points) point.pose = 0;
    if (kind == FormKind::kRoundness) {
      cloud.points.resize(kAxlePoints);
      for (FormPoint& point : cloud.points) point.height_mm = 0.0;
    }
    const UncertaintyResult without = stated_of(cloud, axle_probe(), axle_trials(10'000));
    Influences with = axle_probe();
    with.calibration.emplace();
    with.calibration->id = "run-7";
    with.calibration->draws = MatrixXd::Identity(6, 6);
    with.calibration->draws.topRows<3>() *= 5e-3;
    with.calibration->draws.bottomRows<3>() *= 50e-6;
    const UncertaintyResult result = stated_of(cloud, with, axle_trials(10'000));
    const double near =
        2.0 * (result.sampled.numerical_tolerance_mm + without.sampled.numerical_tolerance_mm);
    EXPECT_LT(near, 0.02e-3);
    EXPECT_NEAR(result.sampled.estimate_mm, without.sampled.estimate_mm, near);
    EXPECT_NEAR(result.sampled.low_mm, without.sampled.low_mm, near);
    EXPECT_NEAR(result.sampled.high_mm, without.sampled.high_mm, near);
    EXPECT_LT(budget_line(result, "calibration-stations").standard_uncertainty_mm, 1e-12);
    const InfluenceStatement& said = statement_named(result, "calibration-stations");
    EXPECT_TRUE(said.covered);
    EXPECT_THAT(said.text.english(), HasSubstr("calibration run-7"));
    EXPECT_THAT(said.text.english(), HasSubstr("one pose moves no form"));
  }
}

// A body that sits wrongly on the fixture, by the same amount in the frame of the body, is
// displaced differently in the machine in each pose, and has the same form.
TEST(CalibrationInfluence, CommonToAllPosesMovesNoForm) {
  const FormCloud cloud = axle_in_two_poses();
  Influences with = axle_probe();
  with.calibration.emplace();
  with.calibration->poses = 2;
  with.calibration->draws = MatrixXd::Zero(12, 6);
  for (Index k = 0; k < 6; ++k) {
    Vector3d shift_B = Vector3d::Zero();
    Vector3d turn_B = Vector3d::Zero();
    if (k < 3) {
      shift_B[k] = 5e-3;
    } else {
      turn_B[k - 3] = 50e-6;
    }
    for (std::size_t p = 0; p < 2; ++p) {
      const Eigen::Isometry3d& frame = cloud.frames[p];
      const Vector3d turn = frame.linear() * turn_B;
      const Vector3d origin = frame.translation();
      const auto first = static_cast<Index>(6 * p);
      with.calibration->draws.block<3, 1>(first, k) = frame.linear() * shift_B - turn.cross(origin);
      with.calibration->draws.block<3, 1>(first + 3, k) = turn;
    }
  }
  const UncertaintyResult result = stated_of(cloud, with);
  EXPECT_LT(budget_line(result, "calibration-stations").standard_uncertainty_mm, 1e-9);
  // The same displacements in the machine are no longer common: the part is turned between them.
  with.calibration->draws.bottomRows<6>() = with.calibration->draws.topRows<6>();
  EXPECT_GT(budget_line(stated_of(cloud, with), "calibration-stations").standard_uncertainty_mm,
            0.5e-3);
}

/// Peak to valley about the least-squares cylinder of points near the z axis, by five unknowns.
double axle_peak_to_valley_mm(const std::vector<Vector3d>& points_mm) {
  const auto n = static_cast<Index>(points_mm.size());
  MatrixXd design(n, 5);
  VectorXd radius(n);
  for (Index i = 0; i < n; ++i) {
    const Vector3d& p = points_mm[static_cast<std::size_t>(i)];
    const double r = std::hypot(p.x(), p.y());
    design.row(i) << 1.0, p.x() / r, p.y() / r, p.z() * p.x() / r, p.z() * p.y() / r;
    radius[i] = r;
  }
  const VectorXd left = radius - design * core::solve_pivoted_qr(design, radius);
  return left.maxCoeff() - left.minCoeff();
}

// Brute force: the axes' place in each pose is wrong by 1 um in every direction and by 10 urad
// about each, the two poses independent of each other, but for z, which they share.
TEST(CalibrationInfluence, MovesThePosesAgainstEachOtherAsBruteForceDoes) {
  const FormCloud cloud = axle_in_two_poses();
  MatrixXd draws = MatrixXd::Zero(12, 11);
  for (Index p = 0; p < 2; ++p) {
    Index column = p == 0 ? 1 : 6;
    for (const Index k : {0, 1, 3, 4, 5}) {
      draws(6 * p + k, column) = k < 3 ? 1e-3 : 10e-6;
      if (k >= 3) {  // about a point 250 mm above the origin
        draws.block<3, 1>(6 * p, column) =
            -(10e-6 * Vector3d::Unit(k - 3)).cross(Vector3d(0.0, 0.0, 250.0));
      }
      ++column;
    }
    draws(6 * p + 2, 0) = 1e-3;
  }
  Influences with = axle_probe();
  with.calibration.emplace();
  with.calibration->poses = 2;
  with.calibration->draws = draws;
  const UncertaintyResult result = stated_of(cloud, with);

  constexpr int kLoops = 4000;
  core::KeyedNoise noise(11, {1});
  double sum = 0.0;
  double squares = 0.0;
  for (int t = 0; t < kLoops; ++t) {
    Vector3d shift[2];
    Vector3d turn[2];
    const double common_z = 1e-3 * noise.normal();
    for (int p = 0; p < 2; ++p) {
      shift[p] = Vector3d(1e-3 * noise.normal(), 1e-3 * noise.normal(), common_z);
      turn[p] = 10e-6 * Vector3d(noise.normal(), noise.normal(), noise.normal());
    }
    std::vector<Vector3d> points;
    for (const FormPoint& point : cloud.points) {
      const double r = kAxleRadius_mm + point.deviation_mm;
      const Vector3d body(r * std::cos(point.angle_rad), r * std::sin(point.angle_rad),
                          point.height_mm);
      const double lean = (point.pose == 0 ? 75.0 : -75.0) * kDegree;
      const Eigen::Matrix3d turned = Eigen::AngleAxisd(lean, Vector3d::UnitX()).toRotationMatrix();
      const Vector3d from_pivot = turned * body;
      const Vector3d moved = shift[point.pose] + turn[point.pose].cross(from_pivot);
      points.emplace_back(turned.transpose() * (from_pivot + moved));
    }
    const double value = axle_peak_to_valley_mm(points);
    sum += value;
    squares += value * value;
  }
  const double brute_mm = std::sqrt(squares / kLoops - std::pow(sum / kLoops, 2));
  EXPECT_GT(brute_mm, 0.3e-3);
  // Two standard deviations of 4000 trials each are 1.6 %; the forms of the trials differ by the
  // noise of the touches.
  EXPECT_NEAR(budget_line(result, "calibration-stations").standard_uncertainty_mm, brute_mm,
              0.08 * brute_mm);
  EXPECT_EQ(result.budget.front().name, "calibration-stations") << "the largest stands first";
  EXPECT_TRUE(statement_named(result, "calibration-stations").covered);
  EXPECT_FALSE(statement_named(result, "calibration-temperature").covered);
  const UncertaintyResult without = stated_of(cloud, axle_probe());
  EXPECT_GT(result.sampled.expanded_mm(), 3.0 * without.sampled.expanded_mm());
}

TEST(CalibrationInfluence, OfTheGrowthIsRectangular) {
  const FormCloud cloud = axle_in_two_poses();
  Influences with = axle_probe();
  with.calibration.emplace();
  with.calibration->poses = 2;
  with.calibration->change_K = 0.4;
  with.calibration->draws = MatrixXd::Zero(12, 0);
  with.calibration->growth = MatrixXd::Zero(12, 1);
  (*with.calibration->growth)(2, 0) = 3e-3;  // z of the first pose, across the leaning axle
  const UncertaintyResult result = stated_of(cloud, with);
  EXPECT_THAT(statement_named(result, "calibration-temperature").text.english(),
              HasSubstr("0.40 K"));
  EXPECT_TRUE(statement_named(result, "calibration-temperature").covered);
  const double growth_mm = budget_line(result, "calibration-temperature").standard_uncertainty_mm;
  with.calibration->draws = *with.calibration->growth / std::sqrt(3.0);
  const double normal_mm =
      budget_line(stated_of(cloud, with), "calibration-stations").standard_uncertainty_mm;
  EXPECT_GT(normal_mm, 0.2e-3);
  EXPECT_NEAR(growth_mm, normal_mm, 0.08 * normal_mm) << "a half-width of 3 um is u 1.73 um";
}

TEST(CalibrationInfluence, IsRefusedWithoutSixRowsForEachPose) {
  Influences with = axle_probe();
  with.calibration.emplace();
  with.calibration->poses = 2;
  with.calibration->draws = MatrixXd::Zero(6, 1);
  EXPECT_FALSE(measurement_uncertainty(axle_in_two_poses(), with, std::nullopt, axle_trials()));
  FormCloud astray = axle_in_two_poses();
  astray.points[3].pose = 2;
  EXPECT_FALSE(measurement_uncertainty(astray, axle_probe(), std::nullopt, axle_trials()));
}

/// A calibration without errors whose stations, 15 deg apart over +-90 deg, are known to 1 um and
/// 5 urad, three quarters of these variances shared by all stations of an axis.
std::string axle_calibration(double degC) {
  fixture::Calibration out;
  out.id = "run-7";
  out.fixture_id = "F-01";
  out.measured_utc = "2026-11-01T08:00:00Z";
  out.expires_utc = "2027-11-01T08:00:00Z";
  out.temperature_degC = degC;
  out.expansion_1_K = 12e-6;
  out.axis_point_mm = {0.0, 0.0, 250.0};
  out.verification.max_mm = 2e-3;
  fixture::ErrorVector u;
  u << 1e-3, 1e-3, 1e-3, 5e-6, 5e-6, 5e-6;
  std::vector<fixture::AxisStation> stations;
  for (int k = -6; k <= 6; ++k) {
    fixture::AxisStation& station = stations.emplace_back();
    station.angle_rad = 15.0 * k * kDegree;
    station.covariance = u.cwiseAbs2().asDiagonal();
  }
  out.alpha = *fixture::StationMotion::through(stations);
  out.beta = out.alpha;
  for (Index k = 0; k < 6; ++k) {
    const fixture::ErrorVector shared = std::sqrt(0.75) * u[k] * fixture::ErrorVector::Unit(k);
    for (const bool of_alpha : {true, false}) {
      fixture::CommonMode mode{(of_alpha ? "alpha-" : "beta-") + std::to_string(k),
                               std::vector(stations.size(), fixture::ErrorVector(0.0 * shared)),
                               std::vector(stations.size(), fixture::ErrorVector(0.0 * shared))};
      (of_alpha ? mode.alpha : mode.beta).assign(stations.size(), shared);
      out.common_modes.push_back(std::move(mode));
    }
  }
  return calibration_text(out);
}

/// The axle touched at 20 degC in these poses, each target in the pose that reaches it, its touches
/// read through an ideal fixture.
record::RunRecord axle_run(const std::vector<core::Pose>& poses,
                           const std::optional<std::string>& calibration) {
  record::RunRecord run;
  run.ending = "finished";
  run.header.run_id = "axle";
  run.header.started_utc = "2026-11-21T10:00:00Z";
  run.header.decision_rule = "simple-acceptance";
  run.header.temperature_min_degC = 18.0;
  run.header.temperature_max_degC = 22.0;
  record::FixtureSettings fixture;
  fixture.id = "F-01";
  fixture.axis_point_mm = {0.0, 0.0, 250.0};
  fixture.min_alpha_deg = fixture.min_beta_deg = -80.0;
  fixture.max_alpha_deg = fixture.max_beta_deg = 80.0;
  fixture.calibration = calibration;
  run.settings = record::settings_of_task(fixture, "fixture/");
  run.settings.insert(run.settings.end(), {{"uncertainty/coverage_percent", 95.0, ""},
                                           {"uncertainty/least_trials", 2000.0, ""},
                                           {"uncertainty/most_trials", 2000.0, ""},
                                           {"uncertainty/budget_trials", 1000.0, ""},
                                           {"uncertainty/seed", 1.0, ""},
                                           {"uncertainty/probe/repeatability_um", 0.05, ""},
                                           {"uncertainty/declared", std::nullopt, "probe"}});
  record::Feature feature;
  feature.id = "axle";
  feature.shape = record::Shape::kCylinder;
  feature.layers = kAxleLayers;
  feature.points_per_layer = kAxlePoints;
  feature.characteristics = {
      {"CYLt", record::Form::kCylindricity, record::Reference::kLeastSquares, 30e-3, ""},
      {"RONt", record::Form::kRoundness, record::Reference::kLeastSquares, 30e-3, ""}};
  feature.strategy = record::Strategy::kStartPose;
  if (poses.size() > 1) {
    feature.strategy = record::Strategy::kMerged;
    record::MergedPosesSettings merged;
    merged.merge = record::Merge::kKinematics;
    merged.merged_poses = static_cast<int>(poses.size());
    merged.axis_point_mm = fixture.axis_point_mm;
    feature.settings = record::settings_of_task(merged);
  }
  run.features = {feature};
  for (std::size_t p = 0; p < poses.size(); ++p) {
    run.poses.push_back({static_cast<int>(p), 0, poses[p], poses[p], true, 0.0});
  }
  const FormCloud cloud = axle_cloud();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const FormPoint& point = cloud.points[i];
    record::Touch touch;
    touch.id = static_cast<std::int64_t>(i);
    touch.pose = poses.size() > 1 ? point.pose : 0;
    touch.layer = static_cast<int>(i) / kAxlePoints;
    touch.point = static_cast<int>(i) % kAxlePoints;
    touch.time_s = static_cast<double>(i);
    touch.temperature_degC = 20.0;
    const Vector3d normal(std::cos(point.angle_rad), std::sin(point.angle_rad), 0.0);
    const Eigen::Isometry3d frame = axle_frame(poses[static_cast<std::size_t>(touch.pose)]);
    touch.tip_mm = frame * Vector3d((kAxleRadius_mm + point.deviation_mm) * normal +
                                    point.height_mm * Vector3d::UnitZ());
    touch.approach = -(frame.linear() * normal);
    run.touches.push_back(touch);
  }
  return run;
}

FeatureResult axle_of(const record::RunRecord& run) {
  auto out = evaluate(run);
  EXPECT_TRUE(out) << out.error().what;
  if (!out || out->features.empty()) return {};
  EXPECT_FALSE(out->features[0].failure) << out->features[0].failure->what;
  return out->features[0];
}

UncertaintyResult interval_of(const FeatureResult& feature, std::size_t characteristic) {
  if (feature.characteristics.size() <= characteristic ||
      !feature.characteristics[characteristic].value) {
    ADD_FAILURE() << "no value";
    return {};
  }
  const UncertaintyStatus& status = feature.characteristics[characteristic].value->uncertainty();
  if (!status.result()) {
    ADD_FAILURE() << status.why().english();
    return {};
  }
  return *status.result();
}

TEST(CalibrationInfluence, OfARunInOnePoseLeavesItsValuesAndIntervalsAsTheyAre) {
  const FeatureResult nominal = axle_of(axle_run({{}}, std::nullopt));
  const FeatureResult calibrated = axle_of(axle_run({{}}, axle_calibration(20.0)));
  for (const std::size_t k : {0U, 1U}) {
    const UncertaintyResult without = interval_of(nominal, k);
    const UncertaintyResult with = interval_of(calibrated, k);
    EXPECT_EQ(*calibrated.characteristics.at(k).value_mm(),
              *nominal.characteristics.at(k).value_mm());
    EXPECT_EQ(with.sampled.estimate_mm, without.sampled.estimate_mm);
    EXPECT_EQ(with.sampled.low_mm, without.sampled.low_mm);
    EXPECT_EQ(with.sampled.high_mm, without.sampled.high_mm);
    EXPECT_EQ(budget_line(with, "calibration-stations").standard_uncertainty_mm, 0.0);
    EXPECT_TRUE(statement_named(with, "calibration-stations").covered);
  }
}

// By hand: beta stands at its station at 0 in both poses, and its error there is one draw in the
// frame of the hoop, thus of the body: it moves no form. Of alpha three quarters of the variances
// are one draw in the machine for both poses, one quarter belongs to the station of each.
TEST(CalibrationInfluence, OfARunInTwoPosesIsThatOfItsStationsAndOfWhatTheyShare) {
  const FeatureResult feature = axle_of(axle_run(leaning(), axle_calibration(20.0)));
  const UncertaintyResult result = interval_of(feature, 0);
  constexpr int kLoops = 4000;
  core::KeyedNoise noise(13, {1});
  double sum = 0.0;
  double squares = 0.0;
  for (int t = 0; t < kLoops; ++t) {
    const auto drawn = [&](double share) {
      Eigen::Matrix<double, 6, 1> out;
      for (Index k = 0; k < 6; ++k) {
        out[k] = std::sqrt(share) * (k < 3 ? 1e-3 : 5e-6) * noise.normal();
      }
      return out;
    };
    const auto both = drawn(0.75);
    const Eigen::Matrix<double, 6, 1> of_pose[2] = {both + drawn(0.25), both + drawn(0.25)};
    std::vector<Vector3d> points;
    for (const FormPoint& point : axle_cloud().points) {
      const double r = kAxleRadius_mm + point.deviation_mm;
      const Vector3d body(r * std::cos(point.angle_rad), r * std::sin(point.angle_rad),
                          point.height_mm);
      const double lean = (point.pose == 0 ? 75.0 : -75.0) * kDegree;
      const Eigen::Matrix3d turned = Eigen::AngleAxisd(lean, Vector3d::UnitX()).toRotationMatrix();
      const Vector3d at = turned * body;
      const auto& error = of_pose[point.pose];
      const Vector3d turn = error.tail<3>();
      points.emplace_back(turned.transpose() * (at + error.head<3>() + turn.cross(at)));
    }
    const double value = axle_peak_to_valley_mm(points);
    sum += value;
    squares += value * value;
  }
  const double brute_mm = std::sqrt(squares / kLoops - std::pow(sum / kLoops, 2));
  EXPECT_GT(brute_mm, 0.3e-3);
  // Standard deviations of 1000 and 4000 trials: 2.2 and 1.1 %.
  EXPECT_NEAR(budget_line(result, "calibration-stations").standard_uncertainty_mm, brute_mm,
              0.1 * brute_mm);
  const InfluenceStatement& said = statement_named(result, "calibration-stations");
  EXPECT_TRUE(said.covered);
  EXPECT_THAT(said.text.english(), HasSubstr("calibration run-7"));
  EXPECT_THAT(said.text.english(), HasSubstr("one draw for all 2 poses"));
  EXPECT_FALSE(statement_named(result, "calibration-age").covered);
  EXPECT_THAT(statement_named(result, "calibration-age").text.english(), HasSubstr("20.1 days"));
  EXPECT_TRUE(statement_named(result, "calibration-temperature").covered);
  EXPECT_EQ(budget_line(result, "calibration-temperature").standard_uncertainty_mm, 0.0)
      << "calibrated at the temperature of use";
  EXPECT_NE(interval_of(feature, 1).sampled.high_mm, 0.0) << "RONt has an interval, too";
}

TEST(CalibrationInfluence, AtAnotherTemperatureTheAxesMayHaveMoved) {
  const FeatureResult feature = axle_of(axle_run(leaning(), axle_calibration(20.5)));
  const UncertaintyResult result = interval_of(feature, 0);
  // 12e-6 x 250 mm x 0.5 K = 1.5 um each way, of which y acts between the poses.
  EXPECT_GT(budget_line(result, "calibration-temperature").standard_uncertainty_mm, 0.3e-3);
  EXPECT_LT(budget_line(result, "calibration-temperature").standard_uncertainty_mm,
            2.0 * 1.5e-3 / std::sqrt(3.0));
  EXPECT_THAT(statement_named(result, "calibration-temperature").text.english(),
              HasSubstr("by -0.50 K"));
}

TEST(CalibrationInfluence, WithoutACalibrationMergedPosesNeedADeclaredUncertainty) {
  record::RunRecord run = axle_run(leaning(), std::nullopt);
  const FeatureResult bare = axle_of(run);
  ASSERT_TRUE(bare.characteristics.at(0).value);
  EXPECT_FALSE(bare.characteristics[0].value->uncertainty().result());
  EXPECT_THAT(bare.characteristics[0].value->uncertainty().why().english(),
              HasSubstr("nothing is known of their errors"));
  run.settings.push_back({"uncertainty/declared", std::nullopt, "fixture"});
  run.settings.push_back({"uncertainty/fixture/position_um", 1.0, ""});
  const UncertaintyResult declared = interval_of(axle_of(run), 0);
  EXPECT_GT(budget_line(declared, "fixture-calibration").standard_uncertainty_mm, 0.3e-3);
}

}  // namespace
}  // namespace rondure::evaluation
