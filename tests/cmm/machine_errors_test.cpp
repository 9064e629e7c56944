// Every error of the simulated machine, one at a time, against its closed form.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include "cmm/simulated/internal/machine_map.h"
#include "cmm/simulated/machine.h"
#include "core/noise.h"
#include "core/units.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

constexpr double kRadius_mm = 25.0;
constexpr double kTip_mm = 2.0;
constexpr double kClose_mm = 1e-9;
const Vector3d kCenter_mm(120.0, -80.0, 60.0);  // of the shaft, off the machine origin

/// A shaft along z at kCenter_mm and the machine that touches it.
class Cell {
 public:
  explicit Cell(const SimulatedMachineOptions& options, const PartSurface& part = shaft())
      : machine_(options) {
    Eigen::Isometry3d X_WP = Eigen::Isometry3d::Identity();
    X_WP.translation() = kCenter_mm;
    machine_.place_part(part, X_WP);
    EXPECT_TRUE(machine_.home());
  }

  static PartSurface shaft() { return {kRadius_mm, 40.0, false, {}, {}}; }

  /// Touches at an angle and height of the part.
  TouchReading touch(double theta_rad, double z_mm, std::int64_t id = 0) {
    const Vector3d out(std::cos(theta_rad), std::sin(theta_rad), 0.0);
    const Vector3d expected = kCenter_mm + (kRadius_mm + kTip_mm) * out + z_mm * Vector3d::UnitZ();
    const Vector3d start = expected + 3.0 * out;
    const Vector3d above(start.x(), start.y(), 300.0);
    EXPECT_TRUE(
        machine_.move_to({machine_.position_W_mm().x(), machine_.position_W_mm().y(), 300}));
    EXPECT_TRUE(machine_.move_to(above));
    EXPECT_TRUE(machine_.move_to(start));
    const auto reading = machine_.touch({id, expected, -out, 3.0, 3.0});
    EXPECT_TRUE(reading) << reading.error().what;
    return reading.value_or(TouchReading{});
  }

  SimulatedMachine& machine() { return machine_; }

 private:
  SimulatedMachine machine_;
};

double from_axis(const Vector3d& tip_W_mm) { return (tip_W_mm - kCenter_mm).head<2>().norm(); }

/// One of the 21, and where it puts the tip beside the scales: q positions of the axes, t the tip
/// offset. Written down from the picture of the machine, not from the code.
struct Case {
  std::string name;
  std::function<void(GeometricErrors&)> set;
  std::function<Vector3d(const Vector3d& q, const Vector3d& t)> shift_mm;
};

constexpr double kSlope = 2e-5;  // mm/mm
constexpr double kAngle = 2e-7;  // rad/mm

double bent(double p) { return kSlope * p + 1e-8 * p * p + 1e-3 * std::sin(0.05 * p + 0.4); }
double tilted(double p) { return kAngle * p + 3e-6 * std::sin(0.05 * p + 0.4); }

const ErrorCurve kBent = {kSlope, 1e-8, 1e-3, core::kTwoPi / 0.05, 0.4};
const ErrorCurve kTilted = {kAngle, 0.0, 3e-6, core::kTwoPi / 0.05, 0.4};

/// The lever from where an axis turns to the tip: the carriage of y carries x, that of x carries z.
Vector3d lever(int axis, const Vector3d& q, const Vector3d& t) {
  if (axis == 2) return t;
  if (axis == 0) return {t.x(), t.y(), t.z() + q.z()};
  return {t.x() + q.x(), t.y(), t.z() + q.z()};
}

std::vector<Case> all_21() {
  std::vector<Case> cases;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<std::size_t>(axis);
      const auto c = static_cast<std::size_t>(k);
      cases.push_back({std::string("E") + "XYZ"[k] + "XYZ"[axis],
                       [=](GeometricErrors& e) { e.axes[a].translation[c] = kBent; },
                       [=](const Vector3d& q, const Vector3d&) -> Vector3d {
                         return bent(q[axis]) * Vector3d::Unit(k);
                       }});
      cases.push_back({std::string("E") + "ABC"[k] + "XYZ"[axis],
                       [=](GeometricErrors& e) { e.axes[a].rotation[c] = kTilted; },
                       [=](const Vector3d& q, const Vector3d& t) -> Vector3d {
                         const Vector3d l = lever(axis, q, t);
                         const double w = tilted(q[axis]);
                         if (k == 0) return {0.0, -w * l.z(), w * l.y()};
                         if (k == 1) return {w * l.z(), 0.0, -w * l.x()};
                         return {-w * l.y(), w * l.x(), 0.0};
                       }});
    }
  }
  const double s = 3e-5;
  cases.push_back({"squareness xy", [=](GeometricErrors& e) { e.squareness_xy_rad = s; },
                   [=](const Vector3d& q, const Vector3d&) { return Vector3d(-s * q.y(), 0, 0); }});
  cases.push_back({"squareness xz", [=](GeometricErrors& e) { e.squareness_xz_rad = s; },
                   [=](const Vector3d& q, const Vector3d&) { return Vector3d(-s * q.z(), 0, 0); }});
  cases.push_back({"squareness yz", [=](GeometricErrors& e) { e.squareness_yz_rad = s; },
                   [=](const Vector3d& q, const Vector3d&) { return Vector3d(0, -s * q.z(), 0); }});
  return cases;
}

