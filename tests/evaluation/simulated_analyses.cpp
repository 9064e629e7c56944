#include "tests/evaluation/simulated_analyses.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/decompositions.h"
#include "core/noise.h"
#include "core/units.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "record/tasks/uncertainty.h"

namespace rondure::reports {
namespace {

using core::kDegree;
using core::kMicrometre;
using core::kTwoPi;
using Eigen::Vector3d;
using record::SpindleTask;

double range_of(const std::vector<double>& values) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return *greatest - *least;
}

/// Transfer of the Gaussian low pass of 50 UPR.
double kept_1(double order) { return std::exp2(-std::pow(order / 50.0, 2)); }

record::Series series(std::string name, const std::vector<std::string>& columns,
                      std::vector<double> values) {
  record::Series out;
  out.name = std::move(name);
  for (const std::string& column : columns) {
    const std::size_t unit = column.rfind('_');  // a column without a unit is a coordinate
    out.columns.push_back({column, unit == std::string::npos ? "mm" : column.substr(unit + 1)});
  }
  out.values = std::move(values);
  return out;
}

record::RunRecord run_of(record::Shape shape, std::vector<record::Setting> settings,
                         std::vector<record::Series> data) {
  record::RunRecord out;
  out.header.run_id = "simulated by formulas";
  out.header.started_utc = "2026-11-22T10:00:00Z";
  out.ending = "finished";
  record::UncertaintyTask trials;  // as few as a plan may have
  trials.least_trials = 2000;
  trials.most_trials = 2000;
  trials.budget_trials = 0;
  out.settings = record::settings_of_uncertainty(trials, std::nullopt);
  record::Feature& feature = out.features.emplace_back();
  feature.id = "measured";
  feature.shape = shape;
  feature.strategy = record::Strategy::kSeries;
  feature.settings = std::move(settings);
  out.series = std::move(data);
  return out;
}

}  // namespace

double Normals::uniform() {
  return static_cast<double>(core::splitmix64(state_) >> 11U) * 0x1.0p-53;
}
double Normals::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(kTwoPi * uniform());
}
double Normals::phase_rad() { return kTwoPi * uniform(); }

double sum_um(const std::vector<Wave>& waves, double angle_rad) {
  double sum = 0.0;
  for (const Wave& wave : waves) {
    sum += wave.amplitude_um * std::cos(wave.order * angle_rad - wave.phase_rad);
  }
  return sum;
}

record::Influence declared(double standard_uncertainty) {
  record::DeclaredInfluence out;
  out.value = standard_uncertainty;
  return out;
}

record::Characteristic asked(record::Form form, std::optional<double> tolerance_um) {
  record::Characteristic out;
  out.id = std::string(name_of(form));
  out.form = form;
  out.reference = record::Reference::kLeastSquares;
  if (tolerance_um) out.tolerance_mm = *tolerance_um * kMicrometre;
  return out;
}

// ---- Three probes -------------------------------------------------------------------------------

std::array<double, 3> stated_places_deg(SpindleTask::Layout layout) {
  if (layout == SpindleTask::Layout::kPublishedA) return {0.0, 90.0, 271.0546875};
  return {0.0, 52.3828125, 301.2890625};  // the reference layout
}

double SimulatedSpindle::beta_rad(double alpha_rad) const {
  return std::asin(crank_mm * std::sin(alpha_rad) / (wheel_mm + pin_mm));
}

double SimulatedSpindle::reading_um(std::size_t probe, double alpha_rad) const {
  const double beta = beta_rad(alpha_rad);
  const double on_part = alpha_rad + beta + places_rad[probe];
  const double direction = beta + places_rad[probe];
  const double r =
      sum_um(profile, on_part) + eccentricity_um * std::cos(on_part - eccentricity_rad);
  const double x = sum_um(motion_x, alpha_rad) + sum_um(asynchronous_x, alpha_rad);
  const double y = sum_um(motion_y, alpha_rad) + sum_um(asynchronous_y, alpha_rad);
  return gains_1[probe] * (r + y * std::cos(direction) + x * std::sin(direction)) + zeros_um[probe];
}

