// What no fit can evaluate, for every shape: one table of sets, one table of fits.
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "circle_sets.h"
#include "core/error.h"
#include "core/units.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/line.h"
#include "fit/least_squares/sphere.h"
#include "fit/references/min_zone.h"

namespace rondure::test {
namespace {

constexpr std::size_t kBadRow = 17;

/// A fit's error, or nothing.
template <class Points>
struct Fit {
  std::string name;
  std::function<core::Result<void>(const Points&)> run;
};

template <class T>
core::Result<void> outcome(const core::Result<T>& result) {
  if (!result) return core::fail(result.error());
  return {};
}

std::vector<Fit<Points2>> circle_fits() {
  return {{"ls_circle", [](const Points2& p) { return outcome(fit::ls_circle(p)); }},
          {"algebraic_circle", [](const Points2& p) { return outcome(fit::algebraic_circle(p)); }},
          {"min_zone_circle", [](const Points2& p) { return outcome(fit::min_zone_circle(p)); }}};
}

std::vector<Fit<Points3>> cylinder_fits() {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  return {
      {"ls_cylinder", [](const Points3& p) { return outcome(fit::ls_cylinder(p)); }},
      {"ls_cylinder near z", [z](const Points3& p) { return outcome(fit::ls_cylinder(p, z)); }},
      {"min_zone_cylinder", [](const Points3& p) { return outcome(fit::min_zone_cylinder(p)); }},
      {"min_zone_cylinder near z",
       [z](const Points3& p) { return outcome(fit::min_zone_cylinder(p, z)); }}};
}

/// Every fit refuses the set with this code, and says `word`.
template <class Points>
void expect_refused(const std::vector<Fit<Points>>& fits, const Points& points, core::Code code,
                    const std::string& word = "") {
  for (const auto& fit : fits) {
    SCOPED_TRACE(fit.name);
    const auto result = fit.run(points);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(core::code_name(result.error().code), core::code_name(code)) << result.error().what;
    EXPECT_NE(result.error().what.find(word), std::string::npos) << result.error().what;
  }
}

Points2 circle(int n) {
  Points2 points;
  for (int k = 0; k < n; ++k) {
    const double angle = core::kTwoPi * k / n;
    points.emplace_back(25.0 * std::cos(angle), 25.0 * std::sin(angle) + 0.001 * (k % 3));
  }
  return points;
}

Points3 layers(int count, double pitch_mm) {
  Points3 points;
  for (int j = 0; j < count; ++j) {
    for (const auto& p : circle(24)) points.emplace_back(p.x(), p.y(), 10.0 + pitch_mm * j);
  }
  return points;
}

const double kBadNumbers[] = {std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};

TEST(BadInput, NoPoints) {
  expect_refused(circle_fits(), Points2{}, core::Code::kNoPoints);
  expect_refused(cylinder_fits(), Points3{}, core::Code::kNoPoints);
}

TEST(BadInput, NotFiniteNamesTheRow) {
  for (const double bad : kBadNumbers) {
    for (int axis = 0; axis < 2; ++axis) {
      Points2 points = circle(24);
      points[kBadRow](axis) = bad;
      expect_refused(circle_fits(), points, core::Code::kNotFinite, std::to_string(kBadRow));
    }
    for (int axis = 0; axis < 3; ++axis) {
      Points3 points = layers(3, 10.0);
      points[kBadRow](axis) = bad;
      expect_refused(cylinder_fits(), points, core::Code::kNotFinite, std::to_string(kBadRow));
    }
  }
}

TEST(BadInput, FiniteButHugeNamesTheRow) {
  for (const double huge : {1e155, -1e100, 1.1e7}) {
    Points2 points = circle(24);
    points[kBadRow].x() = huge;
    expect_refused(circle_fits(), points, core::Code::kOutOfRange, std::to_string(kBadRow));
    Points3 spatial = layers(3, 10.0);
    spatial[kBadRow].z() = huge;
    expect_refused(cylinder_fits(), spatial, core::Code::kOutOfRange, std::to_string(kBadRow));
    expect_refused<Points3>(
        {{"ls_line", [](const Points3& p) { return outcome(fit::ls_line(p)); }},
         {"ls_sphere", [](const Points3& p) { return outcome(fit::ls_sphere(p)); }}},
        spatial, core::Code::kOutOfRange, "at most 1e+07 mm");
  }
}

TEST(BadInput, TooFewDistinctPoints) {
  const Points2 two = {{1, 0}, {0, 1}, {1, 0}, {0, 1}, {1, 0}, {0, 1}};
  expect_refused(circle_fits(), two, core::Code::kTooFewPoints);
  const Points3 four = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 5}, {0, -1, 5}, {1, 0, 0}, {0, 1, 0}};
  expect_refused(cylinder_fits(), four, core::Code::kTooFewPoints);
}

TEST(BadInput, Collinear) {
  for (const double far_mm : {0.0, 1e6}) {
    Points2 flat;
    Points3 spatial;
    for (int k = 0; k < 12; ++k) {  // halves: exact in binary, also far away
      flat.emplace_back(far_mm + 0.5 * k, far_mm + 1.5 * k);
      spatial.emplace_back(far_mm + 0.5 * k, far_mm + 1.5 * k, far_mm - 2.0 * k);
    }
    expect_refused(circle_fits(), flat, core::Code::kCollinear);
    expect_refused(cylinder_fits(), spatial, core::Code::kCollinear);
  }
}

TEST(BadInput, ASingleLayerLeavesTheTiltUndetermined) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Points3 one = layers(1, 0.0);
  expect_refused<Points3>(
      {{"ls", [z](const Points3& p) { return outcome(fit::ls_cylinder(p, z)); }},
       {"mz", [z](const Points3& p) { return outcome(fit::min_zone_cylinder(p, z)); }}},
      one, core::Code::kRank);
}

}  // namespace
}  // namespace rondure::test