TEST(MachineErrors, EachOfThe21PutsTheTipWhereItsClosedFormSays) {
  const Vector3d t(12.0, -7.0, -140.0);
  const auto cases = all_21();
  ASSERT_EQ(cases.size(), 21U);
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    SimulatedMachineOptions options;
    options.errors.geometry.tip_offset_mm = t;
    c.set(options.errors.geometry);
    Cell cell(options);
    double largest = 0.0;
    for (const double z : {-25.0, 0.0, 30.0}) {
      for (int k = 0; k < 8; ++k) {
        const Vector3d reading = cell.touch(k * core::kTwoPi / 8.0, z).tip_W_mm;
        const Vector3d shift = c.shift_mm(reading - t, t);
        // The true tip touches the cylinder; the scales say something else.
        EXPECT_NEAR(from_axis(reading + shift), kRadius_mm + kTip_mm, kClose_mm);
        largest = std::max(largest, std::abs(from_axis(reading) - kRadius_mm - kTip_mm));
      }
    }
    // Position and rotations that act along z leave a vertical cylinder alone; the others show.
    const bool along_axis = c.name[1] == 'Z';
    EXPECT_EQ(largest < 1e-8, along_axis) << largest;
  }
}

TEST(MachineErrors, SquarenessMakesAnEllipseAndAScaleErrorToo) {
  // Over one turn the form is half of what the error is over the diameter: R s for an angle s
  // between x and y, R k for a scale that is longer by k.
  for (const bool scale : {false, true}) {
    SCOPED_TRACE(scale);
    SimulatedMachineOptions options;
    if (scale) {
      options.errors.geometry.axes[0].translation[0].linear_1_mm = 1e-6;
    } else {
      options.errors.geometry.squareness_xy_rad = 1e-6;
    }
    Cell cell(options);
    std::vector<Vector3d> tips;
    for (int k = 0; k < 8; ++k) tips.push_back(cell.touch(k * core::kTwoPi / 8.0, 0.0).tip_W_mm);
    // The lines of approach miss the shifted centre, so the tips do not lie evenly about it and
    // their mean is not the centre: a circle is fitted, 2 c x + t = x^2.
    Eigen::Matrix<double, 8, 3> rows;
    Eigen::Matrix<double, 8, 1> squares;
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector2d flat = (tips[static_cast<std::size_t>(k)] - kCenter_mm).head<2>();
      rows.row(k) << 2.0 * flat.x(), 2.0 * flat.y(), 1.0;
      squares(k) = flat.squaredNorm();
    }
    const Eigen::Vector2d center = rows.colPivHouseholderQr().solve(squares).head<2>();
    double least = 1e9;
    double most = 0.0;
    for (const Vector3d& tip : tips) {
      const double radius_mm = ((tip - kCenter_mm).head<2>() - center).norm();
      least = std::min(least, radius_mm);
      most = std::max(most, radius_mm);
    }
    EXPECT_NEAR(most - least, (kRadius_mm + kTip_mm) * 1e-6, 2e-10);
  }
}

TEST(MachineErrors, ReadingIsTheInverseOfTheTruePosition) {
  core::KeyedNoise random(1, {1});
  const MachineErrors errors = typical_errors();
  for (int i = 0; i < 1000; ++i) {
    const Vector3d reading(800 * random.uniform(), 800 * random.uniform(), 600 * random.uniform());
    const double time_s = 5000.0 * random.uniform();
    const Vector3d there = true_position(errors, reading, time_s);
    EXPECT_LT((reading_of(errors, there, time_s) - reading).norm(), 1e-12);
    EXPECT_GT((there - reading).norm(), 1e-5);
    EXPECT_LT((there - reading).norm(), 0.03) << "typical: some micrometres";
  }
}