SimulatedSpindle worked_spindle(SpindleTask::Layout layout) {
  SimulatedSpindle out;
  const auto stated = stated_places_deg(layout);
  for (std::size_t i = 0; i < 3; ++i) out.places_rad[i] = stated[i] * kDegree;
  out.profile = {{2, 3.0, 20 * kDegree},  {3, 2.0, -45 * kDegree}, {5, 0.8, 100 * kDegree},
                 {7, 0.6, -10 * kDegree}, {11, 0.4, 75 * kDegree}, {16, 0.5, 0.0},
                 {23, 0.3, 33 * kDegree}, {40, 0.2, -60 * kDegree}};
  constexpr double kQuarter = 0.25 * kTwoPi;  // turns a cosine into a sine
  out.motion_x = {{2, 0.7, -1.0}, {5, 0.4, 0.5}, {9, 0.3, kQuarter}};
  out.motion_y = {{3, 0.9, 0.0}, {4, 0.5, kQuarter - 0.7}, {13, 0.25, 0.0}};
  out.eccentricity_rad = 35 * kDegree;
  return out;
}

SpindleTask spindle_task(SpindleTask::Layout layout, const SimulatedSpindle& world) {
  SpindleTask out;
  out.layout = layout;
  out.crank_radius_mm = world.crank_mm;
  out.wheel_radius_mm = world.wheel_mm;
  out.pin_radius_mm = world.pin_mm;
  out.samples = 512;
  out.second_order = SpindleTask::SecondOrder::kOff;  // the readings have none
  return out;
}

record::RunRecord spindle_run(const SimulatedSpindle& world, const SpindleTask& task,
                              Normals& draws) {
  const auto samples = static_cast<std::size_t>(world.samples_per_turn);
  std::vector<double> values;
  for (int turn = 0; turn < world.turns; ++turn) {
    std::vector<std::array<double, 4>> rows(samples);
    for (std::size_t probe = 0; probe < 3; ++probe) {
      for (std::size_t m = 0; m < samples; ++m) {
        const double turned = turn + static_cast<double>(m) / static_cast<double>(samples);
        rows[m][0] = 360.0 * turned;
        rows[m][1 + probe] =
            world.reading_um(probe, kTwoPi * turned) + world.noise_um * draws.normal();
      }
    }
    for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
  }
  return run_of(record::Shape::kSpindle, record::settings_of_task(task),
                {series("data", {"alpha_deg", "H1_um", "H2_um", "H3_um"}, std::move(values))});
}

double true_roundness_um(const SimulatedSpindle& world) {
  std::vector<Wave> filtered = world.profile;
  for (Wave& wave : filtered) wave.amplitude_um *= kept_1(wave.order);
  std::vector<double> values(4096);
  for (std::size_t n = 0; n < values.size(); ++n) {
    values[n] = sum_um(filtered, kTwoPi * static_cast<double>(n) / 4096.0);
  }
  return range_of(values);
}

double true_roundness_rms_um(const SimulatedSpindle& world) {
  double squares = 0.0;
  for (const Wave& wave : world.profile) {
    squares += 0.5 * std::pow(wave.amplitude_um * kept_1(wave.order), 2);
  }
  return std::sqrt(squares);
}