TEST(MachineErrors, PretravelShrinksTheReadingsByItsHarmonics) {
  SimulatedMachineOptions options;
  options.errors.pretravel_mm = 0.004;
  options.errors.pretravel_lobes = {{3, 0.001, 0.5}, {5, 0.0003, 1.0}};
  Cell cell(options);
  for (int k = 0; k < 12; ++k) {
    const double theta = k * core::kTwoPi / 12.0;
    const double approach = theta + M_PI;  // the tip moves inward
    const double delay =
        0.004 + 0.001 * std::cos(3 * approach + 0.5) + 0.0003 * std::cos(5 * approach + 1.0);
    EXPECT_NEAR(from_axis(cell.touch(theta, 5.0).tip_W_mm), kRadius_mm + kTip_mm - delay,
                kClose_mm);
  }
}

TEST(MachineErrors, PretravelAlongTheStylusShowsFromAboveOnly) {
  MachineErrors errors;
  errors.pretravel_mm = 0.004;
  errors.pretravel_z_mm = 0.001;
  EXPECT_DOUBLE_EQ(trigger_delay_mm(errors, -Vector3d::UnitZ()), 0.001);
  EXPECT_DOUBLE_EQ(trigger_delay_mm(errors, Vector3d::UnitX()), 0.004);
  EXPECT_DOUBLE_EQ(trigger_delay_mm(errors, Vector3d(0.6, 0.0, -0.8)), 0.6 * 0.004 + 0.8 * 0.001);
}

TEST(MachineErrors, StylusBendsWithTheCubeOfItsLength) {
  // F L^3 / (3 E I), I = pi D^4 / 64: 0.1 N, 50 mm, 2 mm of steel bend by 25.3 um.
  StylusShaft steel = {50.0, 2.0, 210e3, 0.1};
  const double inertia_mm4 = M_PI * 16.0 / 64.0;
  EXPECT_NEAR(steel.deflection_mm(), 0.1 * 125000.0 / (3.0 * 210e3 * inertia_mm4), 1e-15);
  EXPECT_NEAR(steel.deflection_mm(), 0.02526, 1e-5);
  SimulatedMachineOptions options;
  options.errors.stylus = steel;
  EXPECT_NEAR(from_axis(Cell(options).touch(1.0, 0.0).tip_W_mm),
              kRadius_mm + kTip_mm - steel.deflection_mm(), kClose_mm);
  options.errors.stylus.length_mm = 100.0;
  EXPECT_NEAR(from_axis(Cell(options).touch(1.0, 0.0).tip_W_mm),
              kRadius_mm + kTip_mm - 8.0 * steel.deflection_mm(), kClose_mm);
}

TEST(MachineErrors, ScalesAndPartExpandWithTheirTemperatures) {
  SimulatedMachineOptions options;
  options.temperature_degC = 23.0;
  options.part_errors.expansion_1_K = 12e-6;
  Cell warm(options);
  const double part = 1.0 + 12e-6 * 3.0;
  EXPECT_NEAR(from_axis(warm.touch(0.7, 10.0).tip_W_mm), kRadius_mm * part + kTip_mm, kClose_mm);
  EXPECT_NEAR((warm.machine().true_tip_W_mm() - kCenter_mm).head<2>().norm(), kRadius_mm + kTip_mm,
              kClose_mm)
      << "the truth is that of 20 degC";
  options.part_errors.expansion_1_K = 0.0;
  options.errors.scale_expansion_1_K = 8e-6;
  options.errors.scale_temperature_degC = 22.0;
  Cell scales(options);
  const TouchReading reading = scales.touch(0.7, 10.0);
  EXPECT_NEAR(from_axis(reading.tip_W_mm * (1.0 + 8e-6 * 2.0)), kRadius_mm + kTip_mm, kClose_mm);
  EXPECT_EQ(reading.scale_temperature_degC, 22.0);
  EXPECT_EQ(reading.temperature_degC, 23.0);
}

TEST(MachineErrors, OriginDriftsTowardItsEnd) {
  SimulatedMachineOptions options;
  options.errors.drift_mm = {0.004, 0.0, 0.0};
  options.errors.drift_time_s = 50.0;
  Cell cell(options);
  for (int i = 0; i < 20; ++i) {
    const TouchReading reading = cell.touch(0.0, 0.0);
    const double begun_s = reading.time_s - (3.0 - (reading.tip_W_mm.x() - 147.0)) / 5.0;
    const double drift = 0.004 * (1.0 - std::exp(-begun_s / 50.0));
    EXPECT_NEAR(reading.tip_W_mm.x(), kCenter_mm.x() + 27.0 + drift, kClose_mm);
  }
  EXPECT_GT(cell.machine().time_s(), 100.0) << "most of it was seen";
}