double true_synchronous_um(const SimulatedSpindle& world) {
  constexpr int kSamples = 1024;
  // RY - j RX, and the complex numbers that are fitted to it, as real and imaginary parts.
  Eigen::VectorXd motion(2 * kSamples);
  Eigen::MatrixXd removed(2 * kSamples, 4);
  Eigen::MatrixXd center(kSamples, 3);
  for (int m = 0; m < kSamples; ++m) {
    const double alpha = kTwoPi * m / kSamples;
    const double beta = world.beta_rad(alpha);
    motion(m) = sum_um(world.motion_y, alpha);
    motion(m + kSamples) = -sum_um(world.motion_x, alpha);
    // e^{j alpha}: eccentricity; e^{-j beta}: zeros of the probes.
    removed.row(m) << std::cos(alpha), -std::sin(alpha), std::cos(beta), std::sin(beta);
    removed.row(m + kSamples) << std::sin(alpha), std::cos(alpha), -std::sin(beta), std::cos(beta);
    center.row(m) << 1.0, std::cos(alpha), std::sin(alpha);
  }
  motion -= removed * core::solve_pivoted_qr(removed, motion);
  double out = 0.0;
  for (const Eigen::VectorXd& direction :
       {Eigen::VectorXd(motion.head(kSamples)), Eigen::VectorXd(motion.tail(kSamples))}) {
    const Eigen::VectorXd circle = core::solve_pivoted_qr(center, direction);
    const Eigen::VectorXd left = direction - center * circle;
    out = std::max(out, left.maxCoeff() - left.minCoeff());
  }
  return out;
}

double true_asynchronous_um(const SimulatedSpindle& world) {
  double out = 0.0;
  for (const auto* waves : {&world.asynchronous_x, &world.asynchronous_y}) {
    for (int m = 0; m < 512; ++m) {
      std::vector<double> at_one_angle;
      for (int turn = 0; turn < world.turns; ++turn) {
        at_one_angle.push_back(sum_um(*waves, kTwoPi * (turn + m / 512.0)));
      }
      out = std::max(out, range_of(at_one_angle));
    }
  }
  return out;
}

// ---- Wheel --------------------------------------------------------------------------------------

namespace {

/// The point of the edge at a place, so much farther out.
Eigen::Vector2d edge_mm(const SimulatedWheel& world, double place_rad, double outward_um) {
  const auto direction = [](double angle) {
    return Eigen::Vector2d(std::cos(angle), std::sin(angle));
  };
  const Eigen::Vector2d center =
      world.axis_mm + world.eccentricity_um * kMicrometre * direction(world.eccentricity_rad);
  const double r = world.radius_mm + kMicrometre * (sum_um(world.lobes, place_rad) + outward_um);
  return center + r * direction(place_rad);
}

}  // namespace

SimulatedWheel worked_wheel(std::vector<double> places_rad) {
  SimulatedWheel out;
  out.eccentricity_rad = 215 * kDegree;
  out.lobes = {{2, 1.2, 40 * kDegree}, {3, 0.8, -75 * kDegree}};
  out.places_rad = std::move(places_rad);
  return out;
}

std::vector<double> whole_turn() {
  std::vector<double> out;
  for (int i = 0; i < 16; ++i) out.push_back(kTwoPi * i / 16.0);
  return out;
}

std::vector<double> short_arc() {
  std::vector<double> out;
  for (int i = 0; i < 8; ++i) out.push_back((240.0 + 60.0 * i / 7.0) * kDegree);
  return out;
}

record::RunRecord wheel_run(const SimulatedWheel& world, record::WheelTask task, Normals& draws) {
  std::vector<double> values;
  for (std::size_t i = 0; i < world.places_rad.size(); ++i) {
    const double proud_um = world.proud_point == i ? world.proud_um : 0.0;
    const Eigen::Vector2d p =
        edge_mm(world, world.places_rad[i], proud_um + world.point_um * draws.normal());
    values.insert(values.end(), {p.x(), p.y()});
  }
  const double x = draws.normal();
  const double z = draws.normal();
  task.axis_x_mm = world.axis_mm.x() + world.axis_um * kMicrometre * x;
  task.axis_z_mm = world.axis_mm.y() + world.axis_um * kMicrometre * z;
  task.nominal_radius_mm = kNominalRadius_mm;
  return run_of(record::Shape::kWheel, record::settings_of_task(task),
                {series("data", {"x", "z"}, std::move(values))});
}

double true_run_out_um(const SimulatedWheel& world) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < world.places_rad.size(); ++i) {
    const double proud_um = world.proud_point == i ? world.proud_um : 0.0;
    distances.push_back((edge_mm(world, world.places_rad[i], proud_um) - world.axis_mm).norm());
  }
  return range_of(distances) / kMicrometre;
}

double true_wheel_roundness_um(const SimulatedWheel& world) {
  std::vector<double> lobes;
  for (const double place : world.places_rad) lobes.push_back(sum_um(world.lobes, place));
  return range_of(lobes);
}

// ---- Contour ------------------------------------------------------------------------------------

namespace {

constexpr std::size_t kContourPoints = 1440;

/// A contour after the base circle and the low pass.
std::vector<double> filtered_um(const std::vector<double>& contour) {
  const std::size_t points = contour.size();
  const auto size = static_cast<double>(points);
  std::vector<double> cosine(points);
  std::vector<double> sine(points);
  for (std::size_t m = 0; m < points; ++m) {
    cosine[m] = std::cos(kTwoPi * static_cast<double>(m) / size);
    sine[m] = std::sin(kTwoPi * static_cast<double>(m) / size);
  }
  std::vector<double> out(points, 0.0);
  for (std::size_t order = 2; order <= 100; ++order) {  // above, the contours hold nothing
    double c = 0.0;
    double s = 0.0;
    for (std::size_t m = 0; m < points; ++m) {
      c += contour[m] * cosine[order * m % points];
      s += contour[m] * sine[order * m % points];
    }
    const double scale = 2.0 / size * kept_1(static_cast<double>(order));
    for (std::size_t m = 0; m < points; ++m) {
      out[m] += scale * (c * cosine[order * m % points] + s * sine[order * m % points]);
    }
  }
  return out;
}

record::Series trace_of(const SimulatedContour& world, std::size_t part, Normals& draws) {
  constexpr int kPerTurn = 300;
  const double length = world.wheel_mm + world.pin_mm;
  std::vector<double> values;
  for (int i = 0; i <= 5 * kPerTurn / 2; ++i) {
    const double alpha = kTwoPi * i / kPerTurn;
    const double c_deg = 1e-6 * world.c_scale[part] * sum_um(world.c_error, alpha) / kDegree +
                         1e-3 * world.c_trace_mdeg * draws.normal();
    const double x_um = sum_um(world.x_error, alpha) + world.x_trace_um * draws.normal();
    const double distance =
        world.crank_mm * std::cos(alpha) +
        std::sqrt(length * length - std::pow(world.crank_mm * std::sin(alpha), 2));
    values.insert(values.end(),
                  {360.0 * (i % kPerTurn) / kPerTurn, c_deg, x_um * kMicrometre, distance});
  }
  return series(fmt::format("axes {}", part + 1),
                {"c_deg", "c_error_deg", "x_error_mm", "d_cmd_mm"}, std::move(values));
}

record::Series gauge_of(const SimulatedContour& world, std::size_t part, Normals& draws) {
  // The pin is never on the centre of the gauge, and its size is not what the gauge measures.
  constexpr double kSize_um = 3.0;
  const Wave off_center = {1, 4.0, draws.phase_rad()};
  std::vector<double> values;
  for (std::size_t m = 0; m < kContourPoints; ++m) {
    const double beta = kTwoPi * static_cast<double>(m) / kContourPoints;
    const double pin = world.contour_um(part, beta + world.phase_rad);
    values.push_back(beta / kDegree);
    values.push_back(world.gain_1 * (kSize_um + sum_um({off_center}, beta) + pin) +
                     sum_um(world.gauge_form, beta) + world.gauge_um * draws.normal());
  }
  return series(fmt::format("pin {}", part + 1), {"angle_deg", "deviation_um"}, std::move(values));
}

}  // namespace