TEST(MachineErrors, HysteresisDependsOnTheSideOfTheApproach) {
  SimulatedMachineOptions options;
  options.errors.backlash_mm = {0.002, 0.0, 0.0};
  Cell cell(options);
  const double plus = cell.touch(0.0, 0.0).tip_W_mm.x();    // approached in -x
  const double minus = cell.touch(M_PI, 0.0).tip_W_mm.x();  // approached in +x
  EXPECT_NEAR(plus, kCenter_mm.x() + 27.0 - 0.001, kClose_mm);
  EXPECT_NEAR(minus, kCenter_mm.x() - 27.0 + 0.001, kClose_mm);
  EXPECT_NEAR(cell.touch(M_PI / 2, 0.0).tip_W_mm.x(), kCenter_mm.x(), kClose_mm) << "x rests";
}

TEST(MachineErrors, ScansSeeTheSameErrorsAsTouches) {
  SimulatedMachineOptions options;
  options.errors = typical_errors();
  options.errors.drift_mm.setZero();
  Cell scanned(options);
  Cell touched(options);
  ScanCircleCommand command;
  command.center_W_mm = kCenter_mm;
  command.start_tip_W_mm = kCenter_mm + Vector3d(27.0, 0.0, 0.0);
  command.sweep_rad = core::kTwoPi;
  command.points = 12;
  ASSERT_TRUE(scanned.machine().move_to({kCenter_mm.x() + 30.0, kCenter_mm.y(), 300.0}));
  ASSERT_TRUE(scanned.machine().move_to(kCenter_mm + Vector3d(30.0, 0.0, 0.0)));
  const auto readings = scanned.machine().scan_circle(command);
  ASSERT_TRUE(readings) << readings.error().what;
  for (int k = 0; k < 12; ++k) {
    const auto single = touched.touch(k * core::kTwoPi / 12.0, 0.0);
    EXPECT_LT(((*readings)[static_cast<std::size_t>(k)].tip_W_mm - single.tip_W_mm).norm(), 1e-9);
  }
}

TEST(MachineErrors, DustMeetsTheStatedShareOfTheTouchesAndOnlyLiftsThem) {
  SimulatedMachineOptions options;
  options.part_errors.dust_share = 0.1;
  options.part_errors.dust_mm = 0.02;
  Cell cell(options);
  cell.touch(0.0, 0.0);
  const TouchCommand command = {0, kCenter_mm + Vector3d(27.0, 0.0, 0.0), -Vector3d::UnitX(), 3, 3};
  const int n = 4000;
  int lifted = 0;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    TouchCommand touch = command;
    touch.id = i;
    const double off = cell.machine().touch(touch)->tip_W_mm.x() - kCenter_mm.x() - 27.0;
    ASSERT_GE(off, -1e-9);
    ASSERT_LE(off, 0.02);
    lifted += off > 1e-9 ? 1 : 0;
    sum += off;
  }
  EXPECT_NEAR(lifted / static_cast<double>(n), 0.1, 4.0 * std::sqrt(0.09 / n));
  EXPECT_NEAR(sum / lifted, 0.01, 4.0 * 0.02 / std::sqrt(12.0 * lifted));
}

TEST(MachineErrors, KeywayAndBurrAreSeenWhereTheyArePut) {
  PartSurface part = Cell::shaft();
  part.marks = {{0.5, 10.0, 12.0, 20.0, -0.4, 0.2}, {2.0, -15.0, 2.0, 2.0, 0.03, 1.0}};
  Cell cell({}, part);
  EXPECT_NEAR(from_axis(cell.touch(0.5, 10.0).tip_W_mm), 27.0 - 0.4, kClose_mm) << "on its floor";
  EXPECT_NEAR(from_axis(cell.touch(2.0, -15.0).tip_W_mm), 27.0 + 0.03, kClose_mm) << "on its top";
  for (const double theta : {1.2, 3.0, 4.5, 6.0}) {
    EXPECT_NEAR(from_axis(cell.touch(theta, 10.0).tip_W_mm), 27.0, kClose_mm) << theta;
  }
  EXPECT_NEAR(from_axis(cell.touch(0.5, -15.0).tip_W_mm), 27.0, kClose_mm) << "below the keyway";
}

TEST(MachineErrors, AKeywayNarrowerThanTheTipIsBridged) {
  PartSurface part = Cell::shaft();
  part.marks = {{0.5, 0.0, 2.0, 60.0, -3.0, 0.1}};
  Cell cell({}, part);
  // The ball rests on both edges, about 1 mm beside the middle: it sinks by rho - sqrt(rho^2 - 1),
  // and a hair less, because the shaft falls away by 1 / (2 R).
  const double sunk = 27.0 - from_axis(cell.touch(0.5, 0.0).tip_W_mm);
  EXPECT_GT(sunk, 0.2);
  EXPECT_LT(sunk, 2.0 - std::sqrt(3.0) + 1.0 / 50.0);
}

}  // namespace
}  // namespace rondure::cmm