double SimulatedContour::contour_um(std::size_t part, double beta_rad) const {
  const double length = wheel_mm + pin_mm;
  const double alpha =
      std::atan2(length * std::sin(beta_rad), crank_mm + length * std::cos(beta_rad));
  const double eta =
      std::atan2(crank_mm * std::sin(beta_rad), length + crank_mm * std::cos(beta_rad));
  const double x_um = sum_um(x_error, alpha) + sum_um(x_unseen, alpha);
  const double c_urad = c_scale[part] * sum_um(c_error, alpha) + sum_um(c_unseen, alpha);
  return std::cos(eta) * x_um + crank_mm * std::sin(beta_rad) * 1e-3 * c_urad +
         sum_um(own[part], beta_rad);
}

record::RunRecord contour_run(const SimulatedContour& world, const record::ContourTask& task,
                              Normals& draws) {
  std::vector<record::Series> data;
  for (std::size_t part = 0; part < world.own.size(); ++part) {
    data.push_back(trace_of(world, part, draws));
    data.push_back(gauge_of(world, part, draws));
  }
  return run_of(record::Shape::kContour, record::settings_of_task(task), std::move(data));
}

ContourTruth true_contour(const SimulatedContour& world) {
  const std::size_t parts = world.own.size();
  std::vector<std::vector<double>> contours;
  ContourTruth out;
  for (std::size_t part = 0; part < parts; ++part) {
    std::vector<double> raw(kContourPoints);
    for (std::size_t m = 0; m < kContourPoints; ++m) {
      raw[m] = world.contour_um(part, kTwoPi * static_cast<double>(m) / kContourPoints);
    }
    contours.push_back(filtered_um(raw));
    out.deviation_um = std::max(out.deviation_um, range_of(contours.back()));
  }
  double squares = 0.0;
  for (std::size_t m = 0; m < kContourPoints; ++m) {
    double mean = 0.0;
    for (const auto& contour : contours) mean += contour[m] / static_cast<double>(parts);
    for (const auto& contour : contours) squares += std::pow(contour[m] - mean, 2);
  }
  out.spread_um = std::sqrt(squares / static_cast<double>((parts - 1) * kContourPoints));
  return out;
}

// ---- Fixture ------------------------------------------------------------------------------------

namespace {

constexpr double kBallRadius_mm = 5.0;
constexpr double kTipRadius_mm = 2.0;
constexpr double kSphereRadius_mm = 12.5006;

/// `count` points about the upper part of a sphere, the pole among them.
std::vector<Vector3d> touched_sphere(const Vector3d& center_mm, double radius_mm, int count,
                                     Normals& draws) {
  constexpr double kNoise_um = 0.3;
  std::vector<Vector3d> out;
  for (int i = 0; i < count; ++i) {
    const double up = 1.0 - static_cast<double>(i) / count;  // 1 at the pole, above the equator
    const double turn = 2.4 * i;
    const double across = std::sqrt(1.0 - up * up);
    const Vector3d normal(across * std::cos(turn), across * std::sin(turn), up);
    out.emplace_back(center_mm + (radius_mm + kNoise_um * kMicrometre * draws.normal()) * normal);
  }
  return out;
}

void add_touches(record::RunRecord& run, const record::Touch& like,
                 const std::vector<Vector3d>& tips) {
  for (std::size_t i = 0; i < tips.size(); ++i) {
    record::Touch touch = like;
    touch.id = static_cast<std::int64_t>(run.touches.size());
    touch.point = static_cast<int>(i);
    touch.tip_mm = tips[i];
    run.touches.push_back(touch);
  }
}

/// Zero poses at begin, middle and end, both axes alone, then together.
std::vector<core::Pose> calibration_poses() {
  std::vector<core::Pose> out = {{0.0, 0.0}};
  const std::vector<double> stations_deg = {-60, -45, -30, -15, 15, 30, 45, 60};
  for (const double deg : stations_deg) out.push_back({deg * kDegree, 0.0});
  out.push_back({0.0, 0.0});
  for (const double deg : stations_deg) out.push_back({0.0, deg * kDegree});
  out.push_back({0.0, 0.0});
  for (const auto& [alpha, beta] : std::vector<std::pair<double, double>>{
           {30, -45}, {-45, 30}, {50, 50}, {-50, -30}, {20, 55}, {-25, -55}}) {
    out.push_back({alpha * kDegree, beta * kDegree});
  }
  return out;
}

record::RotaryTask ball_plate() {
  record::RotaryTask out;
  out.balls = {{"B1", {-70, 35, 20}},
               {"B2", {-35, -70, 60}},
               {"B3", {0, 0, 90}},
               {"B4", {35, 70, 40}},
               {"B5", {70, -35, 70}}};
  out.ball_diameter_mm = 2.0 * kBallRadius_mm;
  for (const core::Pose& pose : calibration_poses()) {
    const double alpha_deg = pose.alpha_rad / kDegree;
    const double beta_deg = pose.beta_rad / kDegree;
    if (pose.alpha_rad != 0.0 && pose.beta_rad != 0.0) {
      out.verification.push_back({alpha_deg, beta_deg});
    } else if (pose.alpha_rad != 0.0) {
      out.alpha_stations_deg.push_back(alpha_deg);
    } else if (pose.beta_rad != 0.0) {
      out.beta_stations_deg.push_back(beta_deg);
    }
  }
  return out;
}

}  // namespace

record::RunRecord ball_plate_run(double temperature_degC, Normals& draws) {
  record::FixtureSettings fixture;
  fixture.id = "F-01";
  fixture.axis_point_mm = {0, 0, 150};
  fixture.axis_offset_mm = {0.4, -0.3, 12};
  fixture.min_alpha_deg = fixture.min_beta_deg = -60;
  fixture.max_alpha_deg = fixture.max_beta_deg = 60;
  const record::RotaryTask plate = ball_plate();

  record::RunRecord out = run_of(record::Shape::kRotaryAxes, record::settings_of_task(plate), {});
  out.features[0].strategy = record::Strategy::kStations;
  for (record::Setting& setting : record::settings_of_task(fixture, "fixture/")) {
    out.settings.push_back(std::move(setting));
  }
  out.settings.push_back({"environment/declared", std::nullopt, "18..22 degC"});
  out.header.temperature_min_degC = 18.0;
  out.header.temperature_max_degC = 22.0;
  out.artefact = {kSphereRadius_mm, kTipRadius_mm, 0.1, 0.01};

  record::Touch touch;
  touch.purpose = record::Touch::Purpose::kQualification;
  add_touches(out, touch,
              touched_sphere({300, 0, 100}, kSphereRadius_mm + kTipRadius_mm, 25, draws));
  touch.purpose = record::Touch::Purpose::kMeasure;
  touch.temperature_degC = temperature_degC;
  for (const core::Pose& pose : calibration_poses()) {
    touch.pose = static_cast<int>(out.poses.size());
    out.poses.push_back({touch.pose, 0, pose, pose, false, 0.0});
    const Eigen::AngleAxisd about_x(pose.alpha_rad, Vector3d::UnitX());
    const Eigen::AngleAxisd about_y(pose.beta_rad, Vector3d::UnitY());
    for (std::size_t ball = 0; ball < plate.balls.size(); ++ball) {
      const Vector3d in_body = Vector3d::Map(plate.balls[ball].center_mm.data());
      const Vector3d in_machine =
          Vector3d::Map(fixture.axis_point_mm.data()) +
          about_x * (Vector3d::Map(fixture.axis_offset_mm.data()) + about_y * in_body);
      touch.layer = static_cast<int>(ball);
      add_touches(out, touch,
                  touched_sphere(in_machine, kBallRadius_mm + kTipRadius_mm, plate.points, draws));
    }
  }
  return out;
}

}  // namespace rondure::reports
